"""Sweeps side by side: figures with intervals, and differences only where a paired test says so."""
