"""The example of a node of ROS 2, on a stand-in for `rclpy`, against a server: the same targets."""

import importlib.util
from collections.abc import Iterator
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
        made.core.close()


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
