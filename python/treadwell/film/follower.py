"""Where a camera stands that goes with the robot: a fixed direction, and little in between."""

import math
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.film.poses import RecordedPoses
from treadwell.film.ray_camera import Eye
from treadwell.senses.projection import VISIBLE_GROUPS

Floats = NDArray[np.float64]
_ELEVATION: Final = math.radians(32.0)
_HEIGHTS_AWAY: Final = 6.5
"""Distance of the camera, in heights of the robot's root above its soles."""
_NEAREST: Final = 0.9
"""Metres."""
_SAMPLES: Final = 25
"""Moments of the run at which a direction is tried."""
_DIRECTIONS: Final = (-120, -150, -90, 120, 150, 90, -60, 60, 180, -30, 30, 0)
"""Degrees from the robot's way to the camera, the best looking first."""
_SMOOTH_TICKS: Final = 75
"""Half of the ticks over which the robot's place is averaged."""


@dataclass(frozen=True, slots=True, eq=False)
class Follower:
    """A camera that goes with the robot without turning.

    Attributes:
        places: (n, 3) m, what is looked at, one a row of the run.
        offset: (3,) m, from there to the camera.
    """

    places: Floats
    offset: Floats

    def eye(self, row: int) -> Eye:
        """Return where it is at a row of the run."""
        return Eye(self.places[row] + self.offset, self.places[row])


def follow(poses: RecordedPoses) -> Follower:
    """Return a camera from which the robot is hidden as little as can be."""
    root = poses.root()
    track = np.empty((poses.count, 3))
    for row in range(poses.count):
        # The root's pose is in qpos itself, but not that of a robot without a free joint.
        track[row] = poses.set(row).xpos[root]
    height = max(0.2, float(track[0, 2] - _floor(poses, track[0])))
    places = _smoothed(track) + np.array([0.0, 0.0, 0.1 * height])
    away = max(_NEAREST, _HEIGHTS_AWAY * height)
    way = track[-1, :2] - track[0, :2]
    heading = math.atan2(way[1], way[0]) if np.hypot(*way) > 0.1 else 0.0
    offsets = [_offset(heading + math.radians(turn), away) for turn in _DIRECTIONS]
    rows = np.unique(np.linspace(0, poses.count - 1, _SAMPLES).astype(int))
    hidden = [0.0] * len(offsets)
    for row in rows:
        data = poses.set(int(row))
        for i, offset in enumerate(offsets):
            hidden[i] += _hidden(poses, data, places[row] + offset)
    # A direction later in the list has to be better by a tenth of the robot.
    costs = [cost / len(rows) + 0.1 * i / len(offsets) for i, cost in enumerate(hidden)]
    return Follower(places, offsets[int(np.argmin(costs))])


def _offset(azimuth: float, away: float) -> Floats:
    flat = away * math.cos(_ELEVATION)
    return np.array(
        [flat * math.cos(azimuth), flat * math.sin(azimuth), away * math.sin(_ELEVATION)]
    )


def _smoothed(track: Floats) -> Floats:
    """Return the mean over a second and a half around each row."""
    count = len(track)
    total = np.vstack([np.zeros(3), np.cumsum(track, axis=0)])
    reach = np.minimum(np.minimum(np.arange(count), np.arange(count)[::-1]), _SMOOTH_TICKS)
    begin, end = np.arange(count) - reach, np.arange(count) + reach + 1
    smooth: Floats = (total[end] - total[begin]) / (end - begin)[:, None]
    return smooth


def _floor(poses: RecordedPoses, place: Floats) -> float:
    """Return the lowest point of the robot at the first row, m: where its soles are."""
    mine = poses.robot_bodies()[poses.model.geom_bodyid]
    data = poses.set(0)
    if not mine.any():
        return float(place[2] - 0.3)
    return float((data.geom_xpos[mine, 2]).min())


def _hidden(poses: RecordedPoses, data: mujoco.MjData, eye: Floats) -> float:
    """Return the share of the robot's bodies that something else hides from a place."""
    mine = np.flatnonzero(poses.robot_bodies())
    towards = data.xpos[mine] - eye
    distance = np.linalg.norm(towards, axis=1)
    geom, reach = np.empty(len(mine), np.int32), np.empty(len(mine))
    mujoco.mj_multiRay(
        poses.model, data, eye, (towards / distance[:, None]).reshape(-1), VISIBLE_GROUPS, True, -1,
        geom, reach, None, len(mine), 100.0,
    )  # fmt: skip
    other = (geom >= 0) & ~poses.robot_bodies()[poses.model.geom_bodyid[geom]]
    return float((other & (reach < distance)).mean())
