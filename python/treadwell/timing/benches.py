"""What `treadwell bench` times: the occupancy update alone, and all from depth image to view."""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from time import perf_counter
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell._core import OccupancyGrid, Segmenter, WorldModel
from treadwell.timing.frames import Frames

CLEARING: Final = {"exact": "every_ray", "shared": "shared", "projected": "projected"}
"""The modes, the reference first, and how `[navigation.fog]` calls them."""
_CELL: Final = 0.04
_LAYERS: Final = 40
_BASELINE: Final = 0.06
_SETTLING: Final = 30
"""Frames until the segmenter is sure of the ground: before that the map takes in none."""
_GROUND: Final = {"search_reach": 1.0}
"""The camera of the bench does not see the floor beside the feet, where the ground is searched."""
_ROUNDS: Final = 3
"""Each frame counts with the least of so many times: what else the machine does is not ours."""


@dataclass(frozen=True)
class Times:
    """Milliseconds a frame."""

    p50: float
    p95: float
    worst: float
    bindings_share: float
    """Part of the time that was spent on the way from Python to the core and back."""

    def document(self) -> dict[str, float]:
        """Return it as plain data."""
        return {
            "p50": round(self.p50, 4),
            "p95": round(self.p95, 4),
            "worst": round(self.worst, 4),
            "bindings_share": round(self.bindings_share, 4),
        }


def times(calls: NDArray[np.float64], core: NDArray[np.float64]) -> Times:
    """Return the times of a bench.

    Args:
        calls: (rounds, frames) seconds of each call.
        core: the part of each that the core itself took.
    """
    best = 1e3 * calls.min(axis=0)
    own = 1e3 * core.min(axis=0)
    return Times(
        p50=float(np.median(best)),
        p95=float(np.percentile(best, 95)),
        worst=float(best.max()),
        bindings_share=float(max(0.0, 1.0 - own.sum() / best.sum())),
    )


@dataclass(frozen=True)
class Agreement:
    """Of the fast mode's map with the exact mode's, voxel by voxel or cell by cell."""

    occupied: float
    """Of those that one of the two calls occupied, the share that both do."""
    free: float
    """Of those that the exact mode calls free, the share that the fast one does."""
    freed: int
    """Free for the fast mode, occupied for the exact one."""

    def document(self) -> dict[str, float]:
        """Return it as plain data."""
        return {"occupied": self.occupied, "free": self.free, "freed": self.freed}


def agreement(exact: NDArray[np.float32], fast: NDArray[np.float32]) -> Agreement:
    """Return how far two maps agree.

    Args:
        exact: probabilities of the exact mode's voxels.
        fast: of the fast mode's.
    """
    even = 0.5
    either = (exact > even) | (fast > even)
    both = (exact > even) & (fast > even)
    free = exact < even
    return Agreement(
        occupied=float(both.sum() / max(1, either.sum())),
        free=float((free & (fast < even)).sum() / max(1, free.sum())),
        freed=int(((fast < even) & (exact > even)).sum()),
    )


def grids(clouds: Sequence[NDArray[np.float64]]) -> dict[str, OccupancyGrid]:
    """Return a new grid of each mode, large enough for most of the points.

    Args:
        clouds: (n, 3) m, frame by frame.
    """
    corner, size = _around(clouds)
    return {
        mode: OccupancyGrid(size, corner, settings=json.dumps({"cell": _CELL, "clearing": name}))
        for mode, name in CLEARING.items()
    }


def occupancy(frames: Frames) -> dict[str, Any]:
    """Time the occupancy update alone, all modes frame by frame in turn.

    Args:
        frames: what is seen.
    """
    count = len(frames.depth)
    clouds = [frames.points(index) for index in range(count)]
    calls = {mode: np.zeros((_ROUNDS, count)) for mode in CLEARING}
    core = {mode: np.zeros((_ROUNDS, count)) for mode in CLEARING}
    maps = grids(clouds)
    for turn in range(_ROUNDS):
        maps = grids(clouds)
        for index in range(count):
            seen = (frames.picture(index), frames.camera(index), frames.focal, frames.centre)
            for mode, grid in maps.items():
                calls[mode][turn, index] = _timed(partial(grid.insert_picture, *seen))
                core[mode][turn, index] = grid.seconds
    found = {mode: grid.probability() for mode, grid in maps.items()}
    return {
        "bench": "occupancy",
        "frames": f"{frames.name} {frames.shape}",
        "count": count,
        "modes": {
            mode: {
                **times(calls[mode], core[mode]).document(),
                "ratio": _ratio(calls["exact"], calls[mode]),
                "agreement": agreement(found["exact"], found[mode]).document(),
            }
            for mode in CLEARING
        },
    }


