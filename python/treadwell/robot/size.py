"""How large a robot is: its legs against those of `qrio`, whose numbers all defaults are."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.robot.file import LegTable, RobotFile

Floats = NDArray[np.float64]

QRIO_LEG_M = 0.25
"""Length of `qrio`'s leg, m: thigh, shank, and the height of the ankle."""
_ACROSS = 0.8
"""A joint whose axis has this much of the transverse axis bends the leg forwards and back."""
_NEAR = 0.75
"""`BodyTable.foot_side` as a share of where the outer edges of the soles are."""


@dataclass(frozen=True, slots=True)
class Stance:
    """A robot as it stands upright, its root level.

    Attributes:
        model: the compiled MJCF, alone in an empty world.
        data: the same in the stance.
    """

    model: mujoco.MjModel
    data: mujoco.MjData

    @staticmethod
    def of(model: mujoco.MjModel, stand_qpos: Floats) -> "Stance":
        """Put a model into the stance of these positions."""
        data = mujoco.MjData(model)
        data.qpos[:] = stand_qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_camlight(model, data)
        return Stance(model, data)

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
        bends = [i for i, joint in enumerate(joints) if abs(self.data.xaxis[joint][1]) > _ACROSS]
        ankle_height = -self.sole(leg)[2]
        if len(bends) < 2 or bends[-2] == 0:
            # No knee: as far as the first joint is above the ground.
            return float(self.data.xanchor[joints[0]][2] + ankle_height)
        knee, ankle = joints[bends[-2]], joints[bends[-1]]
        hip = self._centre(joints[: bends[-2]])
        thigh = self._from_axis(hip, knee)
        shank = self._from_axis(self.data.xanchor[ankle], knee)
        return thigh + shank + float(self.data.xanchor[ankle][2] + ankle_height)

    def _centre(self, joints: list[int]) -> Floats:
        """Return the place (3,) that is nearest to the axes of joints, m."""
        anchors, axes = self.data.xanchor[joints], self.data.xaxis[joints]
        across = np.eye(3) - axes[:, :, None] * axes[:, None, :]
        # Axes that are parallel leave a direction open: there it is at the mean of the anchors.
        weak = 1e-9 * np.eye(3)
        right = np.einsum("nij,nj->i", across, anchors) + weak @ anchors.mean(axis=0)
        place: Floats = np.linalg.solve(across.sum(axis=0) + weak, right)
        return place

    def _from_axis(self, place: Floats, joint: int) -> float:
        along = np.cross(self.data.xaxis[joint], place - self.data.xanchor[joint])
        return float(np.linalg.norm(along))


def scale_of(stance: Stance, file: RobotFile) -> float:
    """Return the length of a robot's legs over that of `qrio`'s, rounded to a thousandth."""
    if file.robot.scale is not None:
        return file.robot.scale
    legs = (file.legs.left, file.legs.right)
    return round(sum(stance.leg_length(leg) for leg in legs) / len(legs) / QRIO_LEG_M, 3)


def with_size(
    described: Mapping[str, Any], scale: float, stance: Stance, file: RobotFile
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
