"""The map that is told: voxels of what is mapped of a course."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from treadwell._core import Octree
from treadwell.course.build import build_course
from treadwell.course.outlines import Floats
from treadwell.course.static_map import map_resolution, static_map
from treadwell.errors import InputError
from treadwell.robot.load import load_robot
from treadwell.scenario.loading import load_scenario

SCENARIO = """
schema = 1
name = "mapped"
[start]
position = [0.0, 0.0]
[goal]
position = [1.0, 0.0]
[[course]]
kind = "box"
position = [1.0, 1.0]
yaw = 0.5
size = [0.4, 0.2, 0.3]
base = 0.4
[[course]]
kind = "wall"
from = [-1.0, -1.0]
to = [2.0, -1.0]
height = 0.6
thickness = 0.01
[[course]]
kind = "ramp"
position = [2.0, 0.0]
yaw = 0.0
length = 0.8
width = 0.6
rise = 0.2
[[course]]
kind = "box"
position = [1.0, 0.0]
size = [0.2, 0.2, 0.4]
yaw = 0.0
mapped = false
[[event]]
at = 1.0
do = "add"
element = { kind = "box", position = [-1.0, 0.0], size = [0.2, 0.2, 0.4], name = "visitor" }
"""


@pytest.fixture
def tree(tmp_path: Path) -> Octree:
    path = tmp_path / "mapped.toml"
    path.write_text(SCENARIO)
    scenario = load_scenario(path)
    return static_map(build_course(scenario, load_robot("qrio")), 0.02, "mapped")


def occupied(tree: Octree, *points: Sequence[float] | Floats) -> list[bool]:
    known = np.nan_to_num(tree.log_odds(np.array(points, dtype=np.float64)), nan=-1.0)
    return [bool(value > 0.0) for value in known]


def test_it_has_the_ground_and_what_is_mapped(tree: Octree) -> None:
    assert occupied(tree, (0.0, 0.0, -0.01), (0.0, 0.0, 0.01)) == [True, False]
    # The box hangs, and is turned.
    assert occupied(tree, (1.0, 1.0, 0.55), (1.0, 1.0, 0.3)) == [True, False]
    corner = np.array([1.0, 1.0, 0.5]) + 0.18 * np.array([np.cos(0.5), np.sin(0.5), 0.0])
    assert occupied(tree, corner, (1.18, 1.0 - 0.09, 0.5)) == [True, False]


def test_a_wall_that_is_thinner_than_a_voxel_has_no_holes(tree: Octree) -> None:
    x = np.arange(-0.99, 2.0, 0.02)
    z = np.full_like(x, 0.31)
    sides = [occupied(tree, *np.column_stack([x, np.full_like(x, y), z])) for y in (-1.01, -0.99)]
    assert np.any(sides, axis=0).all()


def test_a_ramp_rises(tree: Octree) -> None:
    assert occupied(tree, (2.2, 0.0, 0.03), (2.2, 0.0, 0.09)) == [True, False]
    assert occupied(tree, (2.7, 0.0, 0.15), (2.7, 0.0, 0.21)) == [True, False]


def test_what_is_not_mapped_or_comes_later_is_not_in_it(tree: Octree) -> None:
    assert occupied(tree, (1.0, 0.0, 0.2), (-1.0, 0.0, 0.2)) == [False, False]


def test_octomap_gets_it_as_a_file(tree: Octree, tmp_path: Path) -> None:
    path = str(tmp_path / "mapped.bt")
    tree.write(path)
    again = Octree.read(path)
    assert again.nodes == tree.nodes
    assert np.array_equal(again.occupied()[0], tree.occupied()[0])


@pytest.mark.parametrize(
    "table", [{"resolution": 0}, {"resolution": "fine"}, {"resolution": float("nan")}, {"size": 1}]
)
def test_a_bad_table_is_refused_by_its_key(table: dict[str, object]) -> None:
    with pytest.raises(InputError, match=r"navigation\.static_map\.(resolution|size): "):
        map_resolution(table, "here")


def test_voxels_are_as_large_as_the_robot_where_nobody_says() -> None:
    assert map_resolution({}, "here") == 0.04
    assert map_resolution({}, "here", 2.0) == 0.08
    assert map_resolution({"resolution": 0.05}, "here", 2.0) == 0.05


def test_voxels_that_are_too_small_for_the_course_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "mapped.toml"
    path.write_text(SCENARIO)
    course = build_course(load_scenario(path), load_robot("qrio"))
    with pytest.raises(InputError, match="are allowed"):
        static_map(course, 0.001, "mapped")
