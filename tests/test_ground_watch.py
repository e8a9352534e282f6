"""How true a map's ground is: cells on planes, cells at edges, and what is gone."""

from pathlib import Path

import numpy as np
import pytest

from treadwell.episode import Episode
from treadwell.map_memory import FLOOR, OBSTACLE, RememberedMap
from treadwell.measuring.ground_watch import GroundWatch, at_edges, ground_errors
from treadwell.measuring.score import true_cells
from treadwell.measuring.watch import Watch
from treadwell.runner import run_episode

_watch: type[Watch] = GroundWatch
STEP = """
schema = 1
name = "step"
time_limit = 0.4
[start]
position = [-0.5, 0.0]
[goal]
[[course]]
kind = "platform"
name = "step"
position = [0.8, 0.0]
size = [0.8, 0.8, 0.03]
[[event]]
at = 0.3
do = "remove"
name = "step"
"""


@pytest.fixture
def episode(tmp_path: Path) -> Episode:
    path = tmp_path / "step.toml"
    path.write_text(STEP)
    return Episode(path)


def perfect(episode: Episode) -> RememberedMap:
    """The map of one who knows everything, in cells of 4 cm."""
    shape = (40, 50)
    found = RememberedMap(
        (-0.2, -0.8), 0.04, np.full(shape, FLOOR, np.uint8),
        np.full(shape, np.nan, np.float32), np.full(shape, 9, np.uint16),
    )  # fmt: skip
    found.height[:] = true_cells(episode.course, found, 0.58).height
    return found


def test_a_perfect_map_is_off_by_nothing_and_all_its_edges_are_where_they_are(
    episode: Episode,
) -> None:
    errors = ground_errors(episode, perfect(episode))
    assert errors.plane_rms < 1e-6
    assert errors.planes > 1500
    assert errors.within == errors.edges > 100
    assert errors.between == 0


@pytest.mark.parametrize(("cells", "right"), [(0, 12), (1, 12), (2, 9), (5, 9)])
def test_an_edge_may_be_a_cell_off_and_not_two(cells: int, right: int) -> None:
    truth = np.zeros((3, 20))
    truth[:, 10:] = 0.03
    found = np.zeros((3, 20))
    found[:, 10 + cells :] = 0.03
    edge, near, between = at_edges(found, truth)
    assert int(edge.sum()) == 12  # two cells on either side
    assert int((edge & near).sum()) == right
    assert not between.any()


def test_heights_between_two_levels_are_counted_as_such(episode: Episode) -> None:
    found = perfect(episode)
    edge, near, between = at_edges(found.height.astype(float), found.height.astype(float))
    assert near.all()
    assert not between.any()
    found.height[edge] = 0.015
    errors = ground_errors(episode, found)
    assert errors.between == errors.edges
    assert errors.within == 0
    assert errors.plane_median == 0.0


def test_what_is_no_floor_or_was_seen_too_seldom_does_not_count(episode: Episode) -> None:
    found = perfect(episode)
    whole = ground_errors(episode, found).planes
    found.kind[:, :10] = OBSTACLE
    found.sightings[:, 10:20] = 2
    found.height[:, :20] = 9.0
    errors = ground_errors(episode, found)
    assert errors.planes < whole
    assert errors.plane_rms < 1e-6
    nothing = RememberedMap((0.0, 0.0), 0.04, *(np.zeros((0, 0)),) * 3)
    assert ground_errors(episode, nothing).planes == 0


def test_a_run_has_its_errors_and_what_moved_frame_by_frame(
    episode: Episode, tmp_path: Path
) -> None:
    done = run_episode(episode, out=tmp_path / "run", record=False, watch=GroundWatch)
    assert done.findings.frames
    assert done.findings.frames[-1].covered == 0
    assert done.findings.frames[0].covered > 0
