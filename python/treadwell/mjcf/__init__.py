"""MJCF files: read with care, built, checked; what robots and courses have in common."""
