"""The localizer `truth`, for ablations only: it is handed the simulator's pose."""

import mujoco

from treadwell._core import BodyState, FloorView, Planes
from treadwell.judging.judge import Judge
from treadwell.protocols import Pose


class TruthLocalizer:
    """Knows the true pose of the robot's frame."""

    def __init__(self, judge: Judge, data: mujoco.MjData) -> None:
        """Keep what tells the truth."""
        self._judge = judge
        self._data = data

    def correct(self, body: BodyState, planes: Planes, view: FloorView) -> None:
        """Learn nothing: there is nothing to learn."""

    def estimate(self, body: BodyState) -> Pose:  # noqa: ARG002 - the truth needs no body state
        """Return the true pose (x, y, z, yaw), m and rad."""
        truth, touch = self._judge.truth, self._judge.touch
        # While a foot swings, the height is that of the sole that carries the robot.
        frame = truth.frame(truth.soles(self._data), (touch.left, touch.right))
        return frame.x, frame.y, frame.z, frame.yaw
