"""What an MJCF shows of a robot without being told: its legs, and how alike they are."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.robot.joint_roles import KNEE, nearest_to_axes, roles
from treadwell.robot.soles import Sole, find_sole
from treadwell.robot.surfaces import cloud_of, solid_geoms

Floats = NDArray[np.float64]

LEG_JOINTS = (5, 7)
"""Fewest and most joints of a leg."""
LOW_SHARE = 0.05
"""Of the robot's height: what is this near to the ground is a foot."""
ALIKE_M = 1e-3
"""By how much the places of joints may differ from mirror images, m, and axes, as a cosine."""
ALIKE_RAD = 0.02
"""By how much ranges may: a NAO's published ones differ by 0.01."""
FORWARD = np.array([1.0, 0.0, 0.0])
"""Where a robot looks to in its root's frame."""


@dataclass(frozen=True, slots=True)
class FoundLeg:
    """A chain that ends in a foot.

    Attributes:
        side: "left" where it is at +y, else "right".
        joints: from the hip down.
        roles: what each joint does.
        foot: the last link that a joint moves.
        sole: what of it touches the ground.
    """

    side: str
    joints: tuple[str, ...]
    roles: tuple[str, ...]
    foot: str
    sole: Sole

    def joint(self, role: str) -> str | None:
        """Return the joint that does this, or None."""
        return dict(zip(self.roles, self.joints, strict=True)).get(role)


@dataclass(frozen=True, slots=True)
class Anatomy:
    """A model in a posture that shows its legs, the root upright at the origin.

    Attributes:
        model: compiled from the MJCF.
        data: all angles at zero, or where a range does not hold that, at the end that is nearest;
            if that shows no two feet, a keyframe that does.
        feet: numbers of the links that stand on the ground, from the left to the right.
    """

    model: mujoco.MjModel
    data: mujoco.MjData
    feet: tuple[int, ...] = field(default=())

    @staticmethod
    def of(model: mujoco.MjModel) -> "Anatomy":
        """Pose a model so that its legs are seen."""
        found = None
        for angles in _postures(model):
            data = posed_at(model, angles)
            anatomy = Anatomy(model, data, _feet(model, data))
            if anatomy.has_two_feet:
                return anatomy
            found = found or anatomy
        assert found is not None
        return found

    @property
    def has_two_feet(self) -> bool:
        """Whether two links stand on the ground, one on each side of the middle."""
        if len(self.feet) != 2:
            return False
        left, right = (float(self.data.xpos[foot][1]) for foot in self.feet)
        return left > right

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

    def links(self, body: int) -> list[int]:
        """Return the bodies from the root down to this one."""
        found = []
        while body > 0:
            found.append(body)
            body = int(self.model.body_parentid[body])
        return found[::-1]

    @property
    def pelvis(self) -> int:
        """The link that both legs hang on; the root where there are no two."""
        if len(self.feet) < 2:
            return 1
        chains = [self.links(foot) for foot in self.feet]
        shared = [b for b in chains[0] if all(b in chain for chain in chains)]
        return shared[-1] if shared else 1

    def leg_chain(self, foot: int) -> list[int]:
        """Return the hinges from the pelvis to a foot."""
        above = len(self.chain(self.pelvis))
        return self.chain(foot)[above:]

    def legs(self) -> dict[str, FoundLeg]:
        """Return the legs by their side; none where there are no two of five to seven hinges."""
        if not self.has_two_feet:
            return {}
        found = {}
        for side, foot in zip(("left", "right"), self.feet, strict=True):
            leg = self._leg(side, foot)
            if leg is None:
                return {}
            found[side] = leg
        if len(found["left"].joints) != len(found["right"].joints):
            return {}
        return found

    def _leg(self, side: str, foot: int) -> FoundLeg | None:
        joints = self.leg_chain(foot)
        names = tuple(self.model.joint(joint).name for joint in joints)
        if not LEG_JOINTS[0] <= len(joints) <= LEG_JOINTS[1] or not all(names):
            return None
        # What is fixed to the link that the last joint moves is one with it.
        link = int(self.model.jnt_bodyid[joints[-1]])
        name = self.model.body(link).name
        if not name:
            return None
        return FoundLeg(side, names, self.roles(names, link), name, self.sole(link))

    def roles(self, names: Sequence[str], foot: int) -> tuple[str, ...]:
        """Return what each joint of a leg does.

        Args:
            names: of its joints, from the hip down.
            foot: number of the link that its last joint moves.
        """
        joints = [self.model.joint(name).id for name in names]
        place = self.sole_place(foot, self.sole(foot))
        return tuple(roles(self.data, joints, place, FORWARD))

    def sole(self, body: int) -> Sole:
        """Return what of a foot touches the ground."""
        return find_sole(self.model, self.data, body, FORWARD)

    def sole_place(self, body: int, sole: Sole) -> Floats:
        """Return where a sole's centre is, (3,) m."""
        return place_of(self.data, body, sole)

    def hip(self, leg: FoundLeg) -> Floats:
        """Return where the axes above a leg's knee come nearest to each other, (3,) m."""
        above = [self.model.joint(name).id for name in leg.joints[: leg.roles.index(KNEE)]]
        return nearest_to_axes(self.data, above)

    def axis(self, joint: int) -> Floats:
        """Return a joint's axis (3,) in the root's frame."""
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


