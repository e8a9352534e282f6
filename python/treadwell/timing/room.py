"""The fixed workload: a room with a sill, steps and boxes, seen on a walk through it."""

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.timing.frames import Frames, read_frames

CAMERAS: Final = {"88x72": (88, 72, 47.0), "320x240": (320, 240, 58.0)}
"""Width, height, and degrees across: a small stereo camera, and what a Kinect gives."""
CAMERA_HEIGHT: Final = 0.5
_DOWN: Final = 0.52
"""Radians below the horizon."""
_NOISE: Final = 0.0019
"""Standard deviation of the depth at 1 m, m; it grows with the square."""


def _boxes() -> NDArray[np.float64]:
    """Return (boxes, 2, 3) m: lowest and highest corner of each."""
    rng = np.random.default_rng(7)
    walls = [
        [[-2.1, -2.6, 0.0], [-2.0, 2.6, 2.4]],
        [[5.5, -2.6, 0.0], [5.6, 2.6, 2.4]],
        [[-2.1, -2.6, 0.0], [5.6, -2.5, 2.4]],
        [[-2.1, 2.5, 0.0], [5.6, 2.6, 2.4]],
    ]
    sill = [[[0.87, -1.2, 0.0], [0.93, 1.2, 0.038]]]
    steps = [[[2.0 + 0.2 * i, -0.6, 0.0], [3.6, 0.6, 0.04 * (i + 1)]] for i in range(4)]
    things = []
    for _ in range(16):
        x, y = rng.uniform(-1.2, 5.2), rng.choice([-1.0, 1.0]) * rng.uniform(0.85, 2.3)
        size, height = rng.uniform(0.04, 0.18, 2), rng.uniform(0.08, 0.8)
        things.append([[x - size[0], y - size[1], 0.0], [x + size[0], y + size[1], height]])
    return np.array(walls + sill + steps + things)


def workloads(given: str) -> list[Frames]:
    """Return the frames of a file, or of each camera so many of the walk's.

    Args:
        given: a path, or how many, in digits.

    Raises:
        InputError: none are asked for, or the file holds no frames.
    """
    if not given.isdecimal():
        return [read_frames(Path(given))]
    if int(given) < 1:
        raise InputError(f"--frames must be 1 or more, or a file, got {given}")
    return [room(camera, int(given)) for camera in CAMERAS]


def room(camera: str, count: int) -> Frames:
    """Return the walk's frames, the same ones every time.

    Args:
        camera: a name of `CAMERAS`.
        count: how many.
    """
    width, height, across = CAMERAS[camera]
    focal = 0.5 * width / np.tan(0.5 * np.radians(across))
    share = np.linspace(0.0, 1.0, count)
    yaw = 0.7 * np.sin(4.0 * np.pi * share)
    position = np.stack(
        [-1.0 + 2.5 * share, 0.15 * np.sin(2.0 * np.pi * share), np.full(count, CAMERA_HEIGHT)],
        axis=1,
    )
    frames = Frames(
        name="room",
        focal=(focal, focal),
        centre=(0.5 * (width - 1), 0.5 * (height - 1)),
        depth=np.zeros((count, height, width), np.float32),
        rotation=np.stack([_looking(angle) for angle in yaw]),
        position=position,
    )
    boxes, rng = _boxes(), np.random.default_rng(1)
    directions = frames.directions()
    for image, rotation, eye in zip(frames.depth, frames.rotation, position, strict=True):
        depth = _depth(eye, directions @ rotation.T, boxes)
        image[:] = depth + _NOISE * depth**2 * rng.standard_normal(depth.shape)
    return frames


def _looking(yaw: float) -> NDArray[np.float64]:
    """Return the camera's axes in the world: right, down, forward."""
    cos, sin = np.cos(yaw), np.sin(yaw)
    forward = np.array([cos * np.cos(_DOWN), sin * np.cos(_DOWN), -np.sin(_DOWN)])
    right = np.array([sin, -cos, 0.0])
    return np.stack([right, np.cross(forward, right), forward], axis=1)


def _depth(
    eye: NDArray[np.float64], along: NDArray[np.float64], boxes: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return where rays meet the first box or the floor, in units of `along`."""
    with np.errstate(divide="ignore", invalid="ignore"):
        nearest = np.where(along[..., 2] < 0.0, -eye[2] / along[..., 2], np.inf)
        for corners in boxes:
            borders = (corners[:, None, None] - eye) / along
            enter = borders.min(axis=0).max(axis=-1)
            leave = borders.max(axis=0).min(axis=-1)
            meets = (enter < leave) & (enter > 0.0)
            nearest = np.where(meets & (enter < nearest), enter, nearest)
    return np.where(np.isfinite(nearest), nearest, 0.0)
