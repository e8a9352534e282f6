"""A planner's say over steps: what it lists is walked while it holds, else refused."""

import itertools
from pathlib import Path

import numpy as np
import pytest

import treadwell
from treadwell._core import FloorView, Goal, Staircase
from treadwell.protocols import ListedStep, Plan, Pose

pytestmark = pytest.mark.slow
OVERRIDES = {"navigation.behaviour": "footsteps"}
STANCE, STRIDE, BEFORE = 0.085, 0.07, 0.53
"""m: from foot to foot, most that a foot is put ahead of the other, and before the step."""
COURSE = """
schema = 1
name = "one_step"
time_limit = 60.0
[start]
[goal]
position = [1.0, 0.0]
[[course]]
kind = "platform"
position = [1.0, 0.0]
yaw = 0.0
size = [0.8, 1.0, 0.03]
"""


class OntoTheStep:
    """Knows the step of the course, and lists steps onto it."""

    def __init__(self) -> None:
        self.listed: list[tuple[ListedStep, ...]] = []

    def plan(self, _: FloorView, __: Staircase, start: Pose, goal: Goal) -> Plan:
        x, y, *_rest = start
        path = np.linspace((x, y), goal.position, 30)
        if not 0.1 < x < 0.45:
            return Plan(path)
        walked = int(np.ceil((BEFORE - x) / STRIDE))
        places = [*np.linspace(x, BEFORE, 1 + walked)[1:], 0.655, 0.72, 0.72]
        sides = itertools.cycle([("right", -0.5 * STANCE), ("left", 0.5 * STANCE)])
        steps = tuple(
            ListedStep(side, at, y + aside, 0.0)
            for at, (side, aside) in zip(places, sides, strict=False)
        )
        self.listed.append(steps)
        return Plan(path, footsteps=steps)


def course(folder: Path) -> Path:
    path = folder / "one_step.toml"
    path.write_text(COURSE)
    return path


def placed(episode: treadwell.Episode) -> dict[str, tuple[float, float]]:
    soles = episode.judge.soles
    assert soles is not None
    return {side: (sole.x, sole.y) for side, sole in zip(("left", "right"), soles, strict=True)}


def test_the_steps_that_a_planner_lists_are_walked(tmp_path: Path) -> None:
    planner = OntoTheStep()
    episode = treadwell.Episode(course(tmp_path), seed=0, overrides=OVERRIDES, planner=planner)
    begun: tuple[ListedStep, ...] = ()
    where: dict[str, list[tuple[float, float]]] = {"left": [], "right": []}
    for step in episode:
        if step.state == "step" and not begun:
            begun = planner.listed[-1]
            found = episode.pilot.planned_footsteps()
            assert found is not None
            planned = [(names[0], *pose) for (names, _, pose, _) in found["steps"]]
            assert planned == [tuple(one) for one in begun]
        for side, at in placed(episode).items():
            where[side].append(at)
        if begun and step.estimate.pose[0] > 0.8:
            break
    assert len(begun) > 6
    for one in begun:
        off = np.hypot(*(np.array(where[one.side]) - (one.x, one.y)).T).min()
        assert off < 0.03, (one, off)
    assert episode.pilot.planned_footsteps()["refused"] is None  # type: ignore[index]
    assert episode.judge.stairs_climbed == 1
    assert not episode.judge.collisions


def test_steps_that_do_not_hold_are_refused_with_the_reason(tmp_path: Path) -> None:
    class TooFar(OntoTheStep):
        def plan(self, _: FloorView, __: Staircase, start: Pose, goal: Goal) -> Plan:
            x, y, _, yaw = start
            path = np.linspace((x, y), goal.position, 30)
            return Plan(path, footsteps=[ListedStep("left", x + 0.25, y + 0.04, yaw)])

    run = treadwell.run(
        course(tmp_path),
        overrides={**OVERRIDES, "time_limit": 20.0},
        planner=TooFar(),
        out=tmp_path / "run",
        record=False,
    )
    (told, *_) = run.result.footsteps_refused
    assert told.startswith("step 1 of 1, left at (")
    assert told.endswith(
        "m: it is farther, nearer to the other foot, or more turned than a step goes"
    )
