"""Room for the head: desks, lintels, ceilings and lamps, closed loop with all noise on."""

from pathlib import Path

import pytest

import treadwell
from treadwell.judging.result import Result

pytestmark = pytest.mark.scenario

HEAD = """
schema = 1
name = "head_room"
time_limit = 150.0
[start]
position = [0.0, 0.0]
yaw = 0.1
[goal]
position = [2.6, 0.0]
radius = 0.15
"""
CORRIDOR = """
[[course]]
kind = "wall"
name = "left wall"
from = [-0.6, 0.475]
to = [3.0, 0.475]
height = 0.7
[[course]]
kind = "wall"
name = "right wall"
from = [-0.6, -0.475]
to = [3.0, -0.475]
height = 0.7
[[course]]
kind = "wall"
name = "end wall"
from = [3.0, -0.475]
to = [3.0, 0.475]
height = 0.7
[[course]]
kind = "wall"
name = "near wall"
from = [-0.6, -0.475]
to = [-0.6, 0.475]
height = 0.7
"""


def box(name: str, at: tuple[float, float], size: tuple[float, float, float], base: float) -> str:
    """Return a box of the course that hangs or stands at this height, m."""
    return (
        f'[[course]]\nkind = "box"\nname = "{name}"\nposition = [{at[0]}, {at[1]}]\n'
        f"size = [{size[0]}, {size[1]}, {size[2]}]\nbase = {base}\n"
    )


def ends(folder: Path, course: str, goal: str = "") -> Result:
    """Return what comes of a walk of 2.6 m over a course."""
    file = folder / "head_room.toml"
    file.write_text(HEAD + goal + course)
    return treadwell.run(file, seed=0, out=folder / "run", record=False).result


def assert_untouched(result: Result) -> None:
    """Claim that the robot neither fell nor met anything."""
    assert result.falls == 0
    assert result.collisions == []


def test_a_desk_that_leaves_54_cm_is_walked_around(tmp_path: Path) -> None:
    legs = [(x, y) for x in (0.98, 1.82) for y in (-0.57, 0.57)]
    desk = box("top", (1.4, 0.0), (0.9, 1.2, 0.03), 0.54)
    desk += "".join(box(f"leg {i}", at, (0.04, 0.04, 0.54), 0.0) for i, at in enumerate(legs))
    result = ends(tmp_path, desk)
    assert result.outcome == "goal_reached", result.reason
    assert_untouched(result)


def test_a_lamp_of_10_cm_at_the_height_of_the_head_is_walked_around(tmp_path: Path) -> None:
    result = ends(tmp_path, box("lamp", (1.3, 0.0), (0.1, 0.1, 0.2), 0.5))
    assert result.outcome == "goal_reached", result.reason
    assert_untouched(result)


@pytest.mark.parametrize(("base", "depth"), [(0.46, 0.1), (0.54, 1.0), (0.57, 0.1)])
def test_a_ceiling_below_the_robots_height_is_refused_as_too_low(
    tmp_path: Path, base: float, depth: float
) -> None:
    result = ends(tmp_path, CORRIDOR + box("ceiling", (1.6, 0.0), (depth, 1.0, 0.05), base))
    assert (result.outcome, str(result.reason).split(":")[0]) == ("refused", "too_low")
    assert_untouched(result)


@pytest.mark.parametrize(("base", "depth"), [(0.62, 0.1), (0.63, 1.0)])
def test_a_ceiling_that_leaves_4_cm_more_is_passed_under(
    tmp_path: Path, base: float, depth: float
) -> None:
    result = ends(tmp_path, CORRIDOR + box("ceiling", (1.6, 0.0), (depth, 1.0, 0.05), base))
    assert result.outcome == "goal_reached", result.reason
    assert_untouched(result)


def test_a_ceiling_too_low_over_a_landing_is_refused_before_the_climb(tmp_path: Path) -> None:
    stairs = (
        '[[course]]\nkind = "stairs"\nname = "stairs"\nposition = [0.6, 0.0]\n'
        "steps = 4\nrise = 0.03\ntread = 0.12\nwidth = 0.9\nlanding = 1.9\n"
    )
    ceiling = box("ceiling", (1.6, 0.0), (1.0, 1.0, 0.05), 0.66)
    result = ends(tmp_path, CORRIDOR + stairs + ceiling, "height = 0.12\n")
    assert (result.outcome, str(result.reason).split(":")[0]) == ("refused", "too_low")
    assert result.stairs_climbed == 0
    assert_untouched(result)


def test_a_ceiling_that_is_too_low_only_above_a_step_is_refused(tmp_path: Path) -> None:
    step = (
        '[[course]]\nkind = "platform"\nname = "floor"\nposition = [2.0, 0.0]\n'
        "size = [2.0, 0.9, 0.045]\n"
    )
    ceiling = box("ceiling", (1.9, 0.0), (1.0, 1.0, 0.05), 0.6)
    result = ends(tmp_path, CORRIDOR + step + ceiling, "height = 0.045\n")
    assert (result.outcome, str(result.reason).split(":")[0]) == ("refused", "too_low")
    assert_untouched(result)
