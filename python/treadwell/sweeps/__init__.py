"""Many episodes: scenarios, variants and seeds, run side by side, resumable, and their results."""
