"""What there is to choose and to set, as lists, JSON schemas and pages: made from the code."""
