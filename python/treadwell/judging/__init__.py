"""The truth: falls, collisions, arrival, errors, the result. Nothing of it enters the core."""
