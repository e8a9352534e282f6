"""Worlds that draw themselves from the seed: a house, a yard."""
