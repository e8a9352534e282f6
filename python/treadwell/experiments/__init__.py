"""A paper's experiments, run again: what it reports beside what came out here."""
