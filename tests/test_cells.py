"""Where the cells of a frame's map lie."""

import numpy as np
import pytest
from episode_builders import BOX, trace, world

from treadwell.measuring.cells import covered_by, lattice

WORLD = world(BOX)


def test_cells_are_named_by_their_place_in_the_map_wherever_the_window_is() -> None:
    here, names = lattice(trace(WORLD, 0))
    there, others = lattice(trace(WORLD, 0, view_origin=(-0.8 + 3 * 0.04, -0.8 - 2 * 0.04)))
    places = dict(zip(names, map(tuple, here), strict=True))
    both = [
        (places[name], tuple(at)) for name, at in zip(others, there, strict=True) if name in places
    ]
    assert len(both) == 37 * 38
    for one, other in both:
        assert one == pytest.approx(other)


def test_an_element_covers_the_points_over_it() -> None:
    (box,) = WORLD.course.elements
    points = np.array([[0.5, 0.0], [0.41, 0.09], [0.39, 0.0], [0.5, 0.11]])
    assert covered_by(box, points).tolist() == [True, True, False, False]
