"""A furnished room of boxes and a depth camera carried through it: data whose truth is known."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell._core import Octree

Floats = NDArray[np.float64]

WIDTH: Final = 160
HEIGHT: Final = 120
FOCAL: Final = 140.0
CENTRE: Final = (81.5, 57.5)
"""Pixels: the axis is not the picture's middle."""
NEAREST: Final = 0.4
"""Metres: nothing is measured that is nearer."""
FARTHEST: Final = 5.0

# Lowest corner, highest corner, m; yaw, rad, about the middle. No face lies where voxels begin.
_BLOCKS: Final = (
    ((-0.3, -0.3, -0.3), (5.33, 4.31, 0.013), 0.0),
    ((-0.3, -0.3, 2.47), (5.33, 4.31, 2.7), 0.0),
    ((-0.3, -0.3, -0.3), (0.017, 4.31, 2.7), 0.0),
    ((5.031, -0.3, -0.3), (5.4, 4.31, 2.7), 0.0),
    ((-0.3, -0.3, -0.3), (5.33, -0.009, 2.7), 0.0),
    ((-0.3, 4.006, -0.3), (5.33, 4.4, 2.7), 0.0),
    ((0.6, 0.3, 0.0), (1.5, 0.9, 0.74), 0.0),
    ((3.6, 0.2, 0.0), (4.4, 0.8, 1.83), 0.3),
    ((3.9, 2.9, 0.0), (4.9, 3.5, 0.45), -0.5),
    ((0.1, 2.9, 0.0), (0.7, 3.9, 1.2), 0.0),
    ((1.9, 3.5, 0.7), (3.1, 3.95, 0.74), 0.0),
    ((2.4, 1.8, 0.0), (2.55, 1.95, 2.5), 0.7),
)


@dataclass(frozen=True)
class Frame:
    """A picture and where it was taken.

    Attributes:
        depth: (h, w) float32 metres along the optical axis, NaN where nothing was measured.
        pose: (4, 4) world from camera, the optical axis forward.
    """

    depth: NDArray[np.float32]
    pose: Floats


def room(turned: float = 0.0) -> Floats:
    """Return the blocks, (n, 7): both corners, and the yaw of each; all turned about the origin."""
    blocks = np.array([[*low, *high, yaw] for low, high, yaw in _BLOCKS])
    middle = 0.5 * (blocks[:, :2] + blocks[:, 3:5])
    c, s = np.cos(turned), np.sin(turned)
    shift = middle @ np.array([[c, s], [-s, c]]) - middle
    blocks[:, :2] += shift
    blocks[:, 3:5] += shift
    blocks[:, 6] += turned
    return blocks


def ranges(blocks: Floats, origin: Floats, along: Floats) -> Floats:
    """Return how far (n,) it is from a place to the first block along unit vectors (n, 3), m."""
    found = np.full(len(along), np.inf)
    for *corners, yaw in blocks:
        low, high = np.array(corners[:3]), np.array(corners[3:])
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        c, s = np.cos(yaw), np.sin(yaw)
        turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        begin = turn @ (origin - middle)
        with np.errstate(divide="ignore", invalid="ignore"):
            steps = along @ turn.T
            a, b = (-half - begin) / steps, (half - begin) / steps
        enter = np.minimum(a, b).max(axis=1)
        leave = np.maximum(a, b).min(axis=1)
        found = np.where((enter < leave) & (enter > 0.0), np.minimum(found, enter), found)
    return found


def sight(draws: np.random.Generator | None = None) -> Floats:
    """Return where pixels look, (h, w, 3) with depth 1; of some, to anywhere in the pixel."""
    rows, cols = np.indices((HEIGHT, WIDTH)).astype(float)
    if draws is not None:
        rows += draws.uniform(-0.5, 0.5, rows.shape)
        cols += draws.uniform(-0.5, 0.5, cols.shape)
    across, down = (cols - CENTRE[0]) / FOCAL, (rows - CENTRE[1]) / FOCAL
    return np.stack([across, down, np.ones_like(across)], axis=-1)


