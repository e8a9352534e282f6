"""From the simulator to what the robot senses, with every error that a real sensor has."""
