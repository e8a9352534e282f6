"""PLY files: the cloud, the floors with their steps, the mesh.

`cloud.ply`: what the camera saw. `height_mesh.ply`: the floors. `mesh.ply`: the surface of a world
model that keeps one, its corners in colour where the data had some.

Binary, little-endian, metres in the map frame. The mesh has sharp steps: every cell is a level
square of its own, and where two neighbours differ there is an upright face between them.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell._core import mesh_file as core_mesh_file
from treadwell.errors import InputError
from treadwell.exports.map_server import seen_part
from treadwell.exports.recorded_points import seen_points
from treadwell.files import write_bytes
from treadwell.map_memory import UNKNOWN, RememberedMap
from treadwell.recording.file import NAME as RECORDING
from treadwell.recording.map_file import NAME as MAP
from treadwell.recording.map_file import read_map
from treadwell.recording.mesh_file import NAME as MESH
from treadwell.recording.mesh_file import read_mesh

Floats = NDArray[np.float64]
GRAIN: Final = 0.01
"""Metres: of all points in a cube of this side one is kept, their mean."""
LEAST_POINTS: Final = 2
"""Points that a cube must hold: what was seen once is often an error of the stereo."""
_LEAST_RISE: Final = 1e-4
"""Metres: smaller differences of height get no face."""
_VERTEX: Final = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4")])
_POINT: Final = np.dtype(
    [*((name, "<f4") for name in "xyz"), *((name, "u1") for name in ("red", "green", "blue"))]
)
_FACE: Final = np.dtype([("count", "u1"), ("corners", "<i4", (3,))])
_TYPES: Final = {"f4": "float", "u1": "uchar"}


def export_ply(source: Path, out: Path) -> Sequence[Path]:
    """Write the height mesh, and the cloud where the run has a recording.

    Raises:
        InputError: the run has no map, or its recording is broken.
        OSError: a file cannot be written.
    """
    surface = seen_part(read_map(source / MAP).surface, source)
    mesh = out / "height_mesh.ply"
    vertices, faces = height_mesh(surface)
    write_bytes(mesh, mesh_file(vertices, faces))
    written = [mesh]
    if (source / MESH).is_file():
        kept = read_mesh(source / MESH)
        written.append(out / "mesh.ply")
        colours = None if kept.texture is None else kept.texture.colours()
        write_bytes(
            written[-1], core_mesh_file("ply", kept.corners, kept.triangles, colours=colours)
        )
    if not (source / RECORDING).is_file():
        return written
    points = cloud(source)
    if not len(points):
        raise InputError(f"{source / RECORDING}: not one camera frame saw anything")
    path = out / "cloud.ply"
    write_bytes(path, cloud_file(points))
    return [path, *written]


def cloud(source: Path) -> Floats:
    """Return the points that a run saw, (n, 3) m, where it believed to be, one a grain."""
    sums: dict[tuple[int, int, int], Floats] = {}
    for frame in seen_points(source):
        points = frame.points[np.isfinite(frame.points).all(axis=1)]
        cells, inverse = np.unique(
            np.floor(points / GRAIN).astype(np.int64), axis=0, return_inverse=True
        )
        total = np.zeros((len(cells), 4))
        np.add.at(total, inverse.reshape(-1), np.column_stack([points, np.ones(len(points))]))
        for cell, row in zip(map(tuple, cells.tolist()), total, strict=True):
            before = sums.get(cell)
            sums[cell] = row if before is None else before + row
    rows = np.array([sums[cell] for cell in sorted(sums)]).reshape(-1, 4)
    rows = rows[rows[:, 3] >= LEAST_POINTS]
    means: Floats = rows[:, :3] / rows[:, 3:]
    return means


def height_mesh(surface: RememberedMap) -> tuple[Floats, NDArray[np.int32]]:
    """Return vertices (n, 3) m and triangles (m, 3) of a map's known cells."""
    known = (surface.kind != UNKNOWN) & np.isfinite(surface.height)
    row, col = np.nonzero(known)
    number = np.full(known.shape, -1)
    number[known] = np.arange(len(row))
    x0, y0 = surface.origin
    # Corners of a cell: south-west, south-east, north-east, north-west.
    x = x0 + (col[:, None] + np.array([0, 1, 1, 0])) * surface.cell
    y = y0 + (row[:, None] + np.array([0, 0, 1, 1])) * surface.cell
    z = np.repeat(surface.height[known].astype(np.float64)[:, None], 4, axis=1)
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    first = 4 * np.arange(len(row))[:, None]
    faces = [first + np.array([0, 1, 2]), first + np.array([0, 2, 3])]
    for ours, theirs, edge, other in (
        (number[:, :-1], number[:, 1:], (1, 2), (0, 3)),
        (number[:-1], number[1:], (3, 2), (0, 1)),
    ):
        both = (ours >= 0) & (theirs >= 0)
        a, b = ours[both], theirs[both]
        step = np.abs(vertices[4 * a, 2] - vertices[4 * b, 2]) > _LEAST_RISE
        a, b = 4 * a[step], 4 * b[step]
        faces.append(np.column_stack([a + edge[0], b + other[0], b + other[1]]))
        faces.append(np.column_stack([a + edge[0], b + other[1], a + edge[1]]))
    return vertices, np.vstack(faces).astype(np.int32)


def mesh_file(vertices: Floats, faces: NDArray[np.int32]) -> bytes:
    """Return a PLY file of a mesh."""
    rows = np.empty(len(vertices), _VERTEX)
    for axis, name in enumerate("xyz"):
        rows[name] = vertices[:, axis]
    triangles = np.empty(len(faces), _FACE)
    triangles["count"], triangles["corners"] = 3, faces
    list_line = f"element face {len(faces)}\nproperty list uchar int vertex_indices\n"
    return _header(rows, list_line) + rows.tobytes() + triangles.tobytes()


def cloud_file(points: Floats) -> bytes:
    """Return a PLY file of points (n, 3), coloured by their height."""
    from treadwell.recording.layout import height_colours

    rows = np.empty(len(points), _POINT)
    for axis, name in enumerate("xyz"):
        rows[name] = points[:, axis]
    low, high = np.percentile(points[:, 2], [1.0, 99.0])
    colours = height_colours(
        points[:, 2].astype(np.float32), float(low), float(max(high, low + 0.05))
    )
    for column, name in enumerate(("red", "green", "blue")):
        rows[name] = colours[:, column]
    return _header(rows, "") + rows.tobytes()


def _header(rows: NDArray[np.void], more: str) -> bytes:
    names = rows.dtype.names or ()
    lines = [f"property {_TYPES[rows.dtype[name].str[1:]]} {name}" for name in names]
    text = "ply\nformat binary_little_endian 1.0\ncomment treadwell: metres, map frame, z up\n"
    text += f"element vertex {len(rows)}\n" + "\n".join(lines) + f"\n{more}end_header\n"
    return text.encode("ascii")
