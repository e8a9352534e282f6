"""What is exported opens in the tool that it is for, and says there what the run said."""

import json
import os
import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import octomap
import pytest
import yaml
from episode_builders import grid
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from PIL import Image
from plyfile import PlyData
from run_folders import plain_run, recorded_run

from treadwell import files
from treadwell._core import Octree
from treadwell.cli.app import execute
from treadwell.errors import InputError, RecordingError
from treadwell.exports import octomap as octomap_export
from treadwell.exports.export import FORMATS, export
from treadwell.exports.map_server import FREE, OCCUPIED, UNSEEN, seen_part, step_edges
from treadwell.exports.mcap import NAME as MCAP
from treadwell.exports.ply import height_mesh
from treadwell.exports.recorded_points import seen_points
from treadwell.exports.tum import export_tum
from treadwell.judging.result import read_result
from treadwell.map_memory import FLOOR, OBSTACLE
from treadwell.recording.map_file import read_map, write_map
from treadwell.recording.observation_log import read_observations
from treadwell.recording.trajectory import read_trajectory

NO_VOXELS = np.empty((0, 4), np.float32)


def opened(path: Path) -> octomap.OcTree:
    """Return a file as OctoMap reads it."""
    if path.suffix == ".bt":
        tree = octomap.OcTree(1.0)
        assert tree.readBinary(str(path).encode())
        return tree
    return octomap.OcTree.read(str(path).encode())


@pytest.mark.slow
@pytest.mark.parametrize("name", ["map.bt", "map.ot"])
def test_octomap_opens_both_files_and_finds_what_the_robot_saw(tmp_path: Path, name: str) -> None:
    written = export(recorded_run(), "octomap", tmp_path)
    assert [path.name for path in written] == ["map.bt", "map.ot"]
    tree = opened(tmp_path / name)
    assert tree.getResolution() == octomap_export.RESOLUTION
    frames = list(seen_points(recorded_run()))
    points = np.vstack([frame.points for frame in frames])
    points = points[np.isfinite(points).all(axis=1)]
    near = points[np.hypot(*(points[:, :2] - frames[0].map_from_camera[:2, 3]).T) < 1.2]
    assert len(near) > 1000
    found = [tree.search(point) for point in near[::20]]
    taken = [bool(tree.isNodeOccupied(node)) for node in found if node.getOccupancy() is not None]
    assert np.mean(taken) > 0.8
    eye = tree.search(frames[-1].map_from_camera[:3, 3])
    assert not tree.isNodeOccupied(eye)


def test_a_map_without_a_recording_becomes_columns(tmp_path: Path) -> None:
    surface = grid(origin=(0.0, 0.0))
    surface.kind[2, 3], surface.height[2, 3] = FLOOR, 0.0
    surface.kind[2, 4], surface.height[2, 4] = OBSTACLE, 0.2
    write_map(tmp_path / "map.npz", surface, NO_VOXELS)
    export(tmp_path, "octomap", tmp_path / "out")
    tree = opened(tmp_path / "out" / "map.bt")
    occupied = [z for z in 0.04 * (np.arange(-3, 10) + 0.5) if is_taken(tree, (0.18, 0.1, z))]
    assert occupied == pytest.approx([0.02, 0.06, 0.1, 0.14, 0.18])
    assert is_taken(tree, (0.14, 0.1, -0.02))
    assert not is_taken(tree, (0.14, 0.1, 0.02))


def is_taken(tree: octomap.OcTree, place: tuple[float, float, float]) -> bool:
    node = tree.search(np.array(place))
    try:
        return bool(tree.isNodeOccupied(node))
    except octomap.NullPointerException:
        return False


def test_cubes_that_the_core_kept_are_filled(tmp_path: Path) -> None:
    cubes = np.array([[0.02, 0.02, 0.02, 0.04], [0.12, 0.04, 0.04, 0.08]], np.float32)
    write_map(tmp_path / "map.npz", grid(), cubes)
    export(tmp_path, "octomap", tmp_path / "out")
    centres, sides = Octree.read(str(tmp_path / "out" / "map.ot")).occupied()
    assert (sides**3).sum() == pytest.approx(9 * 0.04**3)
    tree = opened(tmp_path / "out" / "map.ot")
    assert all(is_taken(tree, tuple(place)) for place in centres)


