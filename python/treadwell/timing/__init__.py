"""Times of the core on a fixed workload, each with a ratio that was taken in the same run."""
