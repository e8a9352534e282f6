"""Rays through a map that is told, from Python."""

import numpy as np
import pytest

from treadwell._core import Octree, RangeField
from treadwell.errors import InputError


def corner() -> Octree:
    """Return a floor of 4 by 4 m with a wall along one side."""
    across, ahead = (axis.ravel() for axis in np.meshgrid(*[np.arange(-1.98, 2.0, 0.04)] * 2))
    up = np.arange(0.02, 1.0, 0.04)
    low = np.full(across.size, -0.02)
    wall = np.stack(np.meshgrid([1.98], np.unique(across), up), axis=-1).reshape(-1, 3)
    tree = Octree(0.04)
    tree.occupy(np.concatenate([np.stack([ahead, across, low], axis=1), wall]))
    return tree


def test_rays_end_on_the_faces_of_what_is_occupied() -> None:
    tree = corner()
    field = RangeField(tree)
    origins = np.tile([0.01, 0.02, 0.5], (5, 1))
    directions = np.array(
        [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.6, 0.0, -0.8], [0.8, 0.0, -0.1]]
    )
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    found = field.cast(origins, directions, 5.0)
    assert found[:2] == pytest.approx([1.95, 0.5], abs=1e-5)
    assert np.isinf(found[2])
    assert np.isinf(field.cast(origins[:1], directions[:1], 1.9)[0])
    # The octree tells the voxel's centre, which lies half a voxel's diagonal away at most.
    _, centres = tree.cast_rays(origins, directions)
    assert np.abs(found[3:] - centres[3:]).max() < 0.02 * np.sqrt(3.0)


def test_what_makes_no_rays_is_refused() -> None:
    field = RangeField(corner())
    with pytest.raises(InputError, match="as many"):
        field.cast(np.zeros((2, 3)), np.zeros((1, 3)), 1.0)
