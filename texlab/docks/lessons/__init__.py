"""The lessons: their list, what is said at a step, and the user's own, edited in place."""
