"""What an MJCF shows of a robot without being told: its legs, soles, head, unit, and camera."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LEG_JOINTS = 6
ALIKE_M = 1e-3
"""By how much the places of joints may differ from mirror images, m, and axes, as a cosine."""
ALIKE_RAD = 0.02
"""By how much ranges may: a NAO's published ones differ by 0.01."""
SOLE_DEPTH_M = 0.003
"""What of a foot is this near to its lowest point belongs to the sole."""


@dataclass(frozen=True, slots=True)
class FoundLeg:
    """A chain that ends in a foot.

    Attributes:
        side: "left" where it is at +y, else "right".
        joints: from the hip down; the last six of the chain.
        foot: the last link.
        sole: centre (x, y, z), length and width of what touches the ground, in the link's frame.
    """

    side: str
    joints: tuple[str, ...]
    foot: str
    sole: tuple[tuple[float, float, float], float, float]


@dataclass(frozen=True, slots=True)
class Anatomy:
    """A model as it is at joint angles zero, with what its shape tells."""

    model: mujoco.MjModel
    data: mujoco.MjData

    @staticmethod
    def of(model: mujoco.MjModel) -> "Anatomy":
        """Pose a model at joint angles zero."""
        data = mujoco.MjData(model)
        data.qpos[:] = model.qpos0
        if model.njnt and model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE:
            data.qpos[:7], data.qpos[7:] = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0), 0.0
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_camlight(model, data)
        return Anatomy(model, data)

    def chain(self, body: int) -> list[int]:
        """Return the hinges from the root to a body."""
        joints: list[int] = []
        while body > 0:
            first, count = int(self.model.body_jntadr[body]), int(self.model.body_jntnum[body])
            hinges = [
                joint
                for joint in range(first, first + count)
                if self.model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE
            ]
            joints = hinges + joints
            body = int(self.model.body_parentid[body])
        return joints

    def legs(self) -> dict[str, FoundLeg]:
        """Return the legs by their side: of the chains of six named hinges, the lowest two."""
        model, data = self.model, self.data
        parents = {int(parent) for parent in model.body_parentid[1:]}
        ends = [body for body in range(1, model.nbody) if body not in parents]
        chains = {body: self.chain(body) for body in ends}
        feet = [
            body
            for body, joints in chains.items()
            if len(joints) >= LEG_JOINTS
            and model.body(body).name
            and all(model.joint(joint).name for joint in joints)
        ]
        feet.sort(key=lambda body: float(data.xpos[body][2]))
        found = {}
        for body in feet[:2]:
            side = "left" if data.xpos[body][1] > 0.0 else "right"
            joints = tuple(model.joint(joint).name for joint in chains[body][-LEG_JOINTS:])
            found[side] = FoundLeg(side, joints, model.body(body).name, self.sole(body))
        return found

    def sole(self, body: int) -> tuple[tuple[float, float, float], float, float]:
        """Return the rectangle around what touches the ground, in the foot's frame."""
        model, data = self.model, self.data
        rotation, origin = data.xmat[body].reshape(3, 3), data.xpos[body]
        boxes = []
        for geom in np.flatnonzero(model.geom_bodyid == body):
            if not model.geom_contype[geom] and not model.geom_conaffinity[geom]:
                continue
            turned = rotation.T @ data.geom_xmat[geom].reshape(3, 3)
            centre = rotation.T @ (data.geom_xpos[geom] - origin)
            centre = centre + turned @ model.geom_aabb[geom, :3]
            half = np.abs(turned) @ model.geom_aabb[geom, 3:]
            boxes.append((centre - half, centre + half))
        if not boxes:
            return (0.0, 0.0, 0.0), 0.0, 0.0
        bottom = min(float(low[2]) for low, _ in boxes)
        flat = [box for box in boxes if box[0][2] < bottom + SOLE_DEPTH_M]
        least = np.min([low for low, _ in flat], axis=0)
        most = np.max([high for _, high in flat], axis=0)
        middle = 0.5 * (least + most)
        size = most - least
        return (float(middle[0]), float(middle[1]), bottom), float(size[0]), float(size[1])

    def axis(self, joint: int) -> Floats:
        """Return a joint's axis (3,) in the root's frame at angles zero."""
        axis: Floats = self.data.xaxis[joint].copy()
        return axis

    def differences(self, left: tuple[str, ...], right: tuple[str, ...]) -> list[str]:
        """Return in which joints two legs are no mirror images: places, axes, ranges."""
        found = []
        for one, other in zip(left, right, strict=False):
            a, b = self.model.joint(one).id, self.model.joint(other).id
            apart = self.data.xanchor[a] * (1.0, -1.0, 1.0) - self.data.xanchor[b]
            # Along its own axis a joint may be anywhere.
            apart = apart - self.axis(b) * float(apart @ self.axis(b))
            if np.abs(apart).max() > ALIKE_M:
                found.append(f"{one} and {other}: {1e3 * np.abs(apart).max():.1f} mm apart")
            # A mirror turns rotations round: an axis keeps its y.
            along = float((self.axis(a) * (-1.0, 1.0, -1.0)) @ self.axis(b))
            if abs(along) < 1.0 - ALIKE_M:
                found.append(f"{one} and {other}: axes are not mirrored")
                continue
            low, high = (float(bound) for bound in self.model.jnt_range[a])
            wanted = (low, high) if along > 0.0 else (-high, -low)
            if not np.allclose(wanted, self.model.jnt_range[b], atol=ALIKE_RAD):
                found.append(f"{one} and {other}: ranges are not mirrored")
        return found

    def head_joints(self, camera_body: int) -> tuple[str | None, str | None]:
        """Return the joints above a camera that turn about the vertical and that nod."""
        pan = tilt = None
        for joint in self.chain(camera_body):
            axis = np.abs(self.axis(joint))
            if axis[2] > 0.9:
                pan = self.model.joint(joint).name
            elif axis[1] > 0.9:
                tilt = self.model.joint(joint).name
        return pan, tilt


def nameless(model: mujoco.MjModel) -> list[str]:
    """Return the links and joints that lack a name; only the joint of the root may."""
    links = [f"body {body}" for body in range(1, model.nbody) if not model.body(body).name]
    free = int(model.njnt > 0 and model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE)
    joints = [f"joint {j}" for j in range(free, model.njnt) if not model.joint(j).name]
    return links + joints
