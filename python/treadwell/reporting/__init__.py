"""`treadwell report`: one HTML file of a run, of several, or of a sweep."""
