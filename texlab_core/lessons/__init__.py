"""Lessons at work: those of the program, drawings, results of steps, pages of HTML, the index of figures."""
