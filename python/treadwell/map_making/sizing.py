"""What a world model's settings are where the user left them and the data asks for others."""

from copy import deepcopy
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from treadwell.components import TABLES
from treadwell.map_making.placing import Placing, sensed
from treadwell.reference.parameters import all_tables
from treadwell.sources.frame import Floats, PinholeCamera, RangeFrame

_COUNTS: Final = {"fog": "cells", "averaging": "cells", "elevation": "window"}
"""Table -> the key with the number of cells along a side of the window, where it has one."""
_FUSED: Final = "fusion.voxel"
"""The key of the voxels in which the frames of a mesh are fused."""
_SCAN_CELL_M: Final = 0.05
"""Side of the cells in which a laser's points are shown, where nobody says."""
_ROBOT_M: Final = 0.25
"""About as wide as a robot: points further apart are those of a landscape from above."""
_ANY_SLOPE_M: Final = 1e6
ALTITUDE: Final = 10.0
"""How high above a cloud, in its reach, the eye is put where nobody says where it was."""
_MOST_CELLS: Final = 2000
_POINTS_APART: Final = 1.5
"""Side of a cell, in distances between a cloud's points, at which most cells have one."""
_WHOLE: Final = 1e-6
"""By so much of a voxel a cell may miss a whole number of them."""
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
        filters_ground: whether a cloud's ground is told from what stands on it.
    """

    cell: float
    parameters: dict[str, dict[str, Any]]
    assumed: dict[str, Any] = field(default_factory=dict)
    altitude: float = 0.0
    filters_ground: bool = False


def sizing(
    world_model: str,
    parameters: dict[str, dict[str, Any]],
    seen: tuple[RangeFrame, Placing],
    ground: str,
) -> Sizing:
    """Return the settings for a source whose first frame is this one.

    Cells are as large as the points of a cloud lie apart, where that is more than the default; the
    window holds what a frame sees. Nothing shifts or turns what has a pose that is known, and no
    robot stands below the sensor. Where it is not known from where a cloud was seen, nothing is
    cleared by lines of sight. The ground of a cloud from above, whose points lie further apart than
    a robot is wide, is told from what stands on it.

    Args:
        world_model: its name.
        parameters: table -> key -> value, the user's.
        seen: the first frame, and how its world lies to the map's.
        ground: `auto`, `filter` or `all`.
    """
    first, placing = seen
    table = _table_with_cells(world_model)
    made = {key: deepcopy(values) for key, values in parameters.items()}
    if table is None or first.layout == "scan":
        return Sizing(float(made.get(table or "", {}).get("cell", _SCAN_CELL_M)), made)
    own = made.setdefault(table, {})
    defaults = _defaults(table)
    pose = placing.pose(first.world_from_sensor)
    reach, spacing = _extent(sensed(first).astype(np.float64) @ pose[:3, :3].T, first)
    found = Sizing(_cell(own, float(defaults["cell"]), reach, spacing), made)
    if not first.origin_known:
        found.altitude = ALTITUDE * max(reach, 1.0)
    apart = not first.origin_known and spacing > _ROBOT_M
    found.filters_ground = first.layout == "cloud" and (
        ground == "filter" or (ground == "auto" and apart)
    )
    follow = _following(found, defaults, reach, _COUNTS.get(table, "window"))
    scale = _scale(found.cell, defaults)
    for other in sorted(TABLES["world_model"][world_model] - {table}):
        _set_aside(found, other, {**follow, **_voxels(other, found.cell, scale)})
    for key, value in follow.items():
        if key in defaults and key not in own and value != defaults[key]:
            own[key] = value
            found.assumed[f"navigation.{table}.{key}"] = value
    return found


def pooled(camera: PinholeCamera, columns: int) -> int:
    """Return how many pixels a side are one, for a picture of so many columns at most."""
    return max(1, -(-camera.width // columns))


def _table_with_cells(world_model: str) -> str | None:
    """Return the table of a world model that has the side of its cells; None where none has."""
    tables = sorted(TABLES["world_model"].get(world_model, ()))
    return next((table for table in tables if "cell" in _defaults(table)), None)


def _voxels(table: str, cell: float, scale: float) -> dict[str, float]:
    """Return the side of a table's voxels that goes with such cells, under the table's own key.

    An octree's is its default where cells are whole numbers of it, or that of a cell; the voxels of
    which a mesh is read grow as the cells do: between points so far apart nothing finer is known.

    Args:
        table: its name.
        cell: m, side of the map's cells.
        scale: how much larger they are than they are by default.
    """
    defaults = _defaults(table)
    if _FUSED in defaults:
        return {_FUSED: round(defaults[_FUSED] * scale, 6)}
    voxel = defaults.get("resolution")
    if voxel is None:
        return {}
    parts = cell / voxel
    fits = round(parts) >= 1 and abs(parts - round(parts)) < _WHOLE
    return {"resolution": voxel if fits else cell}


def _set_aside(found: Sizing, table: str, follow: dict[str, Any]) -> None:
    """Put what follows into a second table of the model, as far as it has the keys."""
    own, defaults = found.parameters.setdefault(table, {}), _defaults(table)
    for path in sorted(set(follow) & set(defaults)):
        *groups, key = path.split(".")
        place = own
        for group in groups:
            place = place.setdefault(group, {})
            if not isinstance(place, dict):
                return  # no table: the core refuses it by its name
        if key not in place and follow[path] != defaults[path]:
            place[key] = follow[path]
            found.assumed[f"navigation.{table}.{path}"] = follow[path]


def _cell(own: dict[str, Any], default: float, reach: float, spacing: float) -> float:
    """Return the side of a cell, m: the user's, or what the data asks for."""
    if "cell" in own:
        return float(own["cell"])
    cell = default
    if _POINTS_APART * spacing > cell:
        cell = _round(_POINTS_APART * spacing)
    return _round(2.0 * reach / _MOST_CELLS, up=True) if 2.0 * reach > cell * _MOST_CELLS else cell


def _scale(cell: float, defaults: dict[str, Any]) -> float:
    """Return how much larger cells are than they are by default; 1 where they are smaller."""
    return max(1.0, cell / float(defaults["cell"]))


def _following(found: Sizing, defaults: dict[str, Any], reach: float, count: str) -> dict[str, Any]:
    """Return key -> value of what follows from cell, reach and eye."""
    scale = _scale(found.cell, defaults)
    cells = min(int(np.ceil(2.0 * reach / found.cell)) + 4, _MOST_CELLS)
    far = 2.0 * max(reach, found.altitude)
    values: dict[str, Any] = {
        "cell": found.cell,
        count: max(cells, defaults.get(count, 0)),
        "max_range": max(defaults["max_range"], round(far, 3)),
        "match_gate": 0.0,
        "footprint": 0.0,
    }
    scaled = {key: defaults[key] * scale for key in ("rise", "fill") if key in defaults}
    values |= {key: round(value, 6) for key, value in scaled.items()}
    if found.filters_ground:
        values["rise"] = _ANY_SLOPE_M  # what stands on the ground is known by itself
    if found.altitude and isinstance(defaults.get("clearing"), bool):
        values |= {"clearing": False, "sigma_per_metre": 0.0}
    return values


def _extent(points: Floats, frame: RangeFrame) -> tuple[float, float]:
    """Return how far points reach from the sensor over the ground, and how far apart they lie."""
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
    """Return key -> default of a table of `[navigation]`; keys of a table in it with its name."""
    name = f"navigation.{table}"
    rows = next(one.parameters for one in all_tables() if one.key == name)
    return {row.key.removeprefix(f"{name}."): row.default for row in rows}
