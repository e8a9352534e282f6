"""What a world model's settings are where the user left them and the data asks for others."""

from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from treadwell.map_making.placing import Placing, sensed
from treadwell.reference.parameters import all_tables
from treadwell.sources.frame import RangeFrame

_TABLES: Final = {
    "fog": "fog",
    "octree": "fog",
    "averaging": "averaging",
    "elevation": "elevation",
    "extended_elevation": "elevation",
    "multi_level": "elevation",
}
"""World model -> the table that has its cells."""
_COUNTS: Final = {"fog": "cells", "averaging": "cells", "elevation": "window"}
"""Table -> the key with the number of cells along a side of the window."""
_SCAN_CELL_M: Final = 0.05
"""Side of the cells in which a laser's points are shown, where nobody says."""
ALTITUDE: Final = 10.0
"""How high above a cloud, in its reach, the eye is put where nobody knows from where it was seen."""
_MOST_CELLS: Final = 2000
_POINTS_APART: Final = 1.5
"""Side of a cell, in distances between a cloud's points, at which most cells have one."""
_REACH: Final = 99.5
"""Percentile of the points' distances that the window reaches."""


@dataclass(slots=True)
class Sizing:
    """Settings that follow from the data.

    Attributes:
        cell: m, side of the map's cells.
        parameters: table -> key -> value, the user's own among them.
        assumed: key -> value, of what the user did not set.
        altitude: m above the sensor's frame, where the eye of a cloud is put of which nobody knows
            from where it was seen; 0 where it is known.
    """

    cell: float
    parameters: dict[str, dict[str, Any]]
    assumed: dict[str, Any] = field(default_factory=dict)
    altitude: float = 0.0


def sizing(
    world_model: str, parameters: dict[str, dict[str, Any]], first: RangeFrame, placing: Placing
) -> Sizing:
    """Return the settings for a source whose first frame is this one.

    Cells are as large as the points of a cloud lie apart, where that is more than the default; the
    window holds what a frame sees. Nothing shifts or turns what has a pose that is known, and no
    robot stands below the sensor. Where it is not known from where a cloud was seen, nothing is
    cleared by lines of sight.
    """
    table = _TABLES.get(world_model)
    made = {key: dict(values) for key, values in parameters.items()}
    if table is None or first.layout == "scan":
        return Sizing(float(made.get(table or "", {}).get("cell", _SCAN_CELL_M)), made)
    own = made.setdefault(table, {})
    defaults = _defaults(table)
    found = Sizing(float(own.get("cell", defaults["cell"])), made)

    def assume(key: str, value: object) -> None:
        if key not in own:
            own[key] = value
            found.assumed[f"navigation.{table}.{key}"] = value

    pose = placing.pose(first.world_from_sensor)
    points = sensed(first).astype(np.float64) @ pose[:3, :3].T
    reach, spacing = _extent(points, first)
    if "cell" not in own and _POINTS_APART * spacing > found.cell:
        found.cell = _round(_POINTS_APART * spacing)
        assume("cell", found.cell)
    count = _COUNTS[table]
    if "cell" not in own and 2.0 * reach > found.cell * _MOST_CELLS:
        found.cell = _round(2.0 * reach / _MOST_CELLS, up=True)
        assume("cell", found.cell)
    cells = int(np.ceil(2.0 * reach / found.cell)) + 4
    if cells > defaults[count]:
        assume(count, min(cells, _MOST_CELLS))
    scale = found.cell / defaults["cell"]
    if "rise" in defaults and scale > 1.0:
        assume("rise", round(defaults["rise"] * scale, 6))
    if "fill" in defaults and scale > 1.0:
        assume("fill", round(defaults["fill"] * scale, 6))
    far = 2.0 * reach if first.origin_known else 2.0 * ALTITUDE * max(reach, 1.0)
    assume("max_range", max(float(defaults["max_range"]), round(far, 3)))
    assume("match_gate", 0.0)
    assume("footprint", 0.0)
    if not first.origin_known:
        found.altitude = ALTITUDE * max(reach, 1.0)
    if table == "elevation" and not first.origin_known:
        assume("clearing", value=False)
        assume("sigma_per_metre", 0.0)
    return found


def _extent(points: "np.ndarray[Any, np.dtype[np.float64]]", frame: RangeFrame) -> tuple[float, float]:
    """Return how far points reach from the sensor over the ground, and how far apart they lie, m."""
    if not len(points):
        return 0.0, 0.0
    over_ground = points[:, :2]
    reach = float(np.percentile(np.abs(over_ground).max(axis=1), _REACH))
    if frame.layout == "picture" or frame.points is None:
        return reach, 0.0
    count = int(np.isfinite(frame.points).all(axis=1).sum())
    low, high = np.percentile(over_ground, [100.0 - _REACH, _REACH], axis=0)
    return reach, float(np.sqrt(np.prod(high - low) / max(count, 1)))


def _round(value: float, *, up: bool = False) -> float:
    """Return the nearest of 1, 2 and 5 times a power of ten, or the next one above."""
    ten = 10.0 ** np.floor(np.log10(value))
    steps = [factor * ten for factor in (1.0, 2.0, 5.0, 10.0)]
    if up:
        return float(next(step for step in steps if step >= value))
    return float(min(steps, key=lambda step: abs(np.log(step / value))))


def _defaults(table: str) -> dict[str, Any]:
    """Return key -> default of a table of `[navigation]`."""
    rows = next(one.parameters for one in all_tables() if one.key == f"navigation.{table}")
    return {row.key.rpartition(".")[2]: row.default for row in rows}
