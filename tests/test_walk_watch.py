"""What the watch of a walk says of poses, of unmapped things and of the static map."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from episode_builders import qrio, trace, world

from treadwell.map_memory import FLOOR, OBSTACLE
from treadwell.measuring.walk_watch import Walk, WalkWatch
from treadwell.measuring.watch import Watch
from treadwell.poses import pose_matrix

COURSE = """
[[course]]
kind = "box"
name = "wall"
position = [1.0, 0.5]
size = [0.4, 0.06, 0.5]
[[course]]
kind = "box"
name = "books"
position = [1.0, -0.5]
size = [0.12, 0.12, 0.1]
mapped = false
"""
WORLD = world(COURSE)

_watch: type[Watch] = WalkWatch


def seen(fired: tuple[tuple[float, str], ...] = (), **changes: object) -> Walk:
    """What is found after one frame."""
    episode: Any = SimpleNamespace(
        course=WORLD.course,
        scenario=WORLD.scenario,
        robot=qrio(),
        events=SimpleNamespace(fired=fired),
    )
    watch = WalkWatch(episode)
    watch.frame(trace(WORLD, 200_000_000, **changes))
    return watch.findings()


def test_errors_are_those_of_the_plane_and_of_the_heading_either_way_round() -> None:
    walk = seen(
        map_from_robot=pose_matrix(0.03, 0.04, 0.5, 3.1),
        truth_from_robot=pose_matrix(0.0, 0.0, 0.0, -3.1),
        odometry_from_robot=pose_matrix(0.6, -0.8, 0.0, 0.0),
    )
    assert walk.times.tolist() == pytest.approx([0.2])
    assert walk.errors().tolist() == pytest.approx([0.05])
    assert walk.odometry_errors().tolist() == pytest.approx([1.0])
    assert walk.heading_errors().tolist() == pytest.approx([math.tau - 6.2])


def test_when_it_was_carried_off_last_is_told() -> None:
    assert seen().carried == 0.0
    assert seen(fired=((3.0, "kidnap"), (9.0, "kidnap"), (11.0, "push"))).carried == 9.0


@pytest.mark.parametrize(
    ("kind", "height", "found"), [(OBSTACLE, math.nan, 9), (FLOOR, 0.1, 9), (FLOOR, 0.0, 0)]
)
def test_what_the_map_lacks_is_found_as_an_obstacle_or_by_its_top(
    kind: int, height: float, found: int
) -> None:
    kinds, heights = np.full((40, 40), FLOOR, dtype=np.uint8), np.zeros((40, 40), dtype=np.float32)
    # Cells of 40 mm from (0.9, -0.6) on: 3 x 3 of them lie over the books.
    kinds[1:4, 1:4], heights[1:4, 1:4] = kind, height
    walk = seen(view_origin=(0.9, -0.6), view_kind=kinds, view_height=heights)
    (books,) = walk.unmapped
    assert (books.name, books.cells, books.found) == ("books", 9, found)


def test_floor_beside_a_thing_is_not_clear_of_it() -> None:
    kinds, heights = np.full((40, 40), FLOOR, dtype=np.uint8), np.zeros((40, 40), dtype=np.float32)
    frame = {"view_origin": (0.9, -0.6), "view_kind": kinds, "view_height": heights}
    free = seen(**frame)
    assert 1300 < free.clear < 1600
    assert free.clear_wrong == 0
    # Beside the books, 20 mm off, and far from everything.
    kinds[2, 4], kinds[12, 20] = OBSTACLE, OBSTACLE
    wrong = seen(**frame)
    assert (wrong.clear, wrong.clear_wrong) == (free.clear, 1)


def test_the_static_map_is_that_of_what_is_mapped_and_bars_the_way() -> None:
    columns = seen().static
    assert len(columns) == 10
    assert columns.min(axis=0).tolist() == pytest.approx([0.82, 0.5])
    assert columns.max(axis=0).tolist() == pytest.approx([1.18, 0.5])
    # From a level above the wall it bars nothing.
    assert not len(seen(truth_from_robot=pose_matrix(0.0, 0.0, 0.6, 0.0)).static)
