"""A run as a bag of ROS 2: `rosbags` opens it, it says what the run said, and `map` reads it."""

import json
import shutil
from collections.abc import Sequence
from dataclasses import asdict
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore
from run_folders import plain_run, recorded_run

from treadwell.cli.app import execute
from treadwell.errors import InputError, RecordingError
from treadwell.exports import rosbag2
from treadwell.exports.export import export
from treadwell.exports.map_server import seen_part
from treadwell.exports.ros2_messages import Ros2Messages
from treadwell.exports.ros2_run import run_messages
from treadwell.exports.rosbag2 import STORAGES
from treadwell.map_memory import FLOOR, OBSTACLE
from treadwell.poses import pose_matrix, rotation_of
from treadwell.recording.map_file import read_map
from treadwell.recording.messages import decode_command, decode_estimate
from treadwell.recording.observation_log import read_answers, read_observations, read_truth
from treadwell.recording.recorded_camera import recorded_camera
from treadwell.sources.source import open_source

DEPTH = "/camera/depth/image_rect"
Rows = list[tuple[int, Any]]
STORE = get_typestore(Stores.ROS2_JAZZY)


def opened(bag: Path) -> dict[str, Rows]:
    """The messages by topic, as the library reads them by the definitions of a later ROS."""
    found: dict[str, Rows] = {}
    with Reader(bag) as reader:
        for connection, time_ns, data in reader.messages():
            message = STORE.deserialize_cdr(data, connection.msgtype)
            found.setdefault(connection.topic, []).append((time_ns, message))
    return found


