"""The world beyond the project's own courses: the experiment `world`."""
