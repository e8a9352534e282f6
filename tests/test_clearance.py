"""The room on the robot's way, against what can be reckoned by hand."""

from pathlib import Path

import numpy as np
import pytest

from treadwell._core import swept_clearance
from treadwell.course.build import build_course
from treadwell.measuring.clearance import least_clearance
from treadwell.robot.load import load_robot
from treadwell.scenario.loading import load_scenario

SQUARE = np.array([[1.0, -0.5], [2.0, -0.5], [2.0, 0.5], [1.0, 0.5]])
SCENARIO = """
schema = 1
name = "clearance"
[start]
position = [0.0, 0.0]
[goal]
position = [2.0, 0.0]
[[course]]
kind = "box"
position = [1.0, 0.5]
size = [0.2, 0.2, 0.3]
[[course]]
kind = "box"
position = [1.0, 0.0]
size = [0.2, 0.2, 0.3]
base = 1.0
"""


def test_a_disc_passes_beside_a_square() -> None:
    path = np.array([[0.0, 1.0], [3.0, 1.0]])
    assert swept_clearance(path, SQUARE, 0.2) == pytest.approx(0.3)


def test_what_lies_between_two_places_counts() -> None:
    path = np.array([[0.0, 0.0], [3.0, 0.0]])
    assert swept_clearance(path, SQUARE, 0.1) == pytest.approx(-0.1)


@pytest.mark.parametrize("bad", [np.zeros((3, 3)), np.full((2, 2), np.nan)])
def test_a_path_that_is_none_is_refused(bad: np.ndarray) -> None:
    with pytest.raises(ValueError, match="path must be"):
        swept_clearance(bad, SQUARE, 0.1)


def test_the_robots_cylinder_is_swept_past_what_stands_in_its_height(tmp_path: Path) -> None:
    file = tmp_path / "clearance.toml"
    file.write_text(SCENARIO)
    scenario, robot = load_scenario(file), load_robot("qrio")
    course = build_course(scenario, robot)
    path = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    # The box overhead hangs above the robot; the other one begins at y = 0.4.
    expected = 0.4 - robot.file.body.radius
    assert least_clearance(course, robot, [path]) == pytest.approx(expected)
    assert least_clearance(course, robot, [np.empty((0, 3))]) is None
    assert least_clearance(course, robot, []) is None


def test_a_robot_that_is_carried_over_a_box_came_past_it_on_neither_side(tmp_path: Path) -> None:
    file = tmp_path / "clearance.toml"
    file.write_text(SCENARIO)
    scenario, robot = load_scenario(file), load_robot("qrio")
    course = build_course(scenario, robot)
    before = np.array([[1.0, -0.5, 0.0], [1.0, -0.4, 0.0]])
    after = np.array([[1.0, 1.2, 0.0], [1.0, 1.3, 0.0]])
    expected = 0.6 - robot.file.body.radius  # the box ends at y = 0.6
    assert least_clearance(course, robot, [before, after]) == pytest.approx(expected)
    assert least_clearance(course, robot, [np.vstack([before, after])]) < 0.0


def test_what_stands_on_the_floor_below_is_not_in_the_way_and_what_hangs_above_is(
    tmp_path: Path,
) -> None:
    file = tmp_path / "clearance.toml"
    file.write_text(SCENARIO)
    scenario, robot = load_scenario(file), load_robot("qrio")
    course = build_course(scenario, robot)
    way = np.array([[0.0, 0.5, 0.5], [2.0, 0.5, 0.5]])  # as on a platform of 50 cm
    # The box below ends at 30 cm; the one above begins at 1 m, and at y = 0.1 on this side.
    expected = 0.4 - robot.file.body.radius
    assert least_clearance(course, robot, [way]) == pytest.approx(expected)
