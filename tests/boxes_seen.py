"""Depth pictures of boxes on a floor, without a simulator: what tests of the library look at."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from treadwell import mapping

Floats = NDArray[np.float64]
Box = tuple[tuple[float, float, float], tuple[float, float, float]]
"""Lowest and highest corner, m."""

CAMERA = mapping.Camera(width=160, height=120, fx=150.0, fy=148.0, cx=81.0, cy=58.5)


def looking(x: float, y: float, z: float, yaw: float = 0.0, down: float = 0.6) -> Floats:
    """Return world_from_camera (4, 4) of a camera that looks down from the horizon by an angle."""
    forward = np.array([np.cos(yaw) * np.cos(down), np.sin(yaw) * np.cos(down), -np.sin(down)])
    right = np.array([np.sin(yaw), -np.cos(yaw), 0.0])
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2] = right, np.cross(forward, right), forward
    pose[:3, 3] = x, y, z
    return pose


def seen(
    boxes: Sequence[Box], pose: Floats, camera: mapping.Camera = CAMERA, floor: float = 0.0
) -> Floats:
    """Return the depths (h, w) m of boxes on a floor, NaN where there is nothing."""
    rows, cols = np.indices((camera.height, camera.width))
    rays = np.stack(
        [(cols - camera.cx) / camera.fx, (rows - camera.cy) / camera.fy, np.ones(rows.shape)], -1
    )
    along = rays @ pose[:3, :3].T
    eye = pose[:3, 3]
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = np.where(along[..., 2] < 0.0, (floor - eye[2]) / along[..., 2], np.inf)
        for low, high in boxes:
            one, two = (np.array(low) - eye) / along, (np.array(high) - eye) / along
            into = np.minimum(one, two).max(axis=-1)
            out = np.maximum(one, two).min(axis=-1)
            depth = np.where((into < out) & (into > 0.0), np.minimum(depth, into), depth)
    return np.where(np.isfinite(depth), depth, np.nan)


def flight(rise: float, tread: float, steps: int, at: float = 0.6) -> list[Box]:
    """Return stairs up along x whose first riser is at x = `at`, with a landing of 0.6 m."""
    ends = [at + tread * (k + 1) for k in range(steps - 1)] + [at + tread * (steps - 1) + 0.6]
    return [((at + tread * k, -0.3, 0.0), (ends[k], 0.3, rise * (k + 1))) for k in range(steps)]