def depth_picture(blocks: Floats, pose: Floats, draws: np.random.Generator) -> NDArray[np.float32]:
    """Return what a structured-light camera measures: noise after Khoshelham and Elberink 2012."""
    rays = sight(draws).reshape(-1, 3)
    lengths = np.linalg.norm(rays, axis=1)
    along = (rays / lengths[:, None]) @ pose[:3, :3].T
    depth = ranges(blocks, pose[:3, 3], along) / lengths
    depth += draws.normal(size=depth.shape) * (0.0012 + 0.0019 * (depth - 0.4) ** 2)
    depth[~((depth > NEAREST) & (depth < FARTHEST))] = np.nan
    depth[draws.uniform(size=depth.shape) < 0.03] = np.nan
    return depth.reshape(HEIGHT, WIDTH).astype(np.float32)


def camera_pose(place: Floats, yaw: float, pitch: float, roll: float) -> Floats:
    """Return (4, 4) world from a camera that looks along x where nothing is turned; down is > 0."""
    axes = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    cy, sy, cp, sp, cr, sr = (f(v) for v in (yaw, pitch, roll) for f in (np.cos, np.sin))
    about_z = np.array([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]])
    about_y = np.array([[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
    pose = np.eye(4)
    pose[:3, :3] = about_z @ about_y @ about_x @ axes
    pose[:3, 3] = place
    return pose


def carried(count: int, seed: int, turned: float = 0.0) -> list[Floats]:
    """Return poses of a camera that is carried once around the room's middle by hand."""
    draws = np.random.default_rng([seed, 1])
    phases = draws.uniform(0.0, 2.0 * np.pi, 8)
    poses = []
    for t in np.linspace(0.0, 1.0, count):
        angle = 2.0 * np.pi * t + phases[0]
        sway = [np.sin(2.0 * np.pi * (k + 1) * t + phases[k]) for k in range(8)]
        place = np.array(
            [
                2.45 + (0.95 + 0.1 * sway[1]) * np.cos(angle),
                1.95 + (0.75 + 0.1 * sway[2]) * np.sin(angle),
                1.2 + 0.12 * sway[3],
            ]
        )
        yaw = angle + 1.3 * sway[0] + 0.4 * sway[4]
        pose = camera_pose(place, yaw, 0.3 + 0.15 * sway[5], 0.06 * sway[6])
        whole = camera_pose(np.zeros(3), turned, 0.0, 0.0) @ np.linalg.inv(
            camera_pose(np.zeros(3), 0.0, 0.0, 0.0)
        )
        poses.append(whole @ pose)
    return poses


def sequence(count: int, seed: int, turned: float = 0.0) -> list[Frame]:
    """Return pictures of a way through the room, seen anew by every seed."""
    draws, blocks = np.random.default_rng([seed, 2]), room(turned)
    return [
        Frame(depth_picture(blocks, pose, draws), pose) for pose in carried(count, seed, turned)
    ]


def odometry(poses: list[Floats], seed: int) -> list[Floats]:
    """Return steps (4, 4), previous from current, as a visual odometry has them: 2 % of the way."""
    draws = np.random.default_rng([seed, 3])
    steps = [np.eye(4)]
    scale, turn = 1.0 + 0.02 * draws.normal(), 0.0005 * draws.normal(size=3)
    for before, now in pairwise(poses):
        step = np.linalg.inv(before) @ now
        step[:3, 3] = scale * step[:3, 3] + 0.002 * draws.normal(size=3)
        step[:3, :3] = step[:3, :3] @ small_turn(turn + 0.002 * draws.normal(size=3))
        steps.append(step)
    return steps


def small_turn(vector: Floats) -> Floats:
    """Return the rotation (3, 3) about a vector by its length, rad."""
    angle = float(np.linalg.norm(vector))
    if angle < 1e-12:
        return np.eye(3)
    x, y, z = vector / angle
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * (k @ k)


def points(frame: Frame) -> Floats:
    """Return what a picture saw, (n, 3) m in the world."""
    seen = np.isfinite(frame.depth)
    rays = sight()[seen] * frame.depth[seen].astype(float)[:, None]
    return np.ascontiguousarray(rays @ frame.pose[:3, :3].T + frame.pose[:3, 3])


def measured_map(
    resolution: float, seed: int = 1000, turned: float = 0.0, count: int = 150
) -> Octree:
    """Return the octree of a way of its own through the room, all poses known."""
    tree = Octree(resolution)
    for frame in sequence(count, seed, turned):
        x, y, z = (float(at) for at in frame.pose[:3, 3])
        tree.insert(points(frame), (x, y, z))
    return tree
