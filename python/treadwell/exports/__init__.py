"""`treadwell export`: a run's maps, clouds, ways and measurements for other tools."""
