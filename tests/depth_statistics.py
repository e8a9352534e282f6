"""What a camera's errors are like, for any model that makes measured depth of exact depth."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
See = Callable[[Floats, NDArray[np.int32], Floats, Floats], NDArray[np.float32]]
"""Measured depth of exact depth, geoms, the camera's position and its rotation."""
FOCAL = 101.4
SHAPE = (72, 88)


def turned(angle: float) -> Floats:
    """A camera that has turned about its vertical axis by radians."""
    sine, cosine = np.sin(angle), np.cos(angle)
    return np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])


def heap(shape: tuple[int, int] = SHAPE, focal: float = FOCAL) -> tuple[Floats, NDArray[np.int32]]:
    """A floor with steps and boxes on it, nothing above the horizon: depth and geoms."""
    v = (np.arange(shape[0])[:, None] - (shape[0] - 1) / 2) / focal
    u = (np.arange(shape[1])[None, :] - (shape[1] - 1) / 2) / focal
    down = v * np.cos(0.5) + np.sin(0.5) + 0.0 * u
    ahead = np.cos(0.5) - v * np.sin(0.5) + 0.0 * u
    with np.errstate(divide="ignore"):
        depth = np.where(down > 0.02, 0.5 / down, np.inf)
    geom = np.where(np.isfinite(depth), 0, -1).astype(np.int32)
    for index, (left, right, low, high, far) in enumerate(
        [(-0.3, 0.1, 0.0, 0.04, 0.8), (-0.1, 0.2, 0.0, 0.3, 1.1), (0.15, 0.4, 0.0, 0.5, 0.7)], 1
    ):
        front = far / ahead
        rise = 0.5 - front * down
        met = (front * u > left) & (front * u < right) & (rise > low) & (rise < high)
        met &= front < depth
        depth, geom = np.where(met, front, depth), np.where(met, index, geom)
    return np.where(np.isfinite(depth), depth, np.nan), geom.astype(np.int32)


def wall(depth: float, shape: tuple[int, int] = SHAPE) -> tuple[Floats, NDArray[np.int32]]:
    """A wall straight ahead."""
    return np.full(shape, depth), np.zeros(shape, np.int32)


def disparity_errors(
    see: See,
    scene: tuple[Floats, NDArray[np.int32]],
    scale: float,
    frames: int,
    *,
    way: float = 0.05,
) -> Floats:
    """Errors of frames, (frames, h, w) px, NaN for nothing; the camera goes `way` m between."""
    found = []
    for frame in range(frames):
        depth = see(*scene, np.array([way * frame, 0.0, 0.5]), np.eye(3)).astype(np.float64)
        found.append(scale / depth - scale / scene[0])
    return np.stack(found)


def summary(errors: Floats) -> dict[str, float]:
    """Share seen, deviation and bias of what is no mismatch, share of gross ones, quantiles."""
    seen = errors[np.isfinite(errors)]
    fine = seen[np.abs(seen) < 0.6]
    sizes = np.quantile(np.abs(seen), [0.5, 0.9, 0.95])
    return {
        "seen": float(np.isfinite(errors).mean()),
        "deviation": float(fine.std()),
        "bias": float(fine.mean()),
        "gross": float(np.mean(np.abs(seen) > 1.0)),
        "half": float(sizes[0]),
        "nine in ten": float(sizes[1]),
        "nineteen in twenty": float(sizes[2]),
    }


def correlation(first: Floats, second: Floats) -> float:
    """Of two sets of errors, where both are seen and neither is gross."""
    both = (np.abs(first) < 0.6) & (np.abs(second) < 0.6)
    return float(np.mean(first[both] * second[both]) / np.mean(first[both] ** 2))


def neighbours(errors: Floats, most: int) -> list[float]:
    """Correlation of errors so many columns, and then rows, apart."""
    across = [correlation(errors[:, :, :-shift], errors[:, :, shift:]) for shift in range(1, most)]
    down = [correlation(errors[:, :-shift], errors[:, shift:]) for shift in range(1, most)]
    return across + down


def patches(errors: Floats) -> float:
    """How much more often a pixel is missing beside a missing one, of those that may be seen."""
    missing = np.isnan(errors[:, 4:-4, 24:-4])
    return float(np.mean(missing[:, :, 1:] & missing[:, :, :-1]) / np.mean(missing) ** 2)


def motion(see: See, scale: float, moves: list[tuple[float, float, float]]) -> list[float]:
    """Correlation of the errors of a wall with those after moves: turn rad, way m, disparity px."""
    found = []
    for turn, way, nearer in moves:
        of_frame = []
        for frame in range(12):
            place = np.array([0.05 * frame, 0.0, 0.5])
            pair = []
            for moved in (0.0, 1.0):
                true = scale / (scale / 0.6 + moved * nearer)
                depth = see(
                    *wall(true), place + np.array([moved * way, 0.0, 0.0]), turned(moved * turn)
                )
                pair.append(scale / depth.astype(np.float64) - scale / true)
            of_frame.append(correlation(*pair))
        found.append(float(np.mean(of_frame)))
    return found
