"""A robot's folder: its MJCF and `robot.toml`, checked, and what the core is told of it."""
