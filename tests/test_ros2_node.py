"""The example of a node of ROS 2, on a stand-in for `rclpy`, against a server: the same targets."""

import ast
import importlib.util
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from ros2_stand_in import (
    CameraInfo,
    Float64MultiArray,
    Header,
    Image,
    Imu,
    JointState,
    Node,
    Stamp,
    Vector3,
    stand_in,
)
from serving_builders import running

import treadwell
from treadwell.observation import Frame, Observation
from treadwell.recording.messages import encode_command
from treadwell.recording.observation_log import read_answers, read_observations
from treadwell.replaying.difference import between_answers
from treadwell.serving.served import ServedRobot

EXAMPLE = Path(__file__).resolve().parent.parent / "examples" / "ros2_node.py"
TALKER = Path(__file__).with_name("ros2_talker.py")
ROS2 = os.environ.get("TREADWELL_ROS2")
"""An interpreter that has `rclpy` and the messages: one of ROS 2, or `pip install ros-rclpy`."""
OLDEST = (3, 8)
"""Python of the oldest ROS 2 that is still found on robots."""
BEGAN_NS = 1_700_000_000_123_456_789
"""Of the robot's clock, which did not begin with the run."""
pytestmark = pytest.mark.slow


def example() -> ModuleType:
    spec = importlib.util.spec_from_file_location("ros2_node", EXAMPLE)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two seconds towards the goal that the node has if it is told none."""
    folder = tmp_path_factory.mktemp("runs") / "run"
    changes = {"time_limit": 2.0, "goal.position": [2.0, 0.0], "goal.radius": 0.15}
    treadwell.run("open_floor", overrides=changes, out=folder)
    return folder / "observations.mcap"


@pytest.fixture
def node(tmp_path: Path) -> Iterator[Any]:
    address = tmp_path / "core.sock"
    with running(ServedRobot("qrio"), address), stand_in({"server": str(address)}):
        made = example().TreadwellNode()
        yield made
        made.close()


def header(time_ns: int) -> Header:
    return Header(Stamp(*divmod(BEGAN_NS + time_ns, 10**9)))


def camera_info(node: Any) -> CameraInfo:  # noqa: ANN401 - of a module that is loaded here
    ours = node.core.robot["camera"]
    k = [ours["fx"], 0.0, ours["cx"], 0.0, ours["fy"], ours["cy"], 0.0, 0.0, 1.0]
    return CameraInfo(height=ours["height"], width=ours["width"], k=k)


def image(frame: Frame, encoding: str = "32FC1", order: str = "<") -> Image:
    rows, cols = frame.depth.shape
    kind = {"32FC1": "f4", "16UC1": "u2"}[encoding]
    numbers = frame.depth if kind == "f4" else np.nan_to_num(1000.0 * frame.depth)
    padded = np.zeros((rows, cols + 3), order + kind)
    padded[:, :cols] = numbers
    step = padded.strides[0]
    at = header(frame.exposure_ns)
    return Image(at, rows, cols, encoding, int(order == ">"), step, padded.tobytes())


def tell(node: Node, seen: Observation, names: list[str]) -> None:
    """What the topics of a robot say of a tick; its joints in another order than the core's."""
    if seen.depth is not None:
        node.hear("depth/image", image(seen.depth))
    rates, forces = (Vector3(*a.tolist()) for a in (seen.angular_velocity, seen.specific_force))
    node.hear("imu", Imu(header(seen.time_ns), rates, forces))
    node.hear("foot_forces", Float64MultiArray(seen.foot_forces.ravel().tolist()))
    listed = (seen.joint_positions, seen.joint_velocities)
    positions, velocities = (a[::-1].tolist() for a in listed)
    node.hear("joint_states", JointState(header(seen.time_ns), names[::-1], positions, velocities))


def test_a_recorded_run_told_by_topics_has_the_same_targets_bit_for_bit(
    node: Any,  # noqa: ANN401 - of a module that is loaded here
    log: Path,
) -> None:
    names = node.core.robot["joints"]
    node.hear("depth/camera_info", camera_info(node))
    ticks = 0
    for seen, recorded in zip(read_observations(log), read_answers(log), strict=False):
        tell(node, seen, names)
        told = node.published["joint_targets"].sent[-1]
        assert told.name == names
        assert told.header == header(seen.time_ns)
        targets = (np.array(a) for a in (told.position, told.velocity, told.effort))
        answer = (encode_command(seen.time_ns, *targets), recorded[1])
        assert between_answers(answer, recorded, names) is None, ticks
        ticks += 1
    assert ticks == 200
    states = {one.data for one in node.published["treadwell_state"].sent}
    assert "look_around" in states


def test_nothing_is_told_before_all_senses_have_spoken(
    node: Any,  # noqa: ANN401 - of a module that is loaded here
    log: Path,
) -> None:
    seen = next(iter(read_observations(log)))
    tell(node, seen, node.core.robot["joints"])
    assert node.published["joint_targets"].sent == []


