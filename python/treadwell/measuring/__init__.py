"""Measures of a run against the truth: watches, errors, scores. Nothing of it enters the core."""
