"""Fill a hole or grow a picture by Efros-Leung."""
