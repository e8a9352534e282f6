"""The example of a walker that runs a network in ONNX."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import treadwell
from treadwell._core import Situation
from treadwell.episode import Step
from treadwell.errors import CoreError, InputError
from treadwell.protocols import Decision
from treadwell.robot.load import load_robot

onnx = pytest.importorskip("onnx", reason="needs onnx, of the group dev, to make networks")
pytest.importorskip("onnxruntime", reason="needs onnxruntime: the extra onnx")
QRIO = load_robot("qrio")
HEAD = {QRIO.file.head.pan, QRIO.file.head.tilt}
LEGS = [name for name in QRIO.joints if name not in HEAD]
OF_LEGS = [i for i, name in enumerate(QRIO.joints) if name not in HEAD]


def network(path: Path, action: np.ndarray, weights: np.ndarray | None = None) -> str:
    """Write a network of one layer: an action, and of each seen value its weight's times."""
    count = len(action)
    seen = 9 + 3 * count
    rows = np.zeros((seen, count)) if weights is None else weights
    kept = [
        onnx.numpy_helper.from_array(values.astype(np.float32), name)
        for name, values in (("weights", rows), ("bias", action[None]))
    ]
    nodes = [
        onnx.helper.make_node("MatMul", ["seen", "weights"], ["turned"]),
        onnx.helper.make_node("Add", ["turned", "bias"], ["action"]),
    ]
    ends = [
        onnx.helper.make_tensor_value_info(name, onnx.TensorProto.FLOAT, [1, size])
        for name, size in (("seen", seen), ("action", count))
    ]
    graph = onnx.helper.make_graph(nodes, "policy", [ends[0]], [ends[1]], kept)
    opset = [onnx.helper.make_opsetid("", 17)]
    onnx.save(onnx.helper.make_model(graph, opset_imports=opset, ir_version=9), path)
    return str(path)


def steps(policy: str, seconds: float, *settings: str, **parts: Any) -> list[Step]:  # noqa: ANN401
    overrides = (
        f"time_limit={seconds}",
        "navigation.walker=onnx_walker:OnnxWalker",
        f"navigation.OnnxWalker.policy={policy}",
        *settings,
    )
    episode = treadwell.Episode("open_floor", overrides=overrides, **parts)
    found = []
    while episode.verdict is None:
        found.append(episode.tick())
    assert episode.judge.falls == 0
    return found


def test_a_policy_of_no_action_stands_for_seconds_and_another_one_leans(tmp_path: Path) -> None:
    still = network(tmp_path / "still.onnx", np.zeros(len(LEGS)))
    stood = steps(still, 4.0)
    assert len(stood) == 400
    for step in stood:
        assert step.command.position[OF_LEGS] == pytest.approx(QRIO.stand[OF_LEGS], abs=1e-9)
    lean = np.zeros(len(LEGS))
    lean[LEGS.index("waist_pitch")] = 0.2
    leant = steps(network(tmp_path / "lean.onnx", lean), 0.5)[-1]
    moved = leant.command.position[OF_LEGS] - QRIO.stand[OF_LEGS]
    assert moved == pytest.approx(0.25 * lean, abs=1e-6)


def test_the_network_is_given_command_gravity_turn_joints_and_its_last_action(
    tmp_path: Path,
) -> None:
    """Each value of the observation, alone, on the one joint that a network moves."""

    class Strolling:
        def next(self, _: Situation) -> Decision:
            return Decision("stroll", velocity=(0.05, -0.04, 0.3))

    joint = "left_wrist_yaw"
    at = QRIO.joints.index(joint)
    named = f'navigation.OnnxWalker.joints=["{joint}"]'

    def one(value: int, weight: float) -> tuple[Step, float]:
        """The last tick at which a network of one weight was asked, and what it answered."""
        weights = np.zeros((12, 1))
        weights[value] = weight
        policy = network(tmp_path / f"{value}.onnx", np.full(1, 0.4), weights)
        asked = steps(policy, 0.2, named, behaviour=Strolling())[-2]
        return asked, (asked.command.position[at] - QRIO.stand[at]) / 0.25 - 0.4

    for value, told in enumerate((0.05, -0.04, 0.3)):
        assert one(value, 1.0)[1] == pytest.approx(told, abs=1e-6)
    assert one(5, 1.0)[1] == pytest.approx(-1.0, abs=0.01)
    assert abs(one(3, 1.0)[1]) < 0.1
    asked, answer = one(8, 1.0)
    assert answer == pytest.approx(asked.observation.angular_velocity[2], abs=0.01)
    asked, answer = one(9, 0.5)
    away = asked.observation.joint_positions[at] - QRIO.stand[at]
    assert abs(away) > 0.02
    assert answer == pytest.approx(0.5 * away, abs=1e-6)
    asked, answer = one(10, 0.01)
    assert answer == pytest.approx(0.01 * asked.observation.joint_velocities[at], abs=1e-6)
    weights = np.zeros((12, 1))
    weights[11] = 1.0
    # A half more at every second tick: what it did last is given again.
    growing = steps(network(tmp_path / "more.onnx", np.array([0.5]), weights), 0.1, named)
    angles = [(step.command.position[at] - QRIO.stand[at]) / 0.25 for step in growing]
    assert angles == pytest.approx(np.repeat([0.5, 1.0, 1.5, 2.0, 2.5], 2), abs=1e-6)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (('navigation.OnnxWalker.joints=["tail"]',), "joints: the robot has no tail"),
        ((), "policy: takes 12 values and gives 1; for 24 joints it must take 81 and give 24"),
    ],
)
def test_a_policy_that_does_not_fit_the_robot_ends_the_run_with_a_reason(
    settings: tuple[str, ...], message: str, tmp_path: Path
) -> None:
    with pytest.raises(CoreError, match=f"walker: onnx_walker:OnnxWalker: .*{message}"):
        steps(network(tmp_path / "small.onnx", np.zeros(1)), 0.1, *settings)


def test_a_policy_that_is_none_is_bad_input(tmp_path: Path) -> None:
    path = tmp_path / "no.onnx"
    path.write_bytes(b"none")
    with pytest.raises(InputError, match="cannot make onnx_walker:OnnxWalker"):
        steps(str(path), 0.1)
    with pytest.raises(InputError, match="ticks must be 1 or more, got 0"):
        steps(str(path), 0.1, "navigation.OnnxWalker.ticks=0")
