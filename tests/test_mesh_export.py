"""The surface of the world model `mesh` in a folder, and as files of other tools."""

import json
import struct
from pathlib import Path

import numpy as np
import pytest

from treadwell.cli.app import execute
from treadwell.errors import InputError
from treadwell.exports.export import export
from treadwell.exports.gltf import export_gltf
from treadwell.map_memory import RememberedMap
from treadwell.recording.map_file import write_map
from treadwell.recording.mesh_file import SurfaceMesh, read_mesh, write_mesh

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.5]], np.float32)
TRIANGLES = np.array([[0, 1, 2]], np.uint32)


def folder(path: Path) -> Path:
    cells = RememberedMap(
        (0.0, 0.0),
        0.1,
        np.ones((2, 3), np.uint8),
        np.zeros((2, 3), np.float32),
        np.ones((2, 3), np.uint16),
    )
    write_map(path / "map.npz", cells, np.empty((0, 4), np.float32))
    return path


def described(path: Path) -> dict[str, object]:
    data = path.read_bytes()
    assert data[:4] == b"glTF"
    assert struct.unpack("<I", data[8:12]) == (len(data),)
    (length,) = struct.unpack("<I", data[12:16])
    found: dict[str, object] = json.loads(data[20 : 20 + length])
    return found


def test_the_mesh_is_written_as_gltf_and_as_ply(tmp_path: Path) -> None:
    run = folder(tmp_path)
    write_mesh(run / "mesh.npz", SurfaceMesh(CORNERS, TRIANGLES))
    assert execute(["export", str(run), "--to", "gltf"]) == 0
    (glb,) = export(run, "gltf")
    accessors = described(glb)["accessors"]
    assert isinstance(accessors, list)
    assert accessors[0]["count"] == 3
    assert accessors[0]["max"] == [1.0, 1.0, 0.5]
    names = [path.name for path in export(run, "ply")]
    assert names == ["height_mesh.ply", "mesh.ply"]


def test_without_a_mesh_the_floors_with_their_steps_are_written(tmp_path: Path) -> None:
    (glb,) = export_gltf(folder(tmp_path), tmp_path)
    accessors = described(glb)["accessors"]
    assert isinstance(accessors, list)
    assert accessors[0]["count"] == 4 * 6


@pytest.mark.parametrize(
    ("corners", "triangles"),
    [(CORNERS * np.nan, TRIANGLES), (CORNERS, TRIANGLES + 1), (CORNERS[:, :2], TRIANGLES)],
)
def test_a_mesh_whose_arrays_do_not_fit_is_refused(
    tmp_path: Path, corners: np.ndarray, triangles: np.ndarray
) -> None:
    write_mesh(tmp_path / "mesh.npz", SurfaceMesh(corners, triangles))
    with pytest.raises(InputError, match="do not belong together"):
        read_mesh(tmp_path / "mesh.npz")


def test_a_file_that_is_no_mesh_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mesh.npz").write_bytes(b"PK no archive")
    with pytest.raises(InputError, match=r"mesh\.npz"):
        read_mesh(tmp_path / "mesh.npz")
