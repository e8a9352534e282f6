"""Claims about clouds of strangers: PCD and PLY of every kind, alone or with poses."""

import gzip
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from source_builders import COLOURS, IDENTITY, POINTS, data, needs_data, pcd, ply, read

from treadwell.errors import InputError
from treadwell.sources.cloud_table import MOST_POINTS
from treadwell.sources.frame import RangeFrame, moved
from treadwell.sources.source import open_source


def in_world(frame: RangeFrame) -> np.ndarray:
    assert frame.points is not None
    assert frame.points.dtype == np.float32
    return moved(frame.world_from_sensor, frame.points)


def one(path: Path) -> RangeFrame:
    source, frames = read(path)
    assert source.kind == "cloud"
    assert source.frames == len(frames) == 1
    return frames[0]


@needs_data
def test_airborne_clouds_keep_coordinates_of_millions_of_metres() -> None:
    frame = one(data("isprs_ground_filter/samp11-utm.pcd.gz"))
    assert frame.points is not None
    assert frame.points.shape == (38010, 3)
    assert np.abs(frame.points).max() < 200.0
    assert not frame.origin_known
    assert frame.layout == "cloud"
    middle = frame.world_from_sensor[:3, 3]
    np.testing.assert_array_equal(middle, np.round(middle))
    assert middle[1] > 5.4e6


@needs_data
def test_real_clouds_of_other_sensors_are_read() -> None:
    blocks = one(data("real_terrain_clouds/terrain_med.pcd.gz"))
    assert np.isfinite(in_world(blocks)).all()
    table = one(data("mosd_labelled_kinect/test1.pcd"))
    assert table.points is not None
    assert table.points.shape == (640 * 480, 3)
    assert np.isnan(table.points[:, 0]).any()
    assert table.colour is not None
    assert table.colour[np.isfinite(table.points[:, 0])].std() > 10.0
    assert one(data("synpeb_plane_gt/test_100.pcd")).points is not None


@needs_data
@pytest.mark.parametrize("name", ["mosd_labelled_kinect/test1", "synpeb_plane_gt/test_100"])
def test_points_equal_those_of_another_reader(name: str) -> None:
    pypcd4 = pytest.importorskip("pypcd4")
    path = data(f"{name}.pcd")
    theirs = pypcd4.PointCloud.from_path(path).numpy(("x", "y", "z")).astype(np.float64)
    np.testing.assert_allclose(in_world(one(path)), theirs, atol=1e-6)


@pytest.mark.parametrize("kind", [("F", 4), ("F", 8), ("I", 4), ("I", 2)])
@pytest.mark.parametrize("layout", ["ascii", "binary", "binary_compressed"])
def test_a_pcd_is_read_in_every_layout_and_type(
    tmp_path: Path, layout: str, kind: tuple[str, int]
) -> None:
    path = tmp_path / "a.pcd"
    points = POINTS if kind[0] == "F" else np.round(np.nan_to_num(POINTS))
    path.write_bytes(pcd(layout, *kind, points=points))
    frame = one(path)
    np.testing.assert_allclose(in_world(frame), points)
    assert frame.colour is not None
    np.testing.assert_array_equal(frame.colour, COLOURS)


