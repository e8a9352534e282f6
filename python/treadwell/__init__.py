"""A testbed in which a small humanoid finds its own way over an obstacle course, by its senses alone."""