def test_cubes_that_no_memory_holds_are_bad_input(tmp_path: Path) -> None:
    cubes = np.array([[0.0, 0.0, 0.0, 0.02], [0.0, 0.0, 0.0, 400.0]], np.float32)
    write_map(tmp_path / "map.npz", grid(), cubes)
    with pytest.raises(InputError, match=r"more than 20000000 voxels of 0\.02 m"):
        export(tmp_path, "octomap", tmp_path / "out")


def test_a_course_becomes_its_map(tmp_path: Path) -> None:
    assert execute(["export", "slalom", "--to", "octomap", "--out", str(tmp_path), "--json"]) == 0
    tree = opened(tmp_path / "map.bt")
    assert is_taken(tree, (0.0, 0.0, -0.01))
    assert not is_taken(tree, (0.0, 0.0, 0.1))


def served(page: Path) -> tuple[np.ndarray, dict[str, Any]]:
    """Read a map as `map_server` documents it: 100 occupied, 0 free, -1 unknown; rows along +y."""
    told = yaml.safe_load(page.read_text())
    with Image.open(page.parent / told["image"]) as picture:
        pixels = np.asarray(picture.convert("L"), np.float64)
    share = pixels / 255.0 if told["negate"] else (255.0 - pixels) / 255.0
    assert told["mode"] == "trinary"
    cells = np.full(pixels.shape, -1)
    cells[share > told["occupied_thresh"]] = 100
    cells[share < told["free_thresh"]] = 0
    return cells[::-1], told


