"""The pop-out test: a piece of the exemplar is put into what a method made of it; who looks says where it is.

Reference: J. S. De Bonet, SIGGRAPH 1997, section 2 and Figs. 2 to 5: a synthesized texture is good when the
original that is superimposed on it is not readily located.
"""
