"""Room for the head: desks, lintels, ceilings and lamps, closed loop with all noise on."""

from pathlib import Path
from typing import Any

import pytest

import treadwell
from treadwell.experiments.drawn import write_scenario
from treadwell.experiments.world.parts import Part, box, corridor, desk, flight, platform
from treadwell.judging.result import Result

pytestmark = pytest.mark.scenario


def again(base: float, depth: float) -> Any:  # noqa: ANN401 - pytest's own
    """A ceiling that is left to `make test-long`: its height and depth, m."""
    return pytest.param(base, depth, marks=pytest.mark.long)


def ends(folder: Path, *course: Part, height: float | None = None) -> Result:
    """Return what comes of a walk of 2.6 m over a course, to a goal at a height, m."""
    goal: Part = {"position": [2.6, 0.0], "radius": 0.15}
    table = {
        "schema": 1,
        "name": "head_room",
        "time_limit": 150.0,
        "start": {"position": [0.0, 0.0], "yaw": 0.1},
        "goal": goal if height is None else {**goal, "height": height},
        "course": list(course),
    }
    file = write_scenario(folder / "head_room.toml", table)
    return treadwell.run(file, seed=0, out=folder / "run", record=False).result


def assert_untouched(result: Result) -> None:
    """Claim that the robot neither fell nor met anything."""
    assert result.falls == 0
    assert result.collisions == []


def test_a_desk_that_leaves_54_cm_is_walked_around(tmp_path: Path) -> None:
    result = ends(tmp_path, *desk((1.4, 0.0), (0.9, 1.2), 0.54))
    assert result.outcome == "goal_reached", result.reason
    assert_untouched(result)


def test_a_lamp_of_10_cm_at_the_height_of_the_head_is_walked_around(tmp_path: Path) -> None:
    result = ends(tmp_path, box("lamp", (1.3, 0.0), (0.1, 0.1, 0.2), 0.5))
    assert result.outcome == "goal_reached", result.reason
    assert_untouched(result)


@pytest.mark.parametrize(("base", "depth"), [again(0.46, 0.1), again(0.54, 1.0), (0.57, 0.1)])
def test_a_ceiling_below_the_robots_height_is_refused_as_too_low(
    tmp_path: Path, base: float, depth: float
) -> None:
    result = ends(tmp_path, *corridor(3.0), box("ceiling", (1.6, 0.0), (depth, 1.0, 0.05), base))
    assert (result.outcome, str(result.reason).split(":")[0]) == ("refused", "too_low")
    assert_untouched(result)


@pytest.mark.parametrize(("base", "depth"), [again(0.62, 0.1), (0.63, 1.0)])
def test_a_ceiling_that_leaves_4_cm_more_is_passed_under(
    tmp_path: Path, base: float, depth: float
) -> None:
    result = ends(tmp_path, *corridor(3.0), box("ceiling", (1.6, 0.0), (depth, 1.0, 0.05), base))
    assert result.outcome == "goal_reached", result.reason
    assert_untouched(result)


def test_a_ceiling_too_low_over_a_landing_is_refused_before_the_climb(tmp_path: Path) -> None:
    stairs = flight(4, 0.03, 0.12, 0.9, 1.9)
    ceiling = box("ceiling", (1.6, 0.0), (1.0, 1.0, 0.05), 0.66)
    result = ends(tmp_path, *corridor(3.0), stairs, ceiling, height=0.12)
    assert (result.outcome, str(result.reason).split(":")[0]) == ("refused", "too_low")
    assert result.stairs_climbed == 0
    assert_untouched(result)


def test_a_ceiling_that_is_too_low_only_above_a_step_is_refused(tmp_path: Path) -> None:
    step = platform("floor", (2.0, 0.0), (2.0, 0.9, 0.045))
    ceiling = box("ceiling", (1.9, 0.0), (1.0, 1.0, 0.05), 0.6)
    result = ends(tmp_path, *corridor(3.0), step, ceiling, height=0.045)
    assert (result.outcome, str(result.reason).split(":")[0]) == ("refused", "too_low")
    assert_untouched(result)
