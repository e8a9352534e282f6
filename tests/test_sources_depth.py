"""Claims about depth images of a stranger's folder, their poses and their camera."""

import gzip
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np
import pytest
from PIL import Image
from source_builders import (
    CAMERA,
    HEIGHT,
    IDENTITY,
    WIDTH,
    camera_text,
    data,
    depth_folder,
    needs_data,
    picture,
    read,
    write_png,
)

from treadwell.errors import InputError
from treadwell.sources.frame import moved
from treadwell.sources.pose_file import read_poses
from treadwell.sources.source import open_source

WIDTH_OF_KINECT: Final = 640
HEIGHT_OF_KINECT: Final = 480


@needs_data
def test_real_kinect_images_are_read_with_their_camera_and_poses() -> None:
    source, frames = read(data("rgbd_room"))
    assert (source.kind, source.frames, len(frames)) == ("depth folder", 5, 5)
    assert not source.unused
    camera = frames[0].camera
    assert camera is not None
    assert (camera.fx, camera.fy, camera.cx, camera.cy) == (518.0, 519.0, 325.5, 253.5)
    assert frames[0].layout == "picture"
    assert frames[0].depth is not None
    assert np.nanmax(frames[0].depth) == pytest.approx(9.823)
    assert [frame.time for frame in frames] == [1.0, 2.0, 3.0, 4.0, 5.0]
    np.testing.assert_allclose(frames[1].world_from_sensor[:3, 3], [-0.50237, -0.0661803, 0.322012])
    turn = frames[1].world_from_sensor[:3, :3]
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)


def test_what_was_not_seen_is_nan_and_integers_are_units_of_the_camera_file(tmp_path: Path) -> None:
    _, frames = read(depth_folder(tmp_path / "a", depth_scale=500))
    depth = frames[0].depth
    assert depth is not None
    assert depth.dtype == np.float32
    assert np.argwhere(np.isnan(depth)).tolist() == [[1, 2]]
    np.testing.assert_allclose(depth[0], 2 * picture()[0], rtol=1e-6)


@pytest.mark.parametrize("kind", ["<f2", "<f4", ">f4", "<f8", ">f8", "longdouble"])
def test_npy_is_in_metres_in_every_type_of_float(tmp_path: Path, kind: str) -> None:
    folder = depth_folder(tmp_path / "a", times=(), depth_scale=None)
    depth = picture()
    depth[0, :3] = [np.nan, np.inf, -1.0]
    np.save(folder / "depth" / "1.0.npy", depth.astype(kind))
    np.save(folder / "depth" / "2.0.npy", np.asfortranarray(depth.astype(kind)))
    source, frames = read(folder)
    assert not source.unused
    for frame in frames:
        assert frame.depth is not None
        assert np.isnan(frame.depth[0, :3]).all()
        np.testing.assert_allclose(frame.depth[2:], depth[2:], rtol=1e-3)
    assert len(frames) == 2


@pytest.mark.parametrize("unit", ["float", "integers"])
def test_millimetres_are_noticed_and_said(tmp_path: Path, unit: str) -> None:
    folder = depth_folder(tmp_path / "a", times=("1.0",), depth_scale=1)
    if unit == "float":
        (folder / "depth" / "1.0.png").unlink()
        np.save(folder / "depth" / "1.0.npy", (1000 * picture()).astype(np.float32))
    source, frames = read(folder)
    assert frames[0].depth is not None
    np.testing.assert_allclose(frames[0].depth[2:], picture()[2:], atol=1e-3)
    assert len(source.notes) == 1
    assert "millimetres" in source.notes[0]
    again = list(source)
    assert len(again) == len(source.notes) == 1


def test_metres_are_left_alone(tmp_path: Path) -> None:
    source, _ = read(depth_folder(tmp_path / "a"))
    assert not source.notes


def test_a_frame_takes_the_nearest_pose_within_20_ms(tmp_path: Path) -> None:
    poses = [f"{t} {x} 0 0 0 0 0 1" for t, x in (("0.985", 1), ("1.010", 2), ("2.05", 3))]
    folder = depth_folder(tmp_path / "a", poses=poses)
    source, frames = read(folder)
    assert [frame.world_from_sensor[0, 3] for frame in frames] == [2.0]
    assert source.unused == {"no pose within 20 ms": 2}
    source, frames = read(folder, pose_within=0.06)
    assert [frame.world_from_sensor[0, 3] for frame in frames] == [2.0, 3.0]


