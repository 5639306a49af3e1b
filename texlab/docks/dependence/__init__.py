"""What bands have to do with each other, exemplar beside results, linked to pixels."""
