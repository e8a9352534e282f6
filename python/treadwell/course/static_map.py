"""The map that a robot is told: of a file, or what is mapped of a course (Maier 2012, III.A)."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import mujoco
import numpy as np

from treadwell._core import Octree
from treadwell.course.course import Course, CourseElement
from treadwell.course.outlines import Floats
from treadwell.course.pieces import bounds
from treadwell.errors import InputError
from treadwell.scenario.loading import map_file_fault

MARGIN: Final = 1.0
"""Metres of ground that the map has around what stands on it, and around the start, where the
course's scale is 1."""

MOST_VOXELS: Final = 2**24
"""Voxels that the box around a map may have: what a localizer keeps of each is 8 bytes."""

RESOLUTION: Final = 0.04
"""Metres, times the robot's scale: side of a voxel where `[navigation.static_map]` says none."""

LEAST_THICKNESS: Final = 1.000001
"""Voxels: what is thinner counts as thick as this, so that it holds a middle wherever it stands."""

DOWN: Final = np.array([0.0, 0.0, -1.0])


KEYS: Final = ("file", "resolution", "surfaces", "tuning")
"""Of the table `[navigation.static_map]`. What the last two hold the core checks."""


def told_octree(
    course: Course, table: Mapping[str, object], folder: Path, where: str, scale: float = 1.0
) -> Octree:
    """Return the map by the table `[navigation.static_map]`: that of a file, or of the course.

    Args:
        course: with its elements where the scenario puts them.
        table: as the user wrote it.
        folder: the scenario file's, in which the map's file lies.
        where: the scenario's name for an error.
        scale: how large the robot is against `qrio`.

    Raises:
        InputError: the table is bad, the file broken, or the course too large.
    """
    resolution = map_resolution(table, where, scale)
    if "file" not in table:
        return static_map(course, resolution, where)
    fault = map_file_fault(table, folder)
    if fault:
        raise InputError(f"{where}: {fault}")
    try:
        return Octree.read(str(folder / str(table["file"])))
    except InputError as error:
        raise InputError(f"{where}: navigation.static_map.file: {error}") from None


def map_resolution(table: Mapping[str, object], where: str, scale: float = 1.0) -> float:
    """Return the side of a voxel, metres, by the table `[navigation.static_map]`.

    Args:
        table: as the user wrote it.
        where: the scenario's name for an error.
        scale: how large the robot is against `qrio`.

    Raises:
        InputError: there is another key, or the resolution cannot be.
    """
    for key in table:
        if key not in KEYS:
            raise InputError(
                f"{where}: navigation.static_map.{key}: unknown key; allowed: {', '.join(KEYS)}"
            )
    value = table.get("resolution", RESOLUTION * scale)
    if (
        isinstance(value, bool)
        or not isinstance(value, int | float)
        or not (math.isfinite(value) and value > 0.0)
    ):
        raise InputError(
            f"{where}: navigation.static_map.resolution: found {value!r}; a number > 0 is needed"
        )
    return float(value)


def static_map(course: Course, resolution: float, where: str) -> Octree:
    """Return the ground and all elements with `mapped = true` that stand there at the start.

    A voxel is occupied where its centre lies in a solid; solids thinner than a voxel count as one
    voxel thick. Everything else is unknown to the tree.

    Args:
        course: with its elements where the scenario puts them.
        resolution: side of a voxel, metres.
        where: the scenario's name for an error.

    Raises:
        InputError: the course is too large for voxels of this size.
    """
    data = mujoco.MjData(course.model)
    mujoco.mj_kinematics(course.model, data)
    mapped = [e for e in course.elements if e.mapped and e.present]
    low, high = _extent(course, mapped)
    count = math.prod(float(side) / resolution + 1.0 for side in high - low)
    if count > MOST_VOXELS:
        raise InputError(
            f"{where}: navigation.static_map.resolution: found {resolution:g}; voxels of this size"
            f" make {count:.3g} of the course, {MOST_VOXELS} are allowed"
        )
    tree = Octree(resolution)
    tree.occupy(_ground(low, high, resolution))
    for element in mapped:
        for geom in element.geom_ids:
            tree.occupy(_solid(course.model, data, geom, resolution))
    return tree


def _extent(course: Course, mapped: list[CourseElement]) -> tuple[Floats, Floats]:
    """Return the lowest and the highest corner of what is mapped, with the margin, metres."""
    start = np.array([[*course.start.position, course.start.height]])
    low, high = bounds((piece for element in mapped for piece in element.pieces), start)
    margin = course.scale * np.array([MARGIN, MARGIN, 0.0])
    low, high = low - margin, high + margin
    low[2] = min(low[2], 0.0)
    return low, high


def _centres(low: float, high: float, resolution: float) -> Floats:
    """Return the middles of the voxels along an axis that lie between two places, metres."""
    first, last = math.ceil(low / resolution - 0.5), math.floor(high / resolution - 0.5)
    return resolution * np.arange(first + 0.5, last + 1.0, dtype=np.float64)


def _ground(low: Floats, high: Floats, resolution: float) -> Floats:
    """Return the voxels under the plane z = 0, (n, 3) their centres."""
    x, y = (_centres(low[axis], high[axis], resolution) for axis in (0, 1))
    at = np.stack(np.meshgrid(x, y, [-0.5 * resolution], indexing="ij"), axis=-1)
    return at.reshape(-1, 3)


def _solid(model: mujoco.MjModel, data: mujoco.MjData, geom: int, resolution: float) -> Floats:
    """Return the voxels of a convex geom, (n, 3) their centres.

    Column by column: those between its lower and its upper surface.
    """
    place, turn = data.geom_xpos[geom], data.geom_xmat[geom]
    thin = 0.5 * LEAST_THICKNESS * resolution
    # The geom's own box, of which the middle is not the geom's place.
    middle = place + turn.reshape(3, 3) @ model.geom_aabb[geom, :3]
    reach = np.abs(turn.reshape(3, 3)) @ np.maximum(model.geom_aabb[geom, 3:], thin)
    low, high = middle - reach - 1e-9, middle + reach + 1e-9
    found: list[Floats] = []
    for x in _centres(low[0], high[0], resolution):
        for y in _centres(low[1], high[1], resolution):
            above = np.array([x, y, high[2] + 1.0])
            below = np.array([x, y, low[2] - 1.0])
            down = _range(model, data, geom, above, DOWN, thin)
            if down < 0.0:
                continue
            up = _range(model, data, geom, below, -DOWN, thin)
            z = _centres(below[2] + up - 1e-9, above[2] - down + 1e-9, resolution)
            found.append(np.column_stack([np.full(len(z), x), np.full(len(z), y), z]))
    return np.vstack(found) if found else np.zeros((0, 3))


def _range(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    geom: int,
    begin: Floats,
    along: Floats,
    thin: float,
) -> float:
    """Return how far along a line a geom begins, -1 for nowhere; its half sizes are >= `thin`."""
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH:
        return float(mujoco.mj_rayMesh(model, data, geom, begin, along))
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_HFIELD:
        return float(mujoco.mj_rayHfield(model, data, geom, begin, along))
    size = np.maximum(model.geom_size[geom], thin)
    distance = mujoco.mju_rayGeom(
        data.geom_xpos[geom], data.geom_xmat[geom], size, begin, along, model.geom_type[geom]
    )
    return float(distance)
