"""Footsteps planned over heights of one's own."""

import itertools
import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from treadwell import mapping
from treadwell.errors import InputError

START, GOAL = (0.4, 0.5, 0.0), (2.0, 0.5)


def flight(rise: float, tread: float, count: int) -> NDArray[np.float64]:
    """Stairs from x = 0.8 m on."""
    x = (np.arange(250) + 0.5) * 0.01
    steps = np.clip(np.floor((x - 0.8) / tread) + 1, 0, count)
    return np.tile(rise * steps, (100, 1))


def plan(height: NDArray[Any], **more: object) -> mapping.FootstepPlan:
    words: dict[str, Any] = {"cell": 0.01, "start": START, "goal": GOAL, **more}
    return mapping.plan_footsteps(height, **words)


@pytest.mark.parametrize("robot", ["qrio", "nao"])
def test_it_climbs_with_steps_that_follow_each_other(robot: str) -> None:
    found = plan(flight(0.03, 0.2, 3), robot=robot)
    assert found.reason is None
    assert math.isclose(sum(step.cost for step in found), found.cost)
    assert found.cost <= found.first_cost
    assert math.isclose(found.steps[-1].height, 0.09, abs_tol=1e-3)
    sides = [step.side for step in found]
    assert all(a != b for a, b in itertools.pairwise(sides))
    rises = np.diff([0.0, *(step.height for step in found)])
    assert np.all(np.abs(rises) < 0.056)
    assert sum(step.manner == "careful" for step in found) >= 3
    assert {step.manner for step in found} == {"walked", "careful"}
    middle = np.mean([(step.x, step.y) for step in found.steps[-2:]], axis=0)
    assert np.hypot(*(middle - GOAL)) < 0.11


def test_any_float_type_and_stride_gives_the_same_steps() -> None:
    heights = flight(0.03, 0.2, 3)
    expected = plan(heights)
    assert plan(heights.astype(np.float32)) == expected
    assert plan(np.asfortranarray(heights)) == expected
    assert plan(np.repeat(heights, 2, axis=1)[:, ::2]) == expected
    moved = plan(heights, origin=(5.0, 1.0), start=(5.4, 1.5, 0.0), goal=(7.0, 1.5))
    assert len(moved) == len(expected)


def test_the_reason_has_the_figure() -> None:
    assert plan(flight(0.07, 0.2, 3)).reason == (
        "no way to the goal: a step higher than 0.055 m, something in the way of the body, "
        "or ground that was not seen"
    )
    unseen = flight(0.0, 0.2, 1)
    unseen[:, 150:] = np.nan
    assert plan(unseen).reason == "the ground at the goal was not seen"
    assert not plan(unseen).steps


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"cell": 0.0}, "cell must be finite and > 0, got 0.0"),
        ({"start": (0.0, math.nan, 0.0)}, "start must be 3 finite numbers"),
        ({"goal": (1.0,)}, "goal must be 2 finite numbers, got (1.0,)"),
        ({"robot": "qiro"}, "qrio"),
        ({"overrides": {"epsilon": 0.5}}, "navigation.footsteps.epsilon must be"),
        ({"overrides": {"expansion": 5}}, "expansion"),
    ],
)
def test_an_argument_that_cannot_be_used_is_named(more: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError) as refused:
        plan(flight(0.03, 0.2, 3), **more)
    assert message in str(refused.value)


def test_cells_that_are_too_large_or_needlessly_small_are_the_reason() -> None:
    for cell in (0.1, 1e-7):
        reason = plan(np.zeros((100, 250)), cell=cell).reason
        assert reason is not None
        assert f"got {cell:.7f}".rstrip("0") in reason


def test_heights_that_are_no_heights_are_refused() -> None:
    with pytest.raises(InputError, match="height must be an array of numbers"):
        plan(np.zeros((3, 3, 3)))
    with pytest.raises(InputError, match="height must be an array of numbers"):
        plan(np.full((3, 3), "high"))
    assert plan(np.zeros((0, 0))).reason is not None
