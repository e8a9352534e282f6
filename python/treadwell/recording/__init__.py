"""What a run leaves behind: recording, observations, trajectories, pictures, and their check."""
