"""A walker whose policy is a network in ONNX, as walkers that were trained elsewhere come.

    pip install "onnxruntime>=1.22"
    export PYTHONPATH=examples
    treadwell run open_floor --set navigation.walker=onnx_walker:OnnxWalker \
        --set navigation.OnnxWalker.policy=policy.onnx

The network maps (1, 9 + 3 k) float32 to (1, k), for the k joints that it moves:

| values | what |
| --- | --- |
| 3 | command: forward m/s, left m/s, counter-clockwise rad/s; 0 to stand |
| 3 | direction of gravity in the torso's frame |
| 3 | angular velocity of the torso, rad/s |
| k | joint positions less those of the upright stance, rad |
| k | joint velocities, rad/s |
| k | its last action |

An action, times `action_scale`, is what the joints are to be away from the upright stance, rad.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from treadwell.protocols import Command, JointTargets, Proprioception

try:
    import onnxruntime
except ImportError as error:
    raise ImportError("needs onnxruntime: pip install onnxruntime") from error


class OnnxWalker:
    """Runs a policy; the head, unless the policy moves it, looks where the command says."""

    def __init__(
        self,
        policy: str,
        joints: Sequence[str] = (),
        action_scale: float = 0.25,
        ticks: int = 2,
        angular_velocity_scale: float = 1.0,
        joint_velocity_scale: float = 1.0,
    ) -> None:
        """Take the parameters of `[navigation.OnnxWalker]`.

        Args:
            policy: the network's file.
            joints: names of the joints that it moves, in its order; all but the head's by default.
            action_scale: rad of an action of 1.
            ticks: control ticks of 10 ms from one action to the next.
            angular_velocity_scale: factor on the angular velocity that the network is given.
            joint_velocity_scale: factor on the joint velocities that it is given.
        """
        if ticks < 1:
            raise ValueError(f"ticks must be 1 or more, got {ticks}")
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = 1  # the same sums in the same order, on any machine
        self.session = onnxruntime.InferenceSession(
            policy, options, providers=["CPUExecutionProvider"]
        )
        self.joints = tuple(joints)
        self.action_scale = action_scale
        self.ticks = ticks
        self.scales = (angular_velocity_scale, joint_velocity_scale)
        self._moved: list[int] = []
        self._action = np.zeros(0, np.float32)
        self._passed = 0

    def step(self, command: Command, proprioception: Proprioception) -> JointTargets:
        """Return the targets for a control tick; the network is asked at every `ticks`-th."""
        if not self._moved:
            self._begin(command, proprioception)
        if self._passed % self.ticks == 0:
            seen = self.observation(command, proprioception)
            name = self.session.get_inputs()[0].name
            self._action = self.session.run(None, {name: seen[None]})[0][0]
        self._passed += 1
        position = proprioception.stand
        for joint, angle in command.head.items():
            position[joint] = angle
        away = self.action_scale * self._action.astype(np.float64)
        position[self._moved] = proprioception.stand[self._moved] + away
        return JointTargets.at(np.clip(position, *proprioception.joint_ranges.T))

    def observation(self, command: Command, felt: Proprioception) -> NDArray[np.float32]:
        """Return what the network is given, (9 + 3 k,)."""
        turning, moving = self.scales
        parts = (
            command.velocity or (0.0, 0.0, 0.0),
            felt.gravity,
            turning * felt.angular_velocity,
            (felt.joint_positions - felt.stand)[self._moved],
            moving * felt.joint_velocities[self._moved],
            self._action,
        )
        return np.concatenate(parts).astype(np.float32)

    def _begin(self, command: Command, felt: Proprioception) -> None:
        """Find the joints that the network moves, and see whether it is made for them."""
        names = felt.joint_names
        head = {names[joint] for joint in command.head}
        moved = self.joints or [name for name in names if name not in head]
        unknown = [name for name in moved if name not in names]
        if unknown:
            raise ValueError(f"joints: the robot has no {', '.join(unknown)}")
        count = len(moved)
        shapes = [each.shape[-1] for each in self._ends()]
        if shapes != [9 + 3 * count, count]:
            raise ValueError(
                f"policy: takes {shapes[0]} values and gives {shapes[1]}; "
                f"for {count} joints it must take {9 + 3 * count} and give {count}"
            )
        self._moved = [names.index(name) for name in moved]
        self._action = np.zeros(count, np.float32)

    def _ends(self) -> tuple[onnxruntime.NodeArg, onnxruntime.NodeArg]:
        return self.session.get_inputs()[0], self.session.get_outputs()[0]
