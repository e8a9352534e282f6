"""Claims about levels: a step counts when both feet stand on the new level or have passed it."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from treadwell.judging.level_changes import LOOKS_A_FOOTPRINT, LevelChanges

Floats = NDArray[np.float64]
LEFT, RIGHT = 0, 1


def steps(*edges: tuple[float, float]) -> Callable[[Floats], Floats]:
    """The height from x on, for each edge in order; 0 before the first."""

    def height_at(points: Floats) -> Floats:
        height = np.zeros(len(points))
        for x, level in edges:
            height[points[:, 0] >= x] = level
        return height

    return height_at


def tread(course: Callable[[Floats], Floats], prints: Sequence[tuple[int, float]]) -> LevelChanges:
    """Put feet down at x in turn, each at the surface's height there."""
    levels = LevelChanges(course)
    for side, x in prints:
        z = float(course(np.array([[x, 0.0]]))[0])
        foot = levels.feet[side]
        foot.look(x - 0.01, 0.0, z + 0.02, touching=False)
        for _ in range(LOOKS_A_FOOTPRINT):
            foot.look(x, 0.0, z, touching=True)
    return levels


def test_a_step_counts_when_the_second_foot_is_up() -> None:
    course = steps((0.5, 0.03))
    one = tread(course, [(LEFT, 0.4), (RIGHT, 0.4), (LEFT, 0.6)])
    assert (one.climbed, one.descended) == (0, 0)
    both = tread(course, [(LEFT, 0.4), (RIGHT, 0.4), (LEFT, 0.6), (RIGHT, 0.6)])
    assert (both.climbed, both.descended) == (1, 0)


def test_each_foot_may_take_every_other_step() -> None:
    course = steps((0.5, 0.03), (0.62, 0.06), (0.74, 0.09))
    prints = [(LEFT, 0.4), (RIGHT, 0.4), (LEFT, 0.56), (RIGHT, 0.68), (LEFT, 0.8), (RIGHT, 0.8)]
    assert tread(course, prints).climbed == 3


def test_a_sill_is_climbed_and_descended_by_one_foot_on_it_and_one_over_it() -> None:
    course = steps((0.5, 0.038), (0.59, 0.0))
    prints = [(LEFT, 0.4), (RIGHT, 0.4), (LEFT, 0.545), (RIGHT, 0.7), (LEFT, 0.7)]
    levels = tread(course, prints)
    assert (levels.climbed, levels.descended) == (1, 1)


def test_a_foot_put_up_and_taken_back_has_climbed_nothing() -> None:
    course = steps((0.5, 0.03))
    levels = tread(course, [(LEFT, 0.4), (RIGHT, 0.4), (LEFT, 0.6), (LEFT, 0.4)])
    assert (levels.climbed, levels.descended) == (0, 0)


def test_a_foot_put_up_and_taken_back_before_the_climb_counts_once() -> None:
    course = steps((0.5, 0.03))
    probes = [(LEFT, 0.4), (RIGHT, 0.4), (LEFT, 0.56), (LEFT, 0.4), (RIGHT, 0.56), (RIGHT, 0.4)]
    levels = tread(course, [*probes, (LEFT, 0.6), (RIGHT, 0.6)])
    assert (levels.climbed, levels.descended) == (1, 0)


def test_both_feet_up_and_both_back_is_a_climb_and_a_descent() -> None:
    course = steps((0.5, 0.03))
    levels = tread(course, [(s, x) for x in (0.4, 0.6, 0.4) for s in (LEFT, RIGHT)])
    assert (levels.climbed, levels.descended) == (1, 1)


def test_a_step_taken_back_on_the_second_of_two_steps_leaves_the_first() -> None:
    course = steps((0.5, 0.03), (0.62, 0.06))
    prints = [(LEFT, 0.4), (RIGHT, 0.4), (LEFT, 0.56), (RIGHT, 0.56), (LEFT, 0.68), (LEFT, 0.56)]
    levels = tread(course, prints)
    assert (levels.climbed, levels.descended) == (1, 0)
    both = tread(course, [*prints, (LEFT, 0.68), (RIGHT, 0.68)])
    assert (both.climbed, both.descended) == (2, 0)


def test_a_basin_is_descended_and_climbed() -> None:
    course = steps((0.0, 0.03), (0.5, 0.0), (0.65, 0.03))
    levels = tread(course, [(s, x) for x in (0.4, 0.575, 0.75) for s in (LEFT, RIGHT)])
    assert (levels.climbed, levels.descended) == (1, 1)


def test_a_slope_has_no_steps() -> None:
    def slope(points: Floats) -> Floats:
        return np.clip(0.075 * points[:, 0], 0.0, None)

    prints = [(i % 2, 0.06 * i) for i in range(20)]
    levels = tread(slope, prints)
    assert (levels.climbed, levels.descended) == (0, 0)


def test_less_than_fifteen_millimetres_is_no_step() -> None:
    course = steps((0.5, 0.014))
    prints = [(LEFT, 0.4), (RIGHT, 0.4), (LEFT, 0.6), (RIGHT, 0.6)]
    assert tread(course, prints).climbed == 0


@given(
    st.lists(st.floats(0.016, 0.06), min_size=1, max_size=6),
    st.floats(0.05, 0.11),
)
def test_up_and_back_down_are_as_many(rises: list[float], stride: float) -> None:
    heights = np.cumsum(rises)
    course = steps(*[(0.12 * (i + 1), float(h)) for i, h in enumerate(heights)])
    end = 0.12 * (len(rises) + 1)
    way = [*np.arange(0.0, end, stride), end]
    prints = [(side, float(x)) for x in (*way, *reversed(way)) for side in (LEFT, RIGHT)]
    levels = tread(course, prints)
    assert levels.climbed == len(rises)
    assert levels.descended == pytest.approx(len(rises))
