"""The simulator's truth, for judging, scoring and recording; and the localizer for ablations."""

import math
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell._core import BodyState, FloorView, Planes
from treadwell.robot import Robot

Pose = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Soles:
    """Where the soles' rectangles are.

    Attributes:
        centers: (2, 3) m world, left and right.
        headings: (2,) rad, of each sole's x axis.
    """

    centers: NDArray[np.float64]
    headings: NDArray[np.float64]


class GroundTruth:
    """Reads the true robot frame: midway between the soles, on the lower one's height."""

    def __init__(self, model: mujoco.MjModel, robot: Robot) -> None:
        """Find the soles in the compiled model."""
        legs = (robot.file.legs.left, robot.file.legs.right)
        self._links = [model.body(leg.sole.link).id for leg in legs]
        self._positions = [np.array(leg.sole.position) for leg in legs]

    def soles(self, data: mujoco.MjData) -> Soles:
        """Return where both soles are; link poses in `data` must be up to date."""
        centers, headings = np.empty((2, 3)), np.empty(2)
        for i, (link, position) in enumerate(zip(self._links, self._positions, strict=True)):
            rotation = data.xmat[link].reshape(3, 3)
            centers[i] = data.xpos[link] + rotation @ position
            headings[i] = math.atan2(rotation[1, 0], rotation[0, 0])
        return Soles(centers, headings)

    def robot_pose(self, data: mujoco.MjData) -> Pose:
        """Return (x, y, z, yaw) of the robot frame in the world."""
        soles = self.soles(data)
        x, y = soles.centers[:, :2].mean(axis=0)
        left, right = soles.headings
        yaw = math.atan2(math.sin(left) + math.sin(right), math.cos(left) + math.cos(right))
        return float(x), float(y), float(soles.centers[:, 2].min()), yaw


class TruthLocalizer:
    """The localizer `truth`: knows the simulator's pose. An ablation, and the result says so."""

    def __init__(self, truth: GroundTruth, data: mujoco.MjData) -> None:
        """Keep what tells the truth."""
        self._truth = truth
        self._data = data

    def correct(self, body: BodyState, planes: Planes, view: FloorView) -> None:
        """Learn nothing: there is nothing to learn."""

    def estimate(self, body: BodyState) -> Pose:  # noqa: ARG002 - the truth needs no body state
        """Return the true pose."""
        return self._truth.robot_pose(self._data)
