"""Claims about the doors to plan-view maps: `_core.OccupancyMap` and `_core.find_lines`."""

import json

import numpy as np
import pytest
from numpy.typing import NDArray

from treadwell._core import OccupancyMap, find_lines
from treadwell.errors import InputError

SIDE_M = 1.5


def room(x: float, y: float, turn: float = 0.0) -> NDArray[np.float64]:
    """Points (180, 2) m on the walls of a square room, as a scanner at a place in it sees them."""
    angle = np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False) + 0.01
    way = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    far = (np.sign(way) * SIDE_M - [x, y]) / way
    seen = way * far.min(axis=1)[:, None]
    cos, sin = np.cos(turn), np.sin(turn)
    return np.ascontiguousarray(seen @ np.array([[cos, sin], [-sin, cos]]) + [x, y])


def test_a_scan_is_less_probable_where_it_was_not_taken() -> None:
    core = OccupancyMap('{"cell": 0.05}')
    for number in range(10):
        at = (0.05 * number, 0.013)
        assert core.insert(room(*at), at) == 180
    here = (0.22, -0.31)
    best, beams = core.log_likelihood(room(*here), here)
    assert beams == 180
    for x, y, turn in ((0.1, 0.0, 0.0), (0.0, -0.1, 0.0), (0.0, 0.0, 0.1)):
        moved = room(*here, turn) + np.array([x, y])
        assert core.log_likelihood(moved, (here[0] + x, here[1] + y))[0] < best


def test_a_sonar_is_heard_in_a_cone_and_silence_says_nothing() -> None:
    core = OccupancyMap()
    assert core.insert_sonar((0.0, 0.0, 0.0), [0.0, 1.5], [2.0, np.nan]) == 1
    (x, y), cell, probability, looks = core.cells()
    assert probability.shape == looks.shape
    row, col = int((0.02 - y) / cell), [int((far - x) / cell) for far in (1.0, 2.0)]
    before, there = probability[row, col]
    assert before < 0.5 < there
    beside = probability[int((1.0 - y) / cell)] if (1.0 - y) / cell < len(probability) else None
    assert beside is None or np.isnan(beside).all()


def test_the_walls_of_a_room_are_its_lines() -> None:
    found = find_lines(room(0.2, 0.1), json.dumps({"sigma": 0.01}))
    assert sorted(np.abs(found["distance"]).round(2)) == [SIDE_M] * 4
    assert found["held"] > 0.99
    assert found["ends"].shape == (4, 4)
    assert sorted(found["line"]) == [0, 1, 2, 3]


@pytest.mark.parametrize(
    ("points", "settings", "said"),
    [
        (np.array([[0.0, np.nan]]), "{}", "point 0 is not"),
        (np.zeros((2, 2)), '{"sigma": -1}', "plan_view.lines.sigma"),
        (np.zeros((2, 2)), '{"sigm": 1}', "sigm"),
    ],
)
def test_bad_points_and_settings_are_named(
    points: NDArray[np.float64], settings: str, said: str
) -> None:
    with pytest.raises(InputError, match=said):
        find_lines(points, settings)


def test_points_in_space_are_refused() -> None:
    with pytest.raises(ValueError, match=r"\(n, 2\)"):
        find_lines(np.zeros((2, 3)))
