"""Maps in three dimensions as OctoMap has them: `map.bt` (occupied or free) and `map.ot` (odds)."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell._core import Octree
from treadwell.errors import InputError
from treadwell.exports.recorded_points import seen_points
from treadwell.files import whole_file
from treadwell.map_memory import FLOOR, OBSTACLE
from treadwell.recording.file import NAME as RECORDING
from treadwell.recording.map_file import NAME as MAP
from treadwell.recording.map_file import StoredMap, read_map

Floats = NDArray[np.float64]
RESOLUTION: Final = 0.02
"""Metres: side of a voxel where the run has no octree of its own to take it from."""
_MOST_VOXELS: Final = 20_000_000
_MOST_LEVELS: Final = 500
"""Voxels that a column of cells may be high."""


def export_octomap(source: Path, out: Path) -> Sequence[Path]:
    """Write a run's map.

    Of a run with a recording: all its camera frames, put into an octree where the robot believed
    to be, free space along the rays. Without one: the cubes that the core held to be occupied, or
    where it kept none, the cells of its floor map.

    Raises:
        InputError: the run has neither recording nor map.
        OSError: a file cannot be written.
    """
    if (source / RECORDING).is_file():
        return write_octree(_of_frames(source), out)
    return write_octree(_of_map(read_map(source / MAP), source), out)


def export_course(scenario: str, out: Path) -> Sequence[Path]:
    """Write the map of a scenario's course that a robot would be told.

    Args:
        scenario: a name or a path.
        out: a folder that exists.

    Raises:
        InputError: the scenario is bad.
        OSError: a file cannot be written.
    """
    from treadwell.course.build import build_course
    from treadwell.course.static_map import told_octree
    from treadwell.robot.load import load_robot
    from treadwell.scenario.loading import load_scenario

    made = load_scenario(scenario)
    robot = load_robot(made.robot)
    course = build_course(made, robot)
    table = made.navigation.parameters().get("static_map", {})
    where = str(made.path or made.name)
    return write_octree(told_octree(course, table, made.folder, where, robot.scale), out)


def write_octree(tree: Octree, out: Path) -> list[Path]:
    """Write both files.

    Raises:
        OSError: a file cannot be written.
    """
    paths = [out / "map.bt", out / "map.ot"]
    for path in paths:
        with whole_file(path) as temporary:
            tree.write(str(temporary))
    return paths


def _of_frames(source: Path) -> Octree:
    tree = Octree(RESOLUTION)
    count = 0
    for frame in seen_points(source):
        eye = frame.map_from_camera[:3, 3]
        points = frame.points[np.isfinite(frame.points).all(axis=1)]
        if len(points):
            tree.insert(points, (float(eye[0]), float(eye[1]), float(eye[2])))
            count += 1
    if not count:
        raise InputError(f"{source / RECORDING}: not one camera frame saw anything")
    return tree


def _of_map(stored: StoredMap, source: Path) -> Octree:
    """Return the cubes of a map, or where it has none, its cells as columns."""
    if len(stored.voxels):
        side = float(stored.voxels[:, 3].min())
        tree = Octree(side)
        tree.occupy(filled(stored.voxels.astype(np.float64), side))
        return tree
    surface = stored.surface
    floor, obstacle = surface.kind == FLOOR, surface.kind == OBSTACLE
    if not (floor | obstacle).any():
        raise InputError(f"{source / MAP}: the map has not one cell")
    tree = Octree(surface.cell)
    centres = surface.centres()
    top = surface.height[floor].astype(np.float64)
    # The voxel that the floor is the upper face of, or lies in.
    tree.occupy(np.column_stack([centres[floor], top - 1e-6]))
    ground = float(np.nanmin(top)) if top.size else 0.0
    for (x, y), height in zip(centres[obstacle], surface.height[obstacle], strict=True):
        high = float(height) if np.isfinite(height) else ground
        levels = int(np.clip(np.ceil((high - ground) / surface.cell - 1e-3), 1, _MOST_LEVELS))
        z = high - 1e-6 - surface.cell * np.arange(levels)
        tree.occupy(np.column_stack([np.full(levels, x), np.full(levels, y), z]))
    return tree


def filled(voxels: Floats, side: float) -> Floats:
    """Return the middles (m, 3) of all cubes of one side that fill larger cubes (n, 4).

    Raises:
        InputError: they would be more than a computer holds.
    """
    parts = []
    sizes, cubes_of = np.unique(voxels[:, 3], return_counts=True)
    if float((np.maximum(sizes / side, 1.0) ** 3) @ cubes_of) > _MOST_VOXELS:
        raise InputError(f"{MAP}: its cubes are more than {_MOST_VOXELS} voxels of {side:g} m")
    for size in sizes:
        count = max(1, round(size / side))
        steps = (np.arange(count) - (count - 1) / 2) * side
        inner = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)
        cubes = voxels[voxels[:, 3] == size, :3]
        parts.append((cubes[:, None, :] + inner[None]).reshape(-1, 3))
    return np.vstack(parts) if parts else np.empty((0, 3))
