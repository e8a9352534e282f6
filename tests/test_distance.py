"""The distance transform from Python."""

import numpy as np
import pytest

from treadwell._core import distances, squared_distances


def test_distances_are_those_of_brute_force() -> None:
    blocked = np.random.default_rng(3).random((23, 31)) < 0.04
    rows, cols = np.indices(blocked.shape)
    at = np.argwhere(blocked)
    expected = ((rows[..., None] - at[:, 0]) ** 2 + (cols[..., None] - at[:, 1]) ** 2).min(axis=-1)
    assert np.array_equal(squared_distances(blocked), expected)
    assert np.array_equal(distances(blocked), np.sqrt(expected.astype(np.float32)))
    assert np.all(squared_distances(np.zeros((2, 3), bool)) == 2**29)


def test_rows_apart_in_memory_are_refused() -> None:
    with pytest.raises(ValueError, match="row by row"):
        squared_distances(np.zeros((4, 4), bool)[:, ::2])