@pytest.mark.parametrize("kind", ["float", "double", "int"])
@pytest.mark.parametrize("order", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_a_ply_is_read_in_every_order_and_type(tmp_path: Path, order: str, kind: str) -> None:
    path = tmp_path / "a.ply"
    path.write_bytes(ply(order, kind))
    frame = one(path)
    points = np.nan_to_num(POINTS).astype(int) if kind == "int" else POINTS
    np.testing.assert_allclose(in_world(frame), points)
    assert frame.colour is not None
    np.testing.assert_array_equal(frame.colour, COLOURS)


def test_a_ply_equals_what_plyfile_reads(tmp_path: Path) -> None:
    plyfile = pytest.importorskip("plyfile")
    path = tmp_path / "a.ply"
    path.write_bytes(ply("binary_big_endian", "double"))
    theirs = plyfile.PlyData.read(path)["vertex"]
    expected = np.stack([theirs[name] for name in "xyz"], axis=1)
    np.testing.assert_allclose(in_world(one(path)), expected)


@pytest.mark.parametrize("make", [pcd, ply])
def test_a_packed_cloud_is_the_same(tmp_path: Path, make: object) -> None:
    content = make()  # type: ignore[operator]
    path = tmp_path / f"a.{make.__name__}.gz"  # type: ignore[attr-defined]
    path.write_bytes(gzip.compress(content))
    np.testing.assert_allclose(in_world(one(path)), POINTS)
    path.write_bytes(gzip.compress(content)[:-20])
    with pytest.raises(InputError, match=r"a\..*\.gz: "):
        read(path)


def test_coordinates_of_five_million_metres_keep_their_millimetres(tmp_path: Path) -> None:
    away = np.array([512_345.0, 5_403_706.0, 357.0])
    points = away + np.random.default_rng(1).uniform(-200.0, 200.0, (1000, 3))
    for layout in ("ascii", "binary"):
        path = tmp_path / f"{layout}.pcd"
        path.write_bytes(pcd(layout, "F", 8, points))
        np.testing.assert_allclose(in_world(one(path)), points, rtol=0.0, atol=2e-5)


def test_the_viewpoint_says_where_the_sensor_was(tmp_path: Path) -> None:
    path = tmp_path / "a.pcd"
    path.write_bytes(pcd(viewpoint="1 2 3 0.70710678 0 0 0.70710678"))
    frame = one(path)
    assert frame.origin_known
    np.testing.assert_array_equal(frame.world_from_sensor[:3, 3], [1.0, 2.0, 3.0])
    np.testing.assert_allclose(in_world(frame), POINTS, atol=1e-6)
    for none in ("0 0 0 1 0 0 0", "nan 0 0 1 0 0 0", "1 2 3 0 0 0 0", "1 2", "1e7 0 0 1 0 0 0"):
        path.write_bytes(pcd(viewpoint=none))
        frame = one(path)
        assert not frame.origin_known
        np.testing.assert_allclose(in_world(frame), POINTS)


def test_points_beyond_the_earth_are_left_out_and_said(tmp_path: Path) -> None:
    points = POINTS.copy()
    points[1, 0], points[3, 1] = 1e30, np.inf
    path = tmp_path / "a.pcd"
    path.write_bytes(pcd("binary", "F", 8, points))
    source, (frame,) = read(path)
    assert frame.points is not None
    assert np.isfinite(frame.points[:, 0]).tolist() == [True, False, False, False]
    assert any(note.startswith("2 points") for note in source.notes)


BAD = {
    "nothing.pcd": (b"", "FIELDS: missing"),
    "nothing.ply": (b"", "is no PLY file"),
    "noise.pcd": (bytes(range(256)) * 40, "missing"),
    "none.pcd": (pcd(points=POINTS[:0]), "holds not one point"),
    "none.ply": (ply(count=0), "holds not one point"),
    "nan.pcd": (pcd(points=POINTS[2:3]), "not one point whose coordinates are finite"),
    "many.pcd": (pcd(count=10**8), "100000000 points, 10000000 are allowed"),
    "many.ply": (ply(count=10**8), "100000000 points, 10000000 are allowed"),
    "endless.ply": (ply(count=10**400), "points, 10000000 are allowed"),
    "short.pcd": (pcd()[:-9], "breaks off: 3 points of 4"),
    "short_ascii.pcd": (pcd("ascii").rsplit(b"\n", 2)[0], "breaks off: 3 points of 4"),
    "short_packed.pcd": (pcd("binary_compressed")[:-5], "breaks off"),
    "claims.pcd": (pcd("binary_compressed", count=9_000_000), "unpacks to 72 bytes"),
    "short.ply": (ply(count=100), "breaks off"),
    "words.pcd": (pcd("ascii").replace(b"7 1.0 2.0", b"7 a b"), "between points 0 and 4"),
    "no_z.pcd": (pcd().replace(b"x y z", b"x y w"), "FIELDS: has no z"),
    "sizes.pcd": (pcd().replace(b"SIZE 2 4 4", b"SIZE 2 4 3"), "must be F of 4 or 8"),
    "data.pcd": (pcd().replace(b"DATA binary", b"DATA bin"), "DATA: found bin; must be ascii"),
    "none_of_y.pcd": (pcd().replace(b"COUNT 1 1 1", b"COUNT 1 1 0"), "FIELDS: has no y"),
    "counts.pcd": (pcd().replace(b"COUNT 1 1", b"COUNT 1"), "must be as many"),
    "order.ply": (ply().replace(b"little", b"middle"), "format binary_middle_endian"),
    "list.ply": (ply().replace(b"uchar c", b"list uchar int c"), "has a list"),
    "no_x.ply": (ply().replace(b"float x", b"float u"), "has no property x"),
    "twice.ply": (ply().replace(b"float y", b"float x"), "found 'property float x'"),
    "headless.ply": (ply()[:44], "breaks off in its header"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_cloud_is_refused_in_one_line(tmp_path: Path, name: str) -> None:
    content, message = BAD[name]
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read(path)
    text = str(caught.value)
    assert text.startswith(f"{path}: ")
    assert message in text
    assert len(text.splitlines()) == 1
    assert len(text) < 600


def test_a_packed_file_that_unpacks_to_gigabytes_takes_little_memory(tmp_path: Path) -> None:
    path = tmp_path / "a.pcd.gz"
    with gzip.open(path, "wb", 1) as file:
        file.write(pcd(count=10)[: -14 * 4])
        for _ in range(64):
            file.write(bytes(1 << 20))
    tracemalloc.start()
    read(path)
    assert tracemalloc.get_traced_memory()[1] < 5e6
    tracemalloc.stop()


def test_the_most_points_that_are_allowed_are_read(tmp_path: Path) -> None:
    head = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"
    path = tmp_path / "a.pcd"
    with path.open("wb") as file:
        file.write(f"{head}WIDTH {MOST_POINTS}\nHEIGHT 1\nDATA binary\n".encode())
        block = np.random.default_rng(1).uniform(-9.0, 9.0, (MOST_POINTS // 10, 3))
        for _ in range(10):
            file.write(block.astype("<f4").tobytes())
    tracemalloc.start()
    frame = one(path)
    assert frame.points is not None
    assert len(frame.points) == MOST_POINTS
    assert tracemalloc.get_traced_memory()[1] < 1.5e9
    tracemalloc.stop()


def cloud_folder(folder: Path) -> Path:
    folder.mkdir()
    (folder / "1.0.pcd").write_bytes(pcd())
    (folder / "2.0.ply.gz").write_bytes(gzip.compress(ply()))
    (folder / "2.5.ply").write_bytes(ply())
    (folder / "3.0.pcd").write_bytes(pcd()[:-9])
    (folder / "4.0.pcd").write_bytes(pcd(points=np.zeros((3, 3))))
    (folder / "map.pcd").write_bytes(pcd())
    poses = [f"1.0 {IDENTITY}", "2.01 5000000.125 0 0 0 0 1 0", f"3.0 {IDENTITY}"]
    (folder / "poses.tum").write_text("\n".join([*poses, f"4.0 {IDENTITY}"]))
    return folder


def test_clouds_of_a_folder_take_their_poses(tmp_path: Path) -> None:
    source, frames = read(cloud_folder(tmp_path / "a"))
    assert (source.kind, source.frames) == ("cloud folder", 5)
    assert [frame.time for frame in frames] == [1.0, 2.0]
    assert all(frame.origin_known for frame in frames)
    np.testing.assert_allclose(in_world(frames[1]), POINTS * [-1, -1, 1] + [5000000.125, 0, 0])
    assert source.unused == {
        "no pose within 20 ms": 1,
        "cloud that cannot be read": 1,
        "no point": 1,
        "name is no time": 1,
    }
    assert len(source.notes) == 1
    assert "3.0.pcd: breaks off" in source.notes[0]


def test_a_folder_of_clouds_without_poses_says_what_it_lacks(tmp_path: Path) -> None:
    folder = cloud_folder(tmp_path / "a")
    (folder / "poses.tum").unlink()
    with pytest.raises(InputError, match=r"poses\.tum: missing; a line for each pose"):
        open_source(folder)
