"""Maps of range data that was recorded elsewhere, or in a run, without MuJoCo."""