def step(frames: Frames) -> dict[str, Any]:
    """Time the whole step from the depth image to floors and obstacles, all modes in turn.

    Args:
        frames: what is seen. The robot stands under the camera, on the plane z = 0.
    """
    count = len(frames.depth)
    segment = {mode: np.zeros((_ROUNDS, count)) for mode in CLEARING}
    insert = {mode: np.zeros((_ROUNDS, count)) for mode in CLEARING}
    core = {mode: np.zeros((_ROUNDS, count)) for mode in CLEARING}
    used = dict.fromkeys(CLEARING, 0)
    chain = _chains(frames)
    for turn in range(_ROUNDS):
        chain = _chains(frames)
        for index in range(count):
            seen, pose, camera = _standing(frames, index)
            for mode, (segmenter, model) in chain.items():
                started = perf_counter()
                planes = segmenter.segment(seen, camera)
                between = perf_counter()
                used[mode] += model.insert(planes, pose)
                insert[mode][turn, index] = perf_counter() - between
                segment[mode][turn, index] = between - started
                core[mode][turn, index] = segmenter.seconds + model.seconds
    whole = {mode: segment[mode] + insert[mode] for mode in CLEARING}
    kinds = {mode: model.view().kind for mode, (_, model) in chain.items()}
    return {
        "bench": "step",
        "frames": f"{frames.name} {frames.shape}",
        "count": count,
        "modes": {
            mode: {
                **times(whole[mode], core[mode]).document(),
                "used": used[mode] // _ROUNDS,
                "segment_p50": _p50(segment[mode]),
                "map_p50": _p50(insert[mode]),
                "ratio": _ratio(whole["exact"], whole[mode]),
                "agreement": {"cells": _same_cells(kinds["exact"], kinds[mode])},
            }
            for mode in CLEARING
        },
    }


def _chains(frames: Frames) -> dict[str, tuple[Segmenter, WorldModel]]:
    """Return a segmenter that has found the ground, and an empty map, for each mode."""
    _, height, width = frames.depth.shape
    chains = {
        mode: (
            Segmenter(
                "scan_line",
                width=width,
                height=height,
                focal=frames.focal[0],
                baseline=_BASELINE,
                settings=json.dumps({"ground": _GROUND}),
            ),
            WorldModel("fog", settings=json.dumps({"fog": {"clearing": name}})),
        )
        for mode, name in CLEARING.items()
    }
    seen, _pose, camera = _standing(frames, 0)
    for segmenter, _model in chains.values():
        for _ in range(_SETTLING):
            segmenter.segment(seen, camera)
    return chains


def _same_cells(exact: NDArray[np.uint8], mode: NDArray[np.uint8]) -> float:
    """Return which share of the cells that the exact mode knows is the same."""
    known = exact > 0
    return float((exact == mode)[known].mean()) if known.any() else 0.0


def _p50(seconds: NDArray[np.float64]) -> float:
    """Return the median of each frame's best, ms."""
    return round(1e3 * float(np.median(seconds.min(axis=0))), 4)


def _ratio(exact: NDArray[np.float64], mode: NDArray[np.float64]) -> float:
    """Return how many times faster a mode is than the exact one, the median of the frames."""
    return round(float(np.median(exact.min(axis=0) / mode.min(axis=0))), 3)


BENCHES: Final[dict[str, Callable[[Frames], dict[str, Any]]]] = {
    "occupancy": occupancy,
    "step": step,
}


def _timed(call: Callable[[], object]) -> float:
    started = perf_counter()
    call()
    return perf_counter() - started


def _around(
    clouds: Sequence[NDArray[np.float64]],
) -> tuple[tuple[float, float, float], tuple[int, int, int]]:
    """Return a grid's corner and size that hold most of the points."""
    every = np.concatenate([points[::37] for points in clouds])
    low, high = np.percentile(every, [0.5, 99.5], axis=0)
    # A floor at 0 lies in the middle of its layer.
    corner = (
        _CELL * float(np.floor(low[0] / _CELL) - 2),
        _CELL * float(np.floor(low[1] / _CELL) - 2),
        _CELL * float(np.floor(low[2] / _CELL) - 1) - 0.5 * _CELL,
    )
    cols, rows = (int(np.clip((high[axis] - corner[axis]) / _CELL + 3, 1, 2000)) for axis in (0, 1))
    return corner, (cols, rows, _LAYERS)


def _standing(
    frames: Frames, index: int
) -> tuple[NDArray[np.float32], tuple[float, float, float, float], NDArray[np.float64]]:
    """Return what is seen, where the robot stands, and the camera in its frame."""
    depth = frames.depth[index]
    rotation, position = frames.rotation[index], frames.position[index]
    yaw = float(np.arctan2(rotation[1, 2], rotation[0, 2]))
    cos, sin = np.cos(yaw), np.sin(yaw)
    turned = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    camera = np.eye(4)
    camera[:3, :3] = turned @ rotation
    camera[2, 3] = position[2]
    seen = np.where(depth > 0.0, depth, np.float32(np.nan))
    return seen, (float(position[0]), float(position[1]), 0.0, yaw), camera