def test_what_makes_a_frame_unusable_is_counted_by_reason(tmp_path: Path) -> None:
    poses = [f"{t}.0 {IDENTITY}" for t in range(3, 12)]
    poses += ["1.0 nan 0 0 0 0 0 1", "2.0 0 0 0 0 0 0 0"]
    times = ("1.0", "2.0", "3.0", "20.0", "first")
    folder = depth_folder(tmp_path / "a", times=times, poses=poses) / "depth"
    write_png(folder / "4.0.png", np.ones((HEIGHT, WIDTH + 1)))
    write_png(folder / "5.0.png", np.zeros((HEIGHT, WIDTH)))
    whole = (folder / "3.0.png").read_bytes()
    (folder / "6.0.png").write_bytes(whole[: len(whole) // 2])
    (folder / "7.0.png").write_bytes(b"")
    Image.fromarray(np.ones((HEIGHT, WIDTH), np.uint8)).save(folder / "8.0.png")
    (folder / "9.0.png").symlink_to("/dev/zero")
    np.save(folder / "10.0.npy", np.full((HEIGHT, WIDTH), "a"))
    (folder / "11.0.npy").write_bytes(b"\x93NUMPY\x01\x00")
    source, frames = read(folder.parent)
    assert [frame.time for frame in frames] == [3.0]
    assert source.unused == {
        "pose not finite": 1,
        "pose whose quaternion is not of length one": 1,
        "no pose within 20 ms": 1,
        "name is no time": 1,
        "image that is not 8x6": 1,
        "no point": 1,
        "image that cannot be read": 4,
        "image that is not 16-bit grey": 1,
        "image that is not of numbers": 1,
    }
    first = dict(source.unused)
    list(source)
    assert source.unused == first


def test_a_header_that_claims_gigabytes_takes_no_memory(tmp_path: Path) -> None:
    folder = depth_folder(tmp_path / "a", times=("1.0",))
    claim = b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000, 1000000), }\n"
    content = b"\x93NUMPY\x01\x00" + len(claim).to_bytes(2, "little") + claim
    (folder / "depth" / "2.0.npy").write_bytes(content)
    source, frames = read(folder)
    assert len(frames) == 1
    assert source.unused == {"image that is not 8x6": 1}


def test_colour_comes_along_where_it_fits(tmp_path: Path) -> None:
    folder = depth_folder(tmp_path / "a")
    (folder / "color").mkdir()
    colour = np.arange(3 * WIDTH * HEIGHT, dtype=np.uint8).reshape(HEIGHT, WIDTH, 3)
    Image.fromarray(colour).save(folder / "color" / "1.01.png")
    Image.fromarray(colour[:2]).save(folder / "color" / "2.0.jpg")
    source, frames = read(folder)
    assert frames[0].colour is not None
    np.testing.assert_array_equal(frames[0].colour, colour)
    assert frames[1].colour is None
    assert frames[2].colour is None
    assert len(source.notes) == 2


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"fx": None}, "fx: missing, it is required"),
        ({"cx": "nan"}, "cx: found nan; must be a finite number"),
        ({"fy": -1.0}, "fy: found -1.0; must be greater than 0"),
        ({"width": 1.5}, "width: found 1.5"),
        ({"height": 100_000}, "height: found 100000"),
        ({"width": "true"}, "width: found true"),
        ({"k1": 0.1}, "k1: unknown key; allowed: width, height, fx, fy, cx, cy, depth_scale"),
    ],
)
def test_a_camera_file_that_lacks_something_is_refused_by_key(
    tmp_path: Path, changed: dict[str, object], message: str
) -> None:
    folder = depth_folder(tmp_path / "a", **changed)
    with pytest.raises(InputError) as caught:
        open_source(folder)
    assert str(caught.value).startswith(f"{folder / 'camera.toml'}: {message}")
    assert "\n" not in str(caught.value)


def test_integers_without_a_scale_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"depth_scale: missing; .* units a metre"):
        read(depth_folder(tmp_path / "a", depth_scale=None))


