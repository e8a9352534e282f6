"""Range data that others recorded, or a run of ours: each source yields frames with their poses."""
