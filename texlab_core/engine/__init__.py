"""Parameters, inputs, jobs, the registry, and the only loop that drives a method."""