def test_another_camera_takes_the_place_of_the_folders(tmp_path: Path) -> None:
    folder = depth_folder(tmp_path / "a", fx=None)
    other = tmp_path / "other.toml"
    other.write_text(camera_text(fx=11.0))
    _, frames = read(folder, camera=other)
    assert frames[0].camera is not None
    assert frames[0].camera.fx == 11.0


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["1.0 0 0 0"], "line 2: must be eight numbers"),
        (["nan 0 0 0 0 0 0 1"], "line 2: must be eight numbers"),
        (["1.0 a 0 0 0 0 0 1"], "line 2: must be eight numbers"),
        ([], "holds not one pose"),
    ],
)
def test_a_file_of_poses_that_is_none_is_refused_by_line(
    tmp_path: Path, lines: list[str], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        open_source(depth_folder(tmp_path / "a", poses=lines))


def test_times_and_places_as_others_write_them_are_kept(tmp_path: Path) -> None:
    poses = ["1305031102.175304 5000000.123 -4000000.5 3 0 0 0.7071 0.7071"]
    _, frames = read(depth_folder(tmp_path / "a", times=("1305031102.1753",), poses=poses))
    place = frames[0].world_from_sensor[:3, 3]
    np.testing.assert_array_equal(place, [5000000.123, -4000000.5, 3.0])
    turn = frames[0].world_from_sensor[:3, :3]
    np.testing.assert_allclose(turn, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-12)


@needs_data
def test_real_poses_of_the_tum_benchmark_are_read(tmp_path: Path) -> None:
    packed = data("evo_trajectories/freiburg1_xyz-groundtruth.txt.gz").read_bytes()
    path = tmp_path / "groundtruth.txt"
    path.write_bytes(gzip.decompress(packed))
    poses = read_poses(path)
    assert len(poses.rows) == 3000
    middle = poses.nearest(1305031102.1753 + 1e-4, 0.02)
    row = poses.rows[np.argmin(np.abs(poses.rows[:, 0] - 1305031102.1754))]
    np.testing.assert_array_equal(middle[:3, 3], row[1:4])
    np.testing.assert_allclose(middle[:3, :3] @ middle[:3, :3].T, np.eye(3), atol=1e-12)


def tum_folder(folder: Path) -> Path:
    (folder / "depth").mkdir(parents=True)
    (folder / "rgb").mkdir()
    write_png(folder / "depth" / "a.png", np.round(5000 * picture()))
    colour = np.full((HEIGHT, WIDTH, 3), 77, np.uint8)
    Image.fromarray(colour).save(folder / "rgb" / "a.png")
    (folder / "depth.txt").write_text("# depth maps\n10.01 depth/a.png\n11.0 depth/none.png\n")
    (folder / "rgb.txt").write_text("10.0 rgb/a.png\n")
    (folder / "groundtruth.txt").write_text(f"10.0 {IDENTITY}\n11.0 {IDENTITY}\n")
    (folder / "camera.toml").write_text(camera_text(depth_scale=5000))
    return folder


def test_a_folder_of_the_tum_benchmark_is_read_by_its_lists(tmp_path: Path) -> None:
    source, frames = read(tum_folder(tmp_path / "a"))
    assert (source.kind, source.frames) == ("tum", 2)
    assert source.unused == {"image that cannot be read": 1}
    (frame,) = frames
    assert frame.time == 10.01
    assert frame.depth is not None
    np.testing.assert_allclose(frame.depth[2:], picture()[2:], rtol=1e-4)
    assert frame.colour is not None
    assert (frame.colour == 77).all()
    assert frame.camera is not None
    assert frame.camera.cx == CAMERA["cx"]


def test_a_tum_folder_without_a_camera_says_what_to_write(tmp_path: Path) -> None:
    folder = tum_folder(tmp_path / "a")
    (folder / "camera.toml").unlink()
    with pytest.raises(InputError, match=r"camera\.toml: missing; .* --camera"):
        open_source(folder)


@pytest.mark.parametrize("name", ["/etc/passwd", "../x.png", ""])
def test_a_list_names_files_of_its_folder_alone(tmp_path: Path, name: str) -> None:
    folder = tum_folder(tmp_path / "a")
    (folder / "depth.txt").write_text(f"1.0 {name}\n")
    with pytest.raises(InputError, match=r"depth\.txt: line 1: must"):
        open_source(folder)


@needs_data
def test_what_one_real_view_sees_another_sees_there_too() -> None:
    _, frames = read(data("rgbd_room"))
    rows, columns = np.mgrid[0:HEIGHT_OF_KINECT:4, 0:WIDTH_OF_KINECT:4]
    for first, second in pairwise(frames):
        camera = first.camera
        assert camera is not None
        assert first.depth is not None
        assert second.depth is not None
        depth = first.depth[rows, columns].ravel().astype(float)
        across = (columns.ravel() - camera.cx) / camera.fx
        down = (rows.ravel() - camera.cy) / camera.fy
        points = np.stack([across * depth, down * depth, depth], axis=1)
        there = moved(np.linalg.inv(second.world_from_sensor) @ first.world_from_sensor, points)
        there = there[np.isfinite(there[:, 2]) & (there[:, 2] > 0.3)]
        column = np.round(camera.fx * there[:, 0] / there[:, 2] + camera.cx).astype(int)
        row = np.round(camera.fy * there[:, 1] / there[:, 2] + camera.cy).astype(int)
        inside = (column >= 0) & (column < camera.width) & (row >= 0) & (row < camera.height)
        assert inside.mean() > 0.3
        off = second.depth[row[inside], column[inside]] - there[inside, 2]
        # A pose taken the wrong way round puts half of the points 0.5 to 1 m off.
        assert np.nanmedian(np.abs(off)) < 0.11
