"""Walls as lines: of one scan (Fig. 36.4), and of a whole log (Fig. 36.5)."""

import json
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.collections import LineCollection
from numpy.typing import NDArray

from treadwell._core import find_lines, split_and_merge
from treadwell.experiments.indoor.figure import panels, save
from treadwell.sources.laser_log import open_laser_log

Floats = NDArray[np.float64]

_THRESHOLDS_M: Final = (1.0, 0.3, 0.05)
"""From coarse to fine: a piece is split where a point lies further off its line."""
_NOISE_M: Final = 0.01
_SIGMA_M: Final = 0.03
_HELD: Final = 0.9
_LINE: Final = "#e2571e"


def draw_split_and_merge(path: Path, _source: Path) -> str:
    """Draw the lines of one scan of a room with a recess, by ever smaller thresholds; Fig. 36.4."""
    points = _room_scan()
    figure, axes = panels(len(_THRESHOLDS_M), (3.2, 3.0))
    counts = []
    for place, threshold in zip(axes, _THRESHOLDS_M, strict=True):
        settings = json.dumps({"threshold": threshold, "least_points": 2})
        found = split_and_merge(points, settings)
        counts.append(len(found))
        place.plot(*points.T, ".", color="#17181c", markersize=1.5)
        ends = [
            [_on(points[at], normal, distance) for at in (first, last)]
            for first, last, normal, distance in found
        ]
        place.add_collection(LineCollection(ends, colors=_LINE, linewidths=1.4))
        place.set_title(f"within {threshold:g} m: {len(found)} lines", fontsize=9, loc="left")
    save(figure, path)
    told = " / ".join(str(count) for count in counts)
    limits = " / ".join(f"{threshold:g}" for threshold in _THRESHOLDS_M)
    begun = "of the 8 walls the scan begins on one"
    return f"{told} lines within {limits} m of {len(points)} points; {begun}"


def draw_lines(path: Path, source: Path) -> str:
    """Draw the lines that hold most points of a laser log; Fig. 36.5."""
    frames = [frame for frame in open_laser_log(source) if frame.points is not None]
    scans = [
        np.asarray(frame.points, np.float64) @ frame.world_from_sensor[:3, :3].T
        + frame.world_from_sensor[:3, 3]
        for frame in frames
    ]
    points = np.concatenate(scans)[:, :2]
    points = np.ascontiguousarray(points[np.isfinite(points).all(axis=1)])
    found = find_lines(points, json.dumps({"sigma": _SIGMA_M, "held": _HELD}))
    figure, (left, right) = panels(2, (5.0, 4.6))
    left.plot(*points[::20].T, ",", color="#17181c")
    left.set_title(f"{len(points)} points, every twentieth", fontsize=9, loc="left")
    right.add_collection(
        LineCollection(list(found["ends"].reshape(-1, 2, 2)), colors="#17181c", linewidths=1.0)
    )
    right.set_title(f"{len(found['normal'])} lines", fontsize=9, loc="left")
    low, high = np.percentile(points, [0.1, 99.9], axis=0)
    for place in (left, right):
        place.set_xlim(low[0] - 1.0, high[0] + 1.0)
        place.set_ylim(low[1] - 1.0, high[1] + 1.0)
    save(figure, path)
    return (
        f"{len(found['normal'])} lines hold {found['held']:.1%} of {len(points)} points within "
        f"{2e2 * _SIGMA_M:.0f} cm"
    )


def _on(point: Floats, normal: float, distance: float) -> Floats:
    """Return the point of a line nearest to another one."""
    across = np.array([np.cos(normal), np.sin(normal)])
    off = float(point @ across) - distance
    return np.asarray(point - off * across)


def _room_scan() -> Floats:
    """Return what a laser in a room with a recess sees, points (n, 2) m in order."""
    corners = np.array(
        [(-2.0, -1.5), (2.5, -1.5), (2.5, 1.0), (1.2, 1.0), (1.2, 2.0), (-0.6, 2.0), (-0.6, 1.4),
         (-2.0, 1.4), (-2.0, -1.5)]
    )  # fmt: skip
    numbers = np.random.default_rng(4)
    seen = []
    for angle in np.radians(np.arange(-179.5, 180.0, 1.0)):
        ray = np.array([np.cos(angle), np.sin(angle)])
        best = np.inf
        for one, other in pairwise(corners):
            solved = np.linalg.lstsq(np.stack([ray, one - other], axis=1), one, rcond=None)[0]
            on_wall = np.allclose(solved[0] * ray, one + solved[1] * (other - one))
            if on_wall and solved[0] > 0.0 and 0.0 <= solved[1] <= 1.0:
                best = min(best, float(solved[0]))
        seen.append((best + _NOISE_M * numbers.standard_normal()) * ray)
    return np.array(seen)
