"""What was known of steps, against the truth: which belief counts for a step, and its errors."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from episode_builders import STEP, world

from treadwell.measuring.step_watch import StepError, StepWatch, true_edge
from treadwell.trace import Sole


def sole(x: float, z: float, y: float = 0.0) -> Sole:
    return Sole(x, y, z, (1.0, 0.0))


def stair(edge: float, height: float, yaw: float = 0.0, *, fitted: bool = True) -> Any:  # noqa: ANN401
    """A stair that is believed to begin `edge` ahead of the map's origin."""
    half = 0.2 * np.array([-math.sin(yaw), math.cos(yaw)])
    middle = np.array([edge, 0.0])
    left, right = middle + half, middle - half
    return SimpleNamespace(
        front=((*left, height), (*right, height)),
        front_fit=object() if fitted else None,
        height=height,
        reference=(edge + 0.1, 0.0, height),
        depth=0.2,
    )


class Walk:
    """An episode of which only what the watch reads is there."""

    def __init__(self, *stairs: Any) -> None:  # noqa: ANN401
        self.course = world(STEP).course
        self.judge = SimpleNamespace(
            touch=SimpleNamespace(left=True, right=True),
            soles=(sole(0.5, 0.0), sole(0.5, 0.0)),
            observed=SimpleNamespace(x=0.5, y=0.0, z=0.0, yaw=0.0),
        )
        known = SimpleNamespace(stairs=list(stairs))
        self.pilot = SimpleNamespace(climbs=list, staircase=lambda: known)
        self.watch = StepWatch(self)  # type: ignore[arg-type]

    def stand(self, ticks: int = 6) -> None:
        step: Any = SimpleNamespace(
            observation=SimpleNamespace(depth=object()),
            estimate=SimpleNamespace(pose=(0.5, 0.0, 0.0, 0.0)),
            time_ns=0,
        )
        for _ in range(ticks):
            self.watch.tick(step)

    def climb(self) -> list[StepError]:
        """Both feet stand, then the left one steps onto the platform that begins at 0.7 m."""
        self.stand()
        self.judge.touch.left = False
        self.stand()
        self.judge.soles = (sole(0.8, 0.03), sole(0.5, 0.0))
        self.judge.touch.left = True
        self.stand()
        return self.watch.steps


def test_a_steps_errors_are_what_was_believed_minus_what_is() -> None:
    (error,) = Walk(stair(0.705, 0.032, 0.02)).climb()
    assert error.is_known()
    assert error.rise == pytest.approx(0.03)
    assert error.height == pytest.approx(0.002)
    assert error.edge == pytest.approx(0.005, abs=1e-5)
    assert error.heading == pytest.approx(0.02)
    assert error.within()


@pytest.mark.parametrize("stairs", [(), (stair(0.9, 0.03),), (stair(0.7, 0.06),)])
def test_a_step_that_was_not_believed_in_is_not_known(stairs: tuple[object, ...]) -> None:
    (error,) = Walk(*stairs).climb()
    assert not error.is_known()
    assert not error.within()


def test_a_measured_edge_counts_before_one_where_the_view_ended() -> None:
    (error,) = Walk(stair(0.701, 0.03, fitted=False), stair(0.708, 0.03)).climb()
    assert error.edge == pytest.approx(0.008, abs=1e-5)


@pytest.mark.parametrize(
    ("height", "edge", "heading"),
    [(0.0031, 0.0, 0.0), (0.0, 0.0101, 0.0), (0.0, 0.0, 0.053), (math.nan, 0.0, 0.0)],
)
def test_each_limit_counts(height: float, edge: float, heading: float) -> None:
    assert StepError(0.0, 0.03, 0.0029, -0.0099, 0.052).within()
    assert not StepError(0.0, 0.03, height, edge, heading).within()


def test_who_climbs_on_without_a_stand_is_not_judged_by_what_was_known_before() -> None:
    walk = Walk(stair(0.7, 0.03))
    assert len(walk.climb()) == 1
    walk.judge.touch.right = False
    walk.stand()
    walk.judge.soles = (sole(0.8, 0.03), sole(0.8, 0.07))
    walk.judge.touch.right = True
    walk.stand()
    assert len(walk.watch.steps) == 1


def test_an_edge_is_where_the_foot_crossed_it_and_walking_on_crosses_none() -> None:
    course = world(STEP).course
    found = true_edge(course, sole(0.5, 0.0, 0.1), sole(0.8, 0.03, 0.1))
    assert found is not None
    assert found[0] == pytest.approx([0.7, 0.1])
    assert found[1] == pytest.approx(0.0)
    assert true_edge(course, sole(0.1, 0.0), sole(0.3, 0.0)) is None
