"""Claims about pictures on a mesh: `treadwell map --world-model mesh` of data in colour."""

import json
import struct
from io import BytesIO
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from test_map import (
    CX,
    CY,
    FX,
    FY,
    HEIGHT,
    WIDTH,
    camera_pose,
    depth_of_the_box,
    mapped,
    pictures,
)

from treadwell.exports.export import export
from treadwell.map_making.texture import TexturePictures, _coarser
from treadwell.recording.mesh_file import SurfaceMesh, read_mesh
from treadwell.sources.frame import PinholeCamera, RangeFrame

__all__ = ["pictures"]
PIXEL_M = 1.0 / FX
"""Of a thing a metre away."""
SHADES = 200.0


def colours_of(places: NDArray[np.floating]) -> NDArray[np.uint8]:
    """What the world is painted with: so many shades a metre along x and y, over and over."""
    shades = (SHADES * places[..., :2]).round() % 256
    blue = np.full(places.shape[:-1], 40.0)
    return np.concatenate([shades, blue[..., None]], -1).round().astype(np.uint8)


def painted() -> NDArray[np.uint8]:
    """The camera's picture in colour; black where nothing was seen."""
    rows, cols = np.indices((HEIGHT, WIDTH))
    rays = np.stack([(cols - CX) / FX, (rows - CY) / FY, np.ones_like(cols, float)], -1)
    depth = depth_of_the_box()
    pose = camera_pose()
    places = (depth[..., None] * rays) @ pose[:3, :3].T + pose[:3, 3]
    found = colours_of(np.nan_to_num(places))
    found[np.isnan(depth)] = 0
    return found


@pytest.fixture
def in_colour(pictures: Path) -> Path:
    (pictures / "color").mkdir()
    for time in range(4):
        Image.fromarray(painted()).save(pictures / "color" / f"{time}.png")
    return pictures


def test_the_surface_shows_each_place_its_colour(in_colour: Path, tmp_path: Path) -> None:
    made = mapped(in_colour, tmp_path / "map", world_model="mesh")
    mesh = read_mesh(made.folder / "mesh.npz")
    assert mesh.texture is not None
    found, wanted = mesh.texture.colours().astype(int), colours_of(mesh.corners).astype(int)
    seen = found[:, 2] == 40
    assert seen.mean() > 0.9
    # Two pixels are as many metres as the place is far away.
    away = np.linalg.norm(mesh.corners[seen] - camera_pose()[:3, 3], axis=1)
    steep = 1.0 / np.sin(np.arctan2(camera_pose()[2, 3], away))
    apart = np.abs((found[seen, :2] - wanted[seen, :2] + 128) % 256 - 128)
    two = 2.0 * SHADES * PIXEL_M * away
    assert np.mean(apart <= np.column_stack([two * steep, two]) + 1.0) > 0.99


def test_files_of_other_tools_have_the_colours(in_colour: Path, tmp_path: Path) -> None:
    made = mapped(in_colour, tmp_path / "map", world_model="mesh")
    kept = read_mesh(made.folder / "mesh.npz")
    assert kept.texture is not None
    data = export(made.folder, "gltf")[0].read_bytes()
    (length,) = struct.unpack("<I", data[12:16])
    described = json.loads(data[20 : 20 + length])
    view = described["bufferViews"][described["images"][0]["bufferView"]]
    begin = 28 + length + view["byteOffset"]
    picture = Image.open(BytesIO(data[begin : begin + view["byteLength"]]))
    assert np.array_equal(np.asarray(picture), kept.texture.picture)
    ply = next(path for path in export(made.folder, "ply") if path.name == "mesh.ply")
    content = ply.read_bytes()
    assert b"property uchar red" in content
    rows = content[content.index(b"end_header\n") + 11 :][: 15 * len(kept.corners)]
    table = np.frombuffer(rows, [("at", "<f4", 3), ("rgb", "u1", 3)])
    assert np.array_equal(table["at"], kept.corners)
    assert np.array_equal(table["rgb"], kept.texture.colours())


@pytest.mark.parametrize("settings", [("map.pictures=0",), ()])
def test_without_colour_there_is_no_texture(
    pictures: Path, in_colour: Path, tmp_path: Path, settings: tuple[str, ...]
) -> None:
    assert in_colour == pictures
    if not settings:
        for path in (pictures / "color").iterdir():
            path.unlink()
    made = mapped(pictures, tmp_path / "map", *settings, world_model="mesh")
    assert read_mesh(made.folder / "mesh.npz").texture is None


@pytest.mark.parametrize("most", [1, 2, 5, 16])
def test_pictures_are_kept_evenly_over_a_recording(most: int) -> None:
    camera = PinholeCamera(4, 3, 4.0, 4.0, 1.5, 1.0)
    kept = TexturePictures(most)
    depth = np.ones((3, 4), np.float32)
    for time in range(100):
        colour = np.full((3, 4, 3), time, np.uint8)
        frame = RangeFrame(time, np.eye(4), camera, depth, None, "picture", colour)
        kept.insert(frame, np.eye(4))
    times = [int(one.colour[0, 0, 0]) for one in kept._kept]
    assert max(1, most // 2) <= len(times) <= most
    assert times[0] == 0
    assert len({b - a for a, b in pairwise(times)}) <= 1


def test_what_no_picture_saw_is_grey() -> None:
    camera = PinholeCamera(4, 3, 4.0, 4.0, 1.5, 1.0)
    kept = TexturePictures(4)
    colour = np.full((3, 4, 3), 200, np.uint8)
    depth = np.full((3, 4), np.nan, np.float32)
    kept.insert(RangeFrame(0.0, np.eye(4), camera, depth, None, "picture", colour), np.eye(4))
    triangle = np.array([[0, 0, 2], [0.1, 0, 2], [0, 0.1, 2]], np.float32)
    shown = kept.shown(SurfaceMesh(triangle, np.array([[0, 1, 2]], np.uint32)), {})
    assert shown.texture is not None
    assert shown.texture.colours().tolist() == [[128] * 3] * 3


def test_large_textures_are_shown_with_fewer_pixels() -> None:
    assert _coarser(np.full((10, 6, 3), 9, np.uint8), 2).shape == (5, 3, 3)
