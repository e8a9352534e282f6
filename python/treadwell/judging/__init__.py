"""The truth: falls, collisions, arrival, the verdict, the result. Nothing of it enters the core."""
