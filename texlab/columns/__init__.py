"""The exemplar and the columns of results beside it."""
