"""Sonars: what one says, and a corridor mapped by 18 scans of 24 of them (Figs 36.1 to 36.3).

A sonar is no sense of the robot: its echoes are cast from walls here, with 2 cm of noise.
"""

from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from treadwell._core import OccupancyMap
from treadwell.experiments.indoor.figure import panels, save

Floats = NDArray[np.float64]

_CELL: Final = 0.1
_SCANS: Final = 18
_BEAMS: Final = 24
_LENGTH, _WIDTH, _DEEP = 9.0, 2.4, 1.0
_DOORWAYS: Final = ((2.0, 2.9), (6.2, 7.1))
"""Where the upper wall opens into rooms, from and to, m along the corridor."""
_HALF_OPENING: Final = 0.2
_REACH_M: Final = 6.0
_NOISE_M: Final = 0.02
_SURE: Final = 0.02
"""A cell nearer to 0.5 than this counts as unknown."""
_RANGES_M: Final = (2.0, 2.5)
"""Of Fig. 36.1."""


def draw_sonar(path: Path, _source: Path) -> str:
    """Draw what one measurement of a sonar says of the cells before it; Fig. 36.1."""
    figure, axes = panels(len(_RANGES_M), (4.2, 2.6))
    told = []
    for place, heard in zip(axes, _RANGES_M, strict=True):
        core = OccupancyMap('{"cell": 0.02}')
        core.insert_sonar((0.0, 0.0, 0.0), [0.0], [heard])
        _cells(place, core)
        place.plot(0.0, 0.0, "k>", markersize=6)
        place.set_title(f"an echo at {heard} m", fontsize=9, loc="left")
        (x, y), cell, probability, _ = core.cells()
        axis = probability[int(-y / cell)]
        told.append(f"{np.nanmax(axis):.2f} at {x + cell * (np.nanargmax(axis) + 0.5):.2f} m")
    save(figure, path)
    return f"most probable on the axis: {', '.join(told)}"


def draw_corridor(path: Path, _source: Path) -> str:
    """Draw local maps of single scans, and the map that they join to; Figs 36.2 and 36.3."""
    whole, first = OccupancyMap(f'{{"cell": {_CELL}}}'), []
    numbers = np.random.default_rng(0)
    way = []
    for scan in range(_SCANS):
        pose, bearings, ranges = _scan(scan, numbers)
        way.append(pose)
        whole.insert_sonar(pose, bearings, ranges)
        if scan in {0, _SCANS // 2}:
            local = OccupancyMap(f'{{"cell": {_CELL}}}')
            local.insert_sonar(pose, bearings, ranges)
            first.append((f"scan {scan + 1} of {_SCANS}", local, [pose]))
    figure, axes = panels(3, (4.0, 2.4))
    for place, (title, core, poses) in zip(axes, [*first, ("all scans", whole, way)], strict=True):
        _cells(place, core)
        for wall in _walls():
            place.plot(*wall.T, color="#e2571e", linewidth=0.9)
        place.plot(*np.array(poses)[:, :2].T, ".", color="#ff5fa2", markersize=4)
        place.set_xlim(-0.6, _LENGTH + 0.6)
        place.set_ylim(-0.6, _WIDTH + _DEEP + 0.6)
        place.set_title(title, fontsize=9, loc="left")
    save(figure, path)
    right, count = _right(whole)
    return f"{right / count:.0%} of {count} cells of corridor and walls right, unknown is wrong"


def _cells(place: Axes, core: OccupancyMap) -> None:
    """Draw how probably cells are occupied: white is free, black occupied, grey unknown."""
    (x, y), cell, probability, _ = core.cells()
    rows, cols = probability.shape
    place.set_facecolor("#ccccd1")
    place.imshow(
        np.ma.masked_invalid(1.0 - probability),
        origin="lower",
        extent=(x, x + cols * cell, y, y + rows * cell),
        cmap="gray",
        vmin=0.0,
        vmax=1.0,
        interpolation="nearest",
    )


def _walls() -> list[Floats]:
    """Return the corridor's walls: ends (2, 2) m of each."""
    corners = [(0.0, _WIDTH)]
    for left, right in _DOORWAYS:
        up = _WIDTH + _DEEP
        corners += [(left, _WIDTH), (left, up), (right, up), (right, _WIDTH)]
    corners += [(_LENGTH, _WIDTH), (_LENGTH, 0.0), (0.0, 0.0), (0.0, _WIDTH)]
    return [np.array(pair) for pair in pairwise(corners)]


def _true_range(at: Floats, angle: float) -> float:
    """Return the distance to the nearest wall in a direction, m."""
    ray = np.array([np.cos(angle), np.sin(angle)])
    best = np.inf
    for one, other in _walls():
        along, off = other - one, one - at
        across = ray[0] * along[1] - ray[1] * along[0]
        if abs(across) > 1e-12:  # not along the wall
            distance = (off[0] * along[1] - off[1] * along[0]) / across
            part = (off[0] * ray[1] - off[1] * ray[0]) / across
            if distance > 0.0 and 0.0 <= part <= 1.0:
                best = min(best, float(distance))
    return best


def _scan(
    number: int, numbers: np.random.Generator
) -> tuple[tuple[float, float, float], list[float], list[float]]:
    """Return pose, directions and ranges of a scan: each the nearest thing in the cone."""
    x = 0.7 + (_LENGTH - 1.4) * number / (_SCANS - 1)
    y = 0.5 * _WIDTH + 0.15 * numbers.uniform(-1.0, 1.0)
    yaw = 0.2 * numbers.uniform(-1.0, 1.0)
    bearings = (2.0 * np.pi * np.arange(_BEAMS) / _BEAMS).tolist()
    cone = _HALF_OPENING * np.linspace(-1.0, 1.0, 21)
    at = np.array([x, y])
    nearest = [min(_true_range(at, yaw + bearing + off) for off in cone) for bearing in bearings]
    heard = np.array(nearest) + _NOISE_M * numbers.standard_normal(_BEAMS)
    return (
        (float(x), float(y), float(yaw)),
        bearings,
        np.where(heard < _REACH_M, heard, np.nan).tolist(),
    )


def _right(core: OccupancyMap) -> tuple[int, int]:
    """Return how many cells between the corridor's ends are right, and how many there are."""
    (left, low), cell, probability, _ = core.cells()
    rows, cols = np.indices(probability.shape)
    x, y = left + cell * (cols + 0.5), low + cell * (rows + 0.5)
    doorway = np.zeros(x.shape, np.bool_)
    for one, other in _DOORWAYS:
        doorway |= (x > one) & (x < other)
    lower, upper = np.abs(y) <= cell / 2, (np.abs(y - _WIDTH) <= cell / 2) & ~doorway
    wall = lower | upper
    inside = (y > cell) & (y < _WIDTH - cell)
    asked = (wall | inside) & (x > cell) & (x < _LENGTH - cell)
    known = np.abs(np.nan_to_num(probability, nan=0.5) - 0.5) > _SURE
    right = known & ((probability > 0.5) == wall)
    return int((right & asked).sum()), int(asked.sum())
