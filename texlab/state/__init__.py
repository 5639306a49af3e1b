"""What the user has chosen and what there is to see: frozen values and pure functions."""
