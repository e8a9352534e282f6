"""`treadwell export`: a run's maps, clouds, ways and measurements in files that other tools open."""