def test_a_camera_that_is_not_the_robots_is_refused(node: Any) -> None:  # noqa: ANN401
    other = camera_info(node)
    other.k[2] += 20.0
    with pytest.raises(ValueError, match="the robot's folder says"):
        node.hear("depth/camera_info", other)


@pytest.mark.parametrize(("encoding", "order"), [("32FC1", ">"), ("16UC1", "<"), ("16UC1", ">")])
def test_images_are_read_in_either_order_and_unit(
    node: Any,  # noqa: ANN401 - of a module that is loaded here
    encoding: str,
    order: str,
) -> None:
    depth = np.array([[1.25, np.nan, 0.5], [2.0, 3.25, np.nan]], np.float32)
    node.hear("depth/image", image(Frame(5, 5, depth), encoding, order))
    at, read = node.depth
    assert at == BEGAN_NS + 5
    np.testing.assert_allclose(read, depth, rtol=1e-6)
    assert read.dtype == np.float32


def test_a_robot_that_tells_its_joints_twice_a_tick_is_answered_once(
    node: Any,  # noqa: ANN401 - of a module that is loaded here
    log: Path,
) -> None:
    names = node.core.robot["joints"]
    node.hear("depth/camera_info", camera_info(node))
    for seen, _ in zip(read_observations(log), range(5), strict=False):
        tell(node, seen, names)
        between = replace(seen, time_ns=seen.time_ns + node.core.robot["tick_ns"] // 4, depth=None)
        tell(node, between, names)
    assert len(node.published["joint_targets"].sent) == 5


def test_the_node_needs_python_3_8_numpy_and_ros_2_alone() -> None:
    tree = ast.parse(EXAMPLE.read_text(), feature_version=OLDEST)
    imported = {
        alias.name if isinstance(one, ast.Import) else str(one.module)
        for one in ast.walk(tree)
        if isinstance(one, ast.Import | ast.ImportFrom)
        for alias in one.names
    }
    of_ros2 = {"rclpy", "sensor_msgs", "std_msgs"}
    others = {name.partition(".")[0] for name in imported} - of_ros2 - {"numpy"}
    assert others <= sys.stdlib_module_names, others


def test_what_the_server_refuses_is_said_by_the_node(tmp_path: Path) -> None:
    address = tmp_path / "core.sock"
    with (
        running(ServedRobot("qrio"), address),
        stand_in({"server": str(address), "goal": [2.0]}),
        pytest.raises(RuntimeError, match=r"the server: .*goal"),
    ):
        example().TreadwellNode()


@pytest.mark.skipif(not ROS2, reason="TREADWELL_ROS2 names no interpreter with rclpy")
def test_by_ros_2_itself_a_recorded_run_has_the_same_targets_bit_for_bit(
    tmp_path: Path, log: Path
) -> None:
    address, told = tmp_path / "core.sock", tmp_path / "told.npz"
    seen = list(read_observations(log))
    names = ("joint_positions", "joint_velocities", "angular_velocity", "specific_force")
    arrays = {name: np.array([getattr(one, name) for one in seen]) for name in names}
    arrays["foot_forces"] = np.array([one.foot_forces.ravel() for one in seen])
    arrays["time_ns"] = np.array([one.time_ns for one in seen])
    pictures = {i: one.depth for i, one in enumerate(seen) if one.depth is not None}
    arrays["pictured"] = np.array(list(pictures))
    arrays["exposure_ns"] = np.array([one.exposure_ns for one in pictures.values()])
    arrays["depth"] = np.array([one.depth for one in pictures.values()])
    served = ServedRobot("qrio")
    arrays["names"] = np.array(list(served.robot.joints))
    camera = served.hello()["camera"]
    arrays["camera"] = np.array([camera[k] for k in ("width", "height", "fx", "fy", "cx", "cy")])
    np.savez(told, **arrays)
    alone = {"PATH": os.environ["PATH"], "ROS_LOG_DIR": str(tmp_path), "ROS_DOMAIN_ID": "77"}
    parameters = ["--ros-args", "-p", f"server:={address}", "-p", "goal:=[2.0, 0.0]"]
    with running(served, address):
        node = subprocess.Popen([str(ROS2), EXAMPLE, *parameters], env=alone, cwd=tmp_path)
        try:
            subprocess.run([str(ROS2), TALKER, told], env=alone, check=True, timeout=300)
        finally:
            node.send_signal(signal.SIGINT)
            assert node.wait(20) == 0
    heard = np.load(f"{told}.heard.npz")
    for tick, (one, recorded) in enumerate(zip(seen, read_answers(log), strict=False)):
        targets = (heard[name][tick] for name in ("position", "velocity", "effort"))
        answer = (encode_command(one.time_ns, *targets), recorded[1])
        assert between_answers(answer, recorded, arrays["names"].tolist()) is None, tick
