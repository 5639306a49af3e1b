"""Non-parametric sampling (Efros & Leung 1999): windows, order, growth, filling, explaining."""
