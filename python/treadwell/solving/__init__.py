"""Whether there is a way at all on a true course, within what the robot can do."""
