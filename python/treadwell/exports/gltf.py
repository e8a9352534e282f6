"""glTF files: `mesh.glb`, the surface as the world model kept it, else the floors with their steps.

Binary, metres; y is up, as the format wants it. Where the data had colour its pictures are in it.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from treadwell._core import mesh_file
from treadwell.exports.map_server import seen_part
from treadwell.exports.ply import height_mesh
from treadwell.files import write_bytes
from treadwell.recording.map_file import NAME as MAP
from treadwell.recording.map_file import read_map
from treadwell.recording.mesh_file import NAME as MESH
from treadwell.recording.mesh_file import SurfaceMesh, read_mesh


def export_gltf(source: Path, out: Path) -> Sequence[Path]:
    """Write the mesh.

    Raises:
        InputError: the run has no map, or it is broken.
        OSError: a file cannot be written.
    """
    path = out / "mesh.glb"
    if (source / MESH).is_file():
        mesh = read_mesh(source / MESH)
    else:
        vertices, faces = height_mesh(seen_part(read_map(source / MAP).surface, source))
        mesh = SurfaceMesh(vertices.astype(np.float32), faces.astype(np.uint32))
    shown = mesh.texture
    picture = None if shown is None else (shown.png(), shown.places)
    write_bytes(path, mesh_file("gltf", mesh.corners, mesh.triangles, picture=picture))
    return [path]
