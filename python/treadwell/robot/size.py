"""How large a robot is: its legs against those of `qrio`, whose numbers all defaults are."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.robot.file import LegTable, RobotFile
from treadwell.robot.joint_roles import ANKLE_PITCH, KNEE, nearest_to_axes, roles

Floats = NDArray[np.float64]

QRIO_LEG_M = 0.25
"""Length of `qrio`'s leg, m: thigh, shank, and the height of the ankle."""
_NEAR = 0.75
"""`BodyTable.foot_side` as a share of where the outer edges of the soles are."""


@dataclass(frozen=True, slots=True)
class Upright:
    """A robot as it stands upright, its root level.

    Attributes:
        model: the compiled MJCF, alone in an empty world.
        data: the same in the stance.
    """

    model: mujoco.MjModel
    data: mujoco.MjData

    @staticmethod
    def of(model: mujoco.MjModel, stand_qpos: Floats) -> "Upright":
        """Put a model into the stance of these positions."""
        data = mujoco.MjData(model)
        data.qpos[:] = stand_qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_camlight(model, data)
        return Upright(model, data)

    def sole(self, leg: LegTable) -> Floats:
        """Return the centre (3,) of a leg's sole in the world, m."""
        link = self.model.body(leg.sole.link).id
        turned = self.data.xmat[link].reshape(3, 3) @ np.array(leg.sole.position)
        place: Floats = self.data.xpos[link] + turned
        return place

    def middle(self, file: RobotFile) -> Floats:
        """Return the place (3,) midway between the soles in the world, m."""
        place: Floats = 0.5 * (self.sole(file.legs.left) + self.sole(file.legs.right))
        return place

    def eyes(self, file: RobotFile) -> tuple[float, float]:
        """Return how high the camera is above the ground, and how far ahead of the middle, m."""
        camera = self.data.cam_xpos[self.model.camera(file.camera.name).id]
        from_middle = camera - self.middle(file)
        return float(from_middle[2]), float(from_middle[0])

    def foot_side(self, file: RobotFile) -> float:
        """Return how far to each side of the middle the ground matters to the feet, m."""
        left, right = file.legs.left, file.legs.right
        apart = abs(float(self.sole(left)[1] - self.sole(right)[1]))
        return _NEAR * 0.5 * (apart + min(left.sole.width, right.sole.width))

    def leg_length(self, leg: LegTable) -> float:
        """Return the length of a straight leg from the hip's centre to the ground, m.

        The hip's centre is where the axes above the knee come nearest to each other.
        """
        joints = [self.model.joint(name).id for name in leg.joints]
        knee = leg.joints.index(self.knee(leg))
        if knee == 0:
            # No hip: as far as the first joint is above the ground.
            return float(self.data.xanchor[joints[0]][2] - self.sole(leg)[2])
        hip = nearest_to_axes(self.data, joints[:knee])
        ankle = self.data.xanchor[joints[self._ankle(leg, knee)]]
        thigh = self._from_axis(hip, joints[knee])
        shank = self._from_axis(ankle, joints[knee])
        return thigh + shank + float(ankle[2] - self.sole(leg)[2])

    def knee(self, leg: LegTable) -> str:
        """Return the name of a leg's knee."""
        return leg.joints[self._roles(leg).index(KNEE)]

    def _ankle(self, leg: LegTable, knee: int) -> int:
        """Return the place in a leg of the joint that pitches its foot, or of its last joint."""
        found = self._roles(leg)
        return found.index(ANKLE_PITCH) if ANKLE_PITCH in found[knee:] else len(found) - 1

    def _roles(self, leg: LegTable) -> list[str]:
        joints = [self.model.joint(name).id for name in leg.joints]
        forward = self.data.xmat[1].reshape(3, 3)[:, 0]
        return roles(self.data, joints, self.sole(leg), forward)

    def _from_axis(self, place: Floats, joint: int) -> float:
        along = np.cross(self.data.xaxis[joint], place - self.data.xanchor[joint])
        return float(np.linalg.norm(along))


def scale_of(stance: Upright, file: RobotFile) -> float:
    """Return the length of a robot's legs over that of `qrio`'s, rounded to a thousandth."""
    if file.robot.scale is not None:
        return file.robot.scale
    legs = (file.legs.left, file.legs.right)
    return round(sum(stance.leg_length(leg) for leg in legs) / len(legs) / QRIO_LEG_M, 3)


def with_size(
    described: Mapping[str, Any], scale: float, stance: Upright, file: RobotFile
) -> dict[str, Any]:
    """Return a robot's description with its scale, and with the lengths that its file leaves open.

    Args:
        described: what the description says of the rest.
        scale: what `scale_of` returned.
        stance: the robot upright.
        file: its `robot.toml`.
    """
    eye_height, eye_ahead = stance.eyes(file)
    head, body = dict(described["head"]), dict(described["body"])
    for table, key, length_m in (
        (head, "eye_height", eye_height),
        (head, "eye_ahead", eye_ahead),
        (body, "foot_side", stance.foot_side(file)),
    ):
        if table[key] is None:
            table[key] = length_m
    return {**described, "scale": scale, "head": head, "body": body}
