"""The localizer `truth`, for ablations only: it is handed the simulator's pose."""

import mujoco

from treadwell._core import BodyState, FloorView, Planes
from treadwell.judging.ground_truth import GroundTruth
from treadwell.protocols import Pose


class TruthLocalizer:
    """Knows the true pose of the robot's frame."""

    def __init__(self, truth: GroundTruth, data: mujoco.MjData) -> None:
        """Keep what tells the truth."""
        self._truth = truth
        self._data = data

    def correct(self, body: BodyState, planes: Planes, view: FloorView) -> None:
        """Learn nothing: there is nothing to learn."""

    def estimate(self, body: BodyState) -> Pose:  # noqa: ARG002 - the truth needs no body state
        """Return the true pose (x, y, z, yaw), m and rad."""
        frame = self._truth.frame(self._truth.soles(self._data), (True, True))
        return frame.x, frame.y, frame.z, frame.yaw
