"""Shape from texture: the orientation of a plane, or of each part of a sphere, from what foreshortening does.

Reference: Forsyth and Ponce, section 11.4.
"""