def test_map_server_reads_the_cells_where_they_are(tmp_path: Path) -> None:
    surface = grid(origin=(-1.0, -2.0), rows=30, cols=40)
    surface.kind[5, 7], surface.kind[20, 30] = FLOOR, OBSTACLE
    surface.height[5, 7] = 0.0
    write_map(tmp_path / "map.npz", surface, NO_VOXELS)
    export(tmp_path, "map_server", tmp_path / "out")
    cells, told = served(tmp_path / "out" / "map.yaml")
    x0, y0, yaw = told["origin"]
    assert (told["resolution"], yaw) == (0.04, 0.0)

    def at(x: float, y: float) -> int:
        return int(cells[int((y - y0) // 0.04), int((x - x0) // 0.04)])

    assert at(-1.0 + 7.5 * 0.04, -2.0 + 5.5 * 0.04) == 0
    assert at(-1.0 + 30.5 * 0.04, -2.0 + 20.5 * 0.04) == 100
    assert at(-1.0 + 8.5 * 0.04, -2.0 + 5.5 * 0.04) == -1
    assert (cells == 0).sum() == (cells == 100).sum() == 1


def test_a_real_map_is_served_whole(tmp_path: Path) -> None:
    export(recorded_run(), "map_server", tmp_path)
    stored = read_map(recorded_run() / "map.npz").surface
    cells, _ = served(tmp_path / "map.yaml")
    assert (cells == 0).sum() == (stored.kind == FLOOR).sum() > 100
    assert (cells == 100).sum() == (stored.kind == OBSTACLE).sum()
    assert {FREE, OCCUPIED, UNSEEN} == {254, 0, 205}


def test_edges_of_steps_are_obstacles_to_wheels(tmp_path: Path) -> None:
    surface = grid(rows=4, cols=6)
    surface.kind[:] = FLOOR
    surface.height[:, :3], surface.height[:, 3:] = 0.0, 0.03
    write_map(tmp_path / "map.npz", surface, NO_VOXELS)
    export(tmp_path, "map_server", tmp_path)
    cells, _ = served(tmp_path / "map_steps.yaml")
    assert (cells == 100).all(axis=0).tolist() == [False, False, True, True, False, False]
    assert (served(tmp_path / "map.yaml")[0] == 0).all()
    assert step_edges(surface).sum() == 8


def test_plyfile_opens_the_mesh_and_its_steps_are_upright(tmp_path: Path) -> None:
    export(recorded_run(), "ply", tmp_path)
    mesh = PlyData.read(str(tmp_path / "height_mesh.ply"))
    surface = seen_part(read_map(recorded_run() / "map.npz").surface, tmp_path)
    vertices, faces = height_mesh(surface)
    found = np.column_stack([mesh["vertex"][axis] for axis in "xyz"])
    np.testing.assert_allclose(found, vertices, atol=1e-6)
    corners = np.vstack(mesh["face"]["vertex_indices"])
    np.testing.assert_array_equal(corners, faces)
    a, b, c = (found[corners[:, i]].astype(np.float64) for i in range(3))
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    assert (lengths > 0.0).all()
    up = np.abs(normals[:, 2]) / lengths
    assert set(np.round(up, 3)) <= {0.0, 1.0}


def test_a_step_of_the_mesh_has_a_face_of_its_own() -> None:
    surface = grid(rows=1, cols=2)
    surface.kind[:], surface.height[:] = FLOOR, [[0.0, 0.03]]
    vertices, faces = height_mesh(surface)
    assert (len(vertices), len(faces)) == (8, 6)
    upright = [face for face in faces if np.ptp(vertices[face][:, 2]) > 0.0]
    assert len(upright) == 2
    assert all(np.ptp(vertices[face][:, 0]) < 1e-12 for face in upright)


def test_plyfile_opens_the_cloud_of_what_was_seen(tmp_path: Path) -> None:
    export(recorded_run(), "ply", tmp_path)
    cloud = PlyData.read(str(tmp_path / "cloud.ply"))["vertex"]
    points = np.column_stack([cloud[axis] for axis in "xyz"])
    assert len(points) > 1000
    assert np.median(np.abs(points[:, 2])) < 0.02
    assert {"red", "green", "blue"} <= set(cloud.data.dtype.names)


def test_evos_error_is_the_one_in_the_result(tmp_path: Path) -> None:
    from evo.core import metrics
    from evo.tools import file_interface

    paths = export_tum(recorded_run(), tmp_path)
    believed, true = (file_interface.read_tum_trajectory_file(str(path)) for path in paths)
    error = metrics.APE(metrics.PoseRelation.translation_part)
    error.process_data((true, believed))
    found = error.get_all_statistics()
    localization = read_result(recorded_run() / "result.json").localization
    assert localization is not None
    ours = localization.translation_error
    assert found["mean"] == pytest.approx(ours.mean, abs=1e-8)
    assert found["max"] == pytest.approx(ours.max, abs=1e-8)
    assert found["std"] == pytest.approx(ours.std, abs=1e-8)
    assert true.num_poses == len(read_trajectory(recorded_run() / "trajectory_truth.tum"))


@pytest.fixture(scope="module")
def messages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[tuple[int, Any, str]]]:
    """The exported messages by topic, as an independent reader decodes them."""
    out = tmp_path_factory.mktemp("mcap")
    export(recorded_run(), "mcap", out)
    found: dict[str, list[tuple[int, Any, str]]] = {}
    with (out / MCAP).open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            assert schema is not None
            found.setdefault(channel.topic, []).append((message.log_time, decoded, schema.name))
    return found


def test_the_topics_have_foxgloves_schemas(messages: dict[str, list[tuple[int, Any, str]]]) -> None:
    assert {topic: rows[0][2] for topic, rows in messages.items()} == {
        "/tf": "foxglove.FrameTransforms",
        "/estimate": "foxglove.PoseInFrame",
        "/truth": "foxglove.PoseInFrame",
        "/camera/calibration": "foxglove.CameraCalibration",
        "/camera/depth": "foxglove.RawImage",
        "/camera/points": "foxglove.PointCloud",
        "/map": "foxglove.Grid",
        "/behaviour": "foxglove.Log",
    }
    for rows in messages.values():
        assert all(a[0] <= b[0] for a, b in pairwise(rows))


def test_poses_and_frames_are_those_of_the_run(
    messages: dict[str, list[tuple[int, Any, str]]],
) -> None:
    rows = read_trajectory(recorded_run() / "trajectory.tum")
    found = [(t, m.pose.position.x, m.pose.orientation.z) for t, m, _ in messages["/estimate"]]
    np.testing.assert_allclose(found, np.column_stack([1e9 * rows[:, 0], rows[:, 1], rows[:, 6]]))
    children = {one.child_frame_id for _, m, _ in messages["/tf"] for one in m.transforms}
    assert children == {"robot", "robot_true", "camera"}


def test_depth_points_and_map_come_back_bit_for_bit(
    messages: dict[str, list[tuple[int, Any, str]]],
) -> None:
    frames = [
        each.depth
        for each in read_observations(recorded_run() / "observations.mcap")
        if each.depth is not None
    ]
    assert len(messages["/camera/depth"]) == len(frames) > 10
    for (_, image, _), frame in zip(messages["/camera/depth"], frames, strict=True):
        depth = np.frombuffer(image.data, "<f4").reshape(image.height, image.width)
        assert (image.encoding, image.step) == ("32FC1", 4 * image.width)
        np.testing.assert_array_equal(depth, frame.depth)
    ((_, told, _),) = messages["/map"]
    surface = seen_part(read_map(recorded_run() / "map.npz").surface, recorded_run())
    cells = np.frombuffer(told.data, [("height", "<f4"), ("kind", "u1"), ("seen", "<u2")])
    np.testing.assert_array_equal(cells["kind"].reshape(-1, told.column_count), surface.kind)
    assert [field.offset for field in told.fields] == [0, 4, 5]
    assert told.pose.position.x == pytest.approx(surface.origin[0])
    clouds = [m for _, m, _ in messages["/camera/points"]]
    assert all(len(cloud.data) % cloud.point_stride == 0 for cloud in clouds)
    states = [entry.state for entry in read_result(recorded_run() / "result.json").behaviour]
    assert [m.message for _, m, _ in messages["/behaviour"]] == states


@pytest.mark.parametrize("to", sorted(FORMATS))
def test_a_run_without_a_recording_is_exported_too(tmp_path: Path, to: str) -> None:
    written = export(plain_run(), to, tmp_path / "out")
    assert written
    assert all(path.stat().st_size > 0 for path in written)
    assert {path.name for path in (tmp_path / "out").iterdir()} == {path.name for path in written}


@pytest.mark.parametrize("to", sorted(FORMATS))
def test_the_default_is_a_folder_in_the_runs(tmp_path: Path, to: str) -> None:
    copy = Path(shutil.copytree(plain_run(), tmp_path / "run"))
    assert all(path.parent == copy / f"export-{to}" for path in export(copy, to))


@pytest.mark.parametrize("to", sorted(FORMATS))
@pytest.mark.parametrize("harm", ["empty", "noise", "half"])
def test_what_is_broken_is_bad_input(tmp_path: Path, to: str, harm: str) -> None:
    copy = Path(shutil.copytree(recorded_run(), tmp_path / "run"))
    for path in copy.iterdir():
        content = path.read_bytes()
        half = content[: len(content) // 2]
        path.write_bytes({"empty": b"", "noise": b"\xff\x00" * 500, "half": half}[harm])
    status = execute(["export", str(copy), "--to", to, "--out", str(tmp_path / "out")])
    # Of half a recording what is whole is still a map; all else cannot be told from garbage.
    assert status == 2 or (to, harm) == ("octomap", "half")


def test_what_is_missing_is_bad_input(tmp_path: Path) -> None:
    for to in FORMATS:
        with pytest.raises(InputError):
            export(tmp_path, to, tmp_path / "out")
        with pytest.raises(InputError, match="no such run"):
            export(tmp_path / "none", to)
    with pytest.raises(InputError, match="one of octomap"):
        export(plain_run(), "stl")
    assert execute(["export", str(plain_run()), "--to", "stl"]) == 2


def test_a_file_in_the_way_is_bad_input(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="--out"):
        export(plain_run(), "tum", tmp_path / "file")


def test_a_full_disk_is_an_error_of_the_recording_and_leaves_no_half_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_self: Path, _content: bytes) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(files.Path, "write_bytes", full)
    with pytest.raises(RecordingError, match="No space left"):
        export(plain_run(), "map_server", tmp_path / "out")
    assert list((tmp_path / "out").iterdir()) == []


def test_json_names_the_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = str(tmp_path)
    assert execute(["export", str(plain_run()), "--to", "tum", "--out", out, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["to"] == "tum"
    assert all(Path(path).is_file() for path in told["files"])


def test_without_the_extra_the_message_names_it(tmp_path: Path) -> None:
    code = (
        "import sys; sys.modules['foxglove'] = None\n"
        "from treadwell.cli.app import execute\n"
        f"sys.exit(execute(['export', {str(plain_run())!r}, '--to', 'mcap', "
        f"'--out', {str(tmp_path)!r}]))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False, env=os.environ
    )
    assert done.returncode == 2
    assert "the extra `foxglove`: pip install '" in done.stderr
