"""How things look: theme, colour maps, numbers as text."""