def place_of(data: mujoco.MjData, body: int, sole: Sole) -> Floats:
    """Return where the centre of a link's sole is in a posture, (3,) m."""
    place: Floats = data.xpos[body] + data.xmat[body].reshape(3, 3) @ sole.in_link
    return place


def nearest_to_zero(model: mujoco.MjModel) -> Floats:
    """Return (nq,) all joints at zero, or at the end of their range that is nearest to it."""
    qpos = np.array(model.qpos0)
    kinds = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))
    for joint in range(model.njnt):
        if int(model.jnt_type[joint]) in kinds:
            low, high = model.jnt_range[joint] if model.jnt_limited[joint] else (0.0, 0.0)
            qpos[model.jnt_qposadr[joint]] = min(max(0.0, low), high)
    return qpos


def posed_at(model: mujoco.MjModel, qpos: Floats) -> mujoco.MjData:
    """Return the places of all bodies at these positions, a free root upright at the origin."""
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    if model.njnt and model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE:
        data.qpos[:7] = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_camlight(model, data)
    return data


def nameless(model: mujoco.MjModel) -> list[str]:
    """Return the links and joints that lack a name; only the joint of the root may."""
    links = [f"body {body}" for body in range(1, model.nbody) if not model.body(body).name]
    free = int(model.njnt > 0 and model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE)
    joints = [f"joint {j}" for j in range(free, model.njnt) if not model.joint(j).name]
    return links + joints


def _postures(model: mujoco.MjModel) -> list[Floats]:
    keys = [np.array(model.key(number).qpos) for number in range(model.nkey)]
    return [nearest_to_zero(model), *keys]


def _feet(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[int, ...]:
    """Return the links whose shapes are lowest, the last of each chain, from left to right."""
    solid = solid_geoms(model)
    if not solid.any():
        return ()
    lowest, highest = np.full(model.nbody, np.inf), -np.inf
    for geom in np.flatnonzero(solid):
        points = cloud_of(model, data, [int(geom)]).lowest(np.array([0.0, 0.0, 1.0]))
        if len(points):
            body = int(model.body_weldid[model.geom_bodyid[geom]])
            lowest[body] = min(lowest[body], float(points[:, 2].min()))
            highest = max(highest, float(points[:, 2].max()))
    ground = float(lowest.min())
    near = ground + LOW_SHARE * (highest - ground)
    found = [body for body in range(1, model.nbody) if lowest[body] <= near]
    above = {int(model.body_parentid[body]) for body in found}
    while any(parent > 0 for parent in above):
        found = [body for body in found if body not in above]
        above = {int(model.body_parentid[parent]) for parent in above if parent > 0}
    return tuple(sorted(found, key=lambda body: -float(data.xpos[body][1])))
