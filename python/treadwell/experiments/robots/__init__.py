"""The experiment `robots`: robots side by side, on courses of their size."""