@pytest.fixture(scope="module", params=STORAGES)
def bag(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("bags") / request.param
    written = export(recorded_run(), "rosbag2", out, storage=request.param)
    assert {path.name for path in written} == {path.name for path in out.iterdir()}
    return out


def stamp(message: Any) -> int:  # noqa: ANN401
    return int(message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec)


def test_the_topics_have_ros_types(bag: Path) -> None:
    with Reader(bag) as reader:
        kinds = {each.topic: each.msgtype for each in reader.connections}
        kept = {each.topic for each in reader.connections if each.ext.offered_qos_profiles}
    assert kinds == {
        "/tf_static": "tf2_msgs/msg/TFMessage",
        "/tf": "tf2_msgs/msg/TFMessage",
        "/odom": "nav_msgs/msg/Odometry",
        "/estimate": "geometry_msgs/msg/PoseStamped",
        "/ground_truth": "geometry_msgs/msg/PoseStamped",
        "/imu/data_raw": "sensor_msgs/msg/Imu",
        "/joint_states": "sensor_msgs/msg/JointState",
        "/joint_commands": "sensor_msgs/msg/JointState",
        "/behaviour": "std_msgs/msg/String",
        "/camera/depth/camera_info": "sensor_msgs/msg/CameraInfo",
        "/camera/depth/image_rect": "sensor_msgs/msg/Image",
        "/camera/depth/points": "sensor_msgs/msg/PointCloud2",
        "/map": "nav_msgs/msg/OccupancyGrid",
    }
    assert kept == {"/tf_static", "/map"}


def test_depth_clouds_and_camera_are_the_runs(bag: Path) -> None:
    told, log = opened(bag), recorded_run() / "observations.mcap"
    camera = recorded_camera(log)
    frames = [each.depth for each in read_observations(log) if each.depth is not None]
    images, infos, clouds = (
        told[topic] for topic in (DEPTH, "/camera/depth/camera_info", "/camera/depth/points")
    )
    assert len(images) == len(infos) == len(clouds) == len(frames) > 10
    for (time_ns, image), (_, info), (_, cloud), frame in zip(
        images, infos, clouds, frames, strict=True
    ):
        assert (time_ns, stamp(image)) == (frame.arrival_ns, frame.exposure_ns)
        assert stamp(info) == stamp(cloud) == frame.exposure_ns
        assert (image.encoding, image.step) == ("32FC1", 4 * camera.width)
        depth = image.data.view("<f4").reshape(image.height, image.width)
        np.testing.assert_array_equal(depth.view("u4"), frame.depth.view("u4"))
        assert (info.width, info.height) == (camera.width, camera.height)
        column, row = camera.centre
        assert info.k.tolist() == [camera.focal, 0, column, 0, camera.focal, row, 0, 0, 1]
        assert info.p[:3].tolist() == [camera.focal, 0, column]
        points = cloud.data.view("<f4").reshape(cloud.height, cloud.width, 3)
        np.testing.assert_array_equal(points[:, :, 2].view("u4"), frame.depth.view("u4"))
        seen = np.isfinite(points[5, 7]).all()
        if seen:
            u = camera.focal * points[5, 7, 0] / points[5, 7, 2] + column
            assert u == pytest.approx(7.0, abs=1e-4)
    assert {m.header.frame_id for _, m in (*images, *infos, *clouds)} == {"camera_optical_frame"}


def test_senses_targets_and_odometry_are_the_runs_to_the_bit(bag: Path) -> None:
    told, log = opened(bag), recorded_run() / "observations.mcap"
    observations = list(read_observations(log))
    commands, beliefs = (
        [decode(each[i]) for each in read_answers(log)]
        for i, decode in ((0, decode_command), (1, decode_estimate))
    )
    assert all(len(told[topic]) == len(observations) for topic in ("/imu/data_raw", "/odom"))
    for i, observation in enumerate(observations):
        states, targets = (told[topic][i][1] for topic in ("/joint_states", "/joint_commands"))
        assert stamp(states) == stamp(targets) == observation.time_ns
        np.testing.assert_array_equal(states.position, observation.joint_positions)
        np.testing.assert_array_equal(states.velocity, observation.joint_velocities)
        np.testing.assert_array_equal(targets.position, commands[i].positions)
        np.testing.assert_array_equal(targets.effort, commands[i].torques)
        imu = told["/imu/data_raw"][i][1]
        force = imu.linear_acceleration
        assert [force.x, force.y, force.z] == observation.specific_force.tolist()
        assert imu.orientation_covariance[0] == -1
        odom = told["/odom"][i][1]
        assert (odom.header.frame_id, odom.child_frame_id) == ("odom", "base_link")
        place = odom.pose.pose.position
        assert (place.x, place.y, place.z) == beliefs[i].odometry[:3]
    truth = [(m.pose.position.x, m.pose.position.y) for _, m in told["/ground_truth"]]
    assert truth == [row[:2] for row in read_truth(log)]
    changes = [b.state for a, b in pairwise([None, *beliefs]) if not a or a.state != b.state]
    assert [m.data for _, m in told["/behaviour"]] == changes


def matrix(transform: Any) -> np.ndarray:  # noqa: ANN401
    place, turn = transform.translation, transform.rotation
    pose = np.eye(4)
    pose[:3, 3] = place.x, place.y, place.z
    pose[:3, :3] = rotation_of((turn.x, turn.y, turn.z, turn.w))
    return pose


def test_the_transforms_are_a_tree_with_the_names_of_rep_105(bag: Path) -> None:
    told = opened(bag)
    edges = {
        (each.header.frame_id, each.child_frame_id)
        for topic in ("/tf", "/tf_static")
        for _, message in told[topic]
        for each in message.transforms
    }
    assert edges == {
        ("map", "odom"),
        ("odom", "base_link"),
        ("base_link", "camera_link"),
        ("camera_link", "camera_optical_frame"),
        ("torso", "imu_link"),
    }
    ((_, static),) = told["/tf_static"]
    optical = matrix(static.transforms[0].transform)
    np.testing.assert_allclose(optical[:3, :3] @ [0, 0, 1], [1, 0, 0], atol=1e-12)
    np.testing.assert_allclose(optical[:3, :3] @ [1, 0, 0], [0, -1, 0], atol=1e-12)
    placed = [m.transforms for _, m in told["/tf"] if len(m.transforms) == 2]
    answers = read_answers(recorded_run() / "observations.mcap")
    for (odom, base), (_, answer) in zip(placed, answers, strict=True):
        believed = pose_matrix(*decode_estimate(answer).pose)
        found = matrix(odom.transform) @ matrix(base.transform)
        np.testing.assert_allclose(found, believed, atol=1e-12)


def test_a_robot_that_turned_by_odometry_alone_is_placed_where_it_is_believed() -> None:
    from treadwell.exports.ros2_run import _placed, _velocity
    from treadwell.recording.messages import Belief

    belief = Belief(0, (1.0, -2.0, 0.1, 3.0), (0.4, 0.3, 0.0, -3.1), "walk", "", "")
    (odom, base) = Ros2Messages().transforms(_placed(0, belief)).transforms
    found = matrix(odom.transform) @ matrix(base.transform)
    np.testing.assert_allclose(found, pose_matrix(*belief.pose), atol=1e-12)
    linear, rate = _velocity((0.0, 0.0, 0.0, 3.1), (0.0, 0.1, 0.0, np.pi), 0.5)
    assert linear == pytest.approx((0.0, -0.2, 0.0))
    assert rate == pytest.approx((np.pi - 3.1) / 0.5)


def test_the_map_is_the_runs_where_it_is(bag: Path) -> None:
    ((_, grid),) = opened(bag)["/map"]
    surface = seen_part(read_map(recorded_run() / "map.npz").surface, recorded_run())
    cells = grid.data.reshape(grid.info.height, grid.info.width)
    np.testing.assert_array_equal(cells == 0, surface.kind == FLOOR)
    np.testing.assert_array_equal(cells == 100, surface.kind == OBSTACLE)
    assert set(np.unique(cells)) <= {-1, 0, 100}
    assert grid.info.resolution == pytest.approx(surface.cell)
    assert (grid.info.origin.position.x, grid.info.origin.position.y) == surface.origin


def test_map_reads_the_frames_of_the_run_from_the_bag(bag: Path) -> None:
    ours, theirs = list(open_source(recorded_run())), list(open_source(bag, topics=[DEPTH]))
    assert len(ours) == len(theirs) > 10
    for a, b in zip(ours, theirs, strict=True):
        assert a.time == pytest.approx(b.time, abs=1e-9)
        np.testing.assert_allclose(a.world_from_sensor, b.world_from_sensor, atol=1e-7)
        assert a.camera is not None
        assert b.camera is not None
        assert asdict(a.camera) == asdict(b.camera)
        assert a.depth is not None
        np.testing.assert_array_equal(a.depth, b.depth)


@pytest.mark.slow
def test_a_map_of_the_bag_is_that_of_the_run(bag: Path, tmp_path: Path) -> None:
    maps = []
    for name, source in (("run", [str(recorded_run())]), ("bag", [str(bag), "--topic", DEPTH])):
        out = tmp_path / name
        assert execute(["map", *source, "--no-record", "--out", str(out), "--json"]) == 0
        told = json.loads((out / "result.json").read_text())
        maps.append((read_map(out / "map.npz").surface, told["frames_used"], told["cells"]))
    (run, *run_told), (other, *bag_told) = maps
    assert run_told == bag_told
    assert run.origin == pytest.approx(other.origin)
    np.testing.assert_array_equal(run.kind, other.kind)
    np.testing.assert_allclose(run.height, other.height, atol=1e-6)


def test_a_late_camera_is_placed_at_its_exposure(tmp_path: Path) -> None:
    import treadwell

    settings = ("time_limit=1", "sensors.latency=0.1")
    treadwell.run("open_floor", overrides=settings, out=tmp_path / "run")
    export(tmp_path / "run", "rosbag2", tmp_path / "bag")
    # The first stamp is 0, which to ROS is none: that image is taken for one of its arrival.
    ours = list(open_source(tmp_path / "run"))[1:]
    theirs = list(open_source(tmp_path / "bag", topics=[DEPTH]))[1:]
    assert len(ours) > 5
    assert [a.time for a in ours] == pytest.approx([b.time for b in theirs], abs=1e-9)
    for a, b in zip(ours, theirs, strict=True):
        np.testing.assert_allclose(a.world_from_sensor, b.world_from_sensor, atol=1e-7)


def test_a_run_without_observations_gives_its_way_and_its_map(tmp_path: Path) -> None:
    export(plain_run(), "rosbag2", tmp_path / "bag")
    assert set(opened(tmp_path / "bag")) == {"/tf", "/estimate", "/ground_truth", "/map"}


def refused(arguments: Sequence[str | Path], capsys: pytest.CaptureFixture[str]) -> str:
    assert execute(["export", *(str(each) for each in arguments), "--to", "rosbag2"]) == 2
    message = capsys.readouterr().err
    assert message.startswith("error: ")
    assert len(message.splitlines()) == 1
    return message


def test_what_cannot_be_is_one_message(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bag = tmp_path / "bag"
    export(plain_run(), "rosbag2", bag)
    before = {path: path.read_bytes() for path in bag.iterdir()}
    assert "is not empty" in refused([plain_run(), "--out", bag], capsys)
    assert {path: path.read_bytes() for path in bag.iterdir()} == before
    assert "no such run" in refused([tmp_path / "none"], capsys)
    (tmp_path / "empty").mkdir()
    assert "trajectory.tum" in refused([tmp_path / "empty"], capsys)
    copy = Path(shutil.copytree(recorded_run(), tmp_path / "run"))
    (copy / "recording.rrd").unlink()
    assert "there is no recording" in refused([copy, "--out", tmp_path / "out"], capsys)
    assert list((tmp_path / "out").iterdir()) == []
    assert "sqlite3" in refused([plain_run(), "--storage", "db3"], capsys)
    odd = tmp_path / "a#b"
    assert "?#%" in refused([plain_run(), "--out", odd, "--storage", "sqlite3"], capsys)
    with pytest.raises(InputError, match="--storage: found mcap; only a rosbag2"):
        export(plain_run(), "tum", tmp_path / "ways", storage="mcap")
    with pytest.raises(InputError, match="must be one of mcap, sqlite3"):
        export(plain_run(), "rosbag2", tmp_path / "new", storage="zip")


def test_a_full_disk_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_self: object, _connection: object, _time: int, _data: bytes) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(rosbag2.Writer, "write", full)
    with pytest.raises(RecordingError, match="No space left"):
        export(plain_run(), "rosbag2", tmp_path / "out")
    assert list((tmp_path / "out").iterdir()) == []


def test_a_run_that_was_cut_off_gives_what_is_whole(tmp_path: Path) -> None:
    copy = Path(shutil.copytree(recorded_run(), tmp_path / "run"))
    log = (copy / "observations.mcap").read_bytes()
    (copy / "observations.mcap").write_bytes(log[: len(log) // 2])
    with pytest.raises(InputError):
        export(copy, "rosbag2", tmp_path / "whole")
    (copy / "result.json").unlink()
    export(copy, "rosbag2", tmp_path / "cut")
    found = opened(tmp_path / "cut")
    assert 10 < len(found["/odom"]) < len(list(run_ticks()))


def run_ticks() -> Sequence[Any]:
    told = run_messages(recorded_run(), Ros2Messages())
    return [each for each in told if each.topic == "/odom"]
