"""M1 of Maier 2012 (Fig. 1): an octree made of 28 depth images while the robot looks around."""

import itertools

import numpy as np
import pytest
from numpy.typing import NDArray

from treadwell._core import Octree
from treadwell.episode import Episode
from treadwell.recording.tracing import trace_of

IMAGES = 28
RESOLUTION = 0.04
REACH = 2.5
Floats = NDArray[np.float64]


def beside(tree: Octree, points: Floats) -> NDArray[np.bool_]:
    """Whether a tree has something in the voxel of each point (n, 3) or in one that touches it."""
    found = np.zeros(len(points), dtype=bool)
    for step in itertools.product((-RESOLUTION, 0.0, RESOLUTION), repeat=3):
        found |= np.nan_to_num(tree.log_odds(points + step), nan=-1.0) >= 0.0
    return found


@pytest.mark.slow
def test_furniture_walls_and_railings_are_in_the_octree_and_little_else() -> None:
    settings = ("start.known=true", "navigation.world_model=octree")
    episode = Episode("two_levels_unknown", seed=0, overrides=settings)
    told = episode.static_map
    assert told is not None
    made, seen, images = Octree(RESOLUTION), [], 0
    for step in episode:
        trace = trace_of(episode, step)
        if (
            trace.points_in_robot is None
            or trace.map_from_camera is None
            or step.observation.depth is None
        ):
            continue
        if not episode.pilot.planes().reliable:
            continue
        eye = trace.map_from_camera[:3, 3]
        points = trace.points()
        assert points is not None
        points = points[np.isfinite(points[:, 0])].astype(np.float64)
        points = points[np.linalg.norm(points - eye, axis=1) < REACH]
        made.insert(np.ascontiguousarray(points), (eye[0], eye[1], eye[2]))
        # Where the same lines of sight end in the map that was told.
        along = points - eye
        ends, ranges = told.cast_rays(np.tile(eye, (len(along), 1)), along, REACH)
        seen.append(ends[np.isfinite(ranges)])
        images += 1
        if images == IMAGES:
            break
    occupied, _ = made.occupied()
    visible = np.unique(np.floor(np.vstack(seen) / RESOLUTION), axis=0) * RESOLUTION
    visible += RESOLUTION / 2
    assert len(visible) > 1000
    precision = beside(told, occupied).mean()
    recall = beside(made, visible).mean()
    print(f"{len(occupied)} voxels, precision {precision:.3f}, recall {recall:.3f}")
    assert precision >= 0.9
    assert recall >= 0.85
