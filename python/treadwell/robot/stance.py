"""A stance for walking: on bent knees, the soles level and under the centre of mass, arms down."""

from collections.abc import Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.robot.anatomy import FORWARD, Anatomy, FoundLeg, nearest_to_zero, place_of
from treadwell.robot.bearing import load_on
from treadwell.robot.joint_roles import ANKLE_PITCH, HIP_PITCH, HIP_YAW, KNEE

Floats = NDArray[np.float64]

KNEE_RADS = (1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4)
"""Bends of the knees in the stance: the first that the motors of hip and knee bear easily."""
EASY_SHARE = 0.5
"""Of the peak torque, on one leg."""
LIFTED = 0.1
"""How high a sole can be lifted at least, level and straight up, over the length of the leg."""
WIDTH_SHARE = 0.34
"""Distance of the feet of `qrio` over the length of its legs."""
WIDE = 1.2
"""Feet so many times as far apart as that, and as the hips, are brought together."""
ALL_SIX = 6
"""Joints of a leg that puts its sole anywhere and level: with fewer, it is where it is."""
ROUNDED = 5
LEAST_RAD = 1e-5
ROUNDS, STEPS = 6, 30
SLOPE_RAD = 1e-4
DAMPED = 1e-8
MARGIN_RAD = 0.02
"""How far the stance keeps from the ends of ranges where it can."""
REACHED = 5e-4
"""A sole that is nearer to its place than this, m, and to level, rad, is there."""


class Stance:
    """Looks for the stance of a model.

    Attributes:
        missed: for each side how far the sole is from where it should be, m and rad together.
    """

    def __init__(self, anatomy: Anatomy, legs: Mapping[str, FoundLeg]) -> None:
        """Begin with all joints at zero, or as near to it as their ranges go."""
        self._anatomy, self._model, self._legs = anatomy, anatomy.model, legs
        self._zero = nearest_to_zero(anatomy.model)
        if anatomy.model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE:
            self._zero[:7] = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
        self.missed: dict[str, float] = {}

    def angles(self, peaks: Mapping[str, float], others: Mapping[str, float]) -> dict[str, float]:
        """Return the angles of all joints that are not as near to zero as they can be, rad.

        Args:
            peaks: peak torques of the legs' joints, N m.
            others: angles of joints that are no leg's.
        """
        chosen: Floats | None = None
        for knee in KNEE_RADS:
            data = self._bent(knee, others)
            worst = max(
                load for leg in self._legs.values() for load in self._shares(data, leg, peaks)
            )
            chosen = data.qpos.copy()
            if worst <= EASY_SHARE and self._has_room(data):
                break
        assert chosen is not None
        model, found = self._model, {}
        for joint in range(1, model.njnt):
            at = int(model.jnt_qposadr[joint])
            # What is not said is at zero, or at the end of its range that is nearest to it.
            if abs(float(chosen[at] - self._zero[at])) > LEAST_RAD:
                angle = round(float(chosen[at]), ROUNDED)
                if model.jnt_limited[joint]:
                    low, high = (float(bound) for bound in model.jnt_range[joint])
                    angle = min(max(angle, low), high)
                found[model.joint(joint).name] = angle
        return found

    def _has_room(self, data: mujoco.MjData) -> bool:
        """Whether both soles are where they should be, and each can be lifted from there, level."""
        if max(self.missed.values()) > REACHED:
            return False
        model, lifted = self._model, mujoco.MjData(self._model)
        for leg in self._legs.values():
            lifted.qpos[:] = data.qpos
            _place(model, lifted)
            sole, hip = place_of(lifted, self._link(leg), leg.sole), self._anatomy.hip(leg)
            length = float(hip[2] - self._anatomy.sole_place(self._link(leg), leg.sole)[2])
            above = sole + np.array((0.0, 0.0, LIFTED * length))
            if self._reach(lifted, leg, above) > REACHED:
                return False
        return True

    def _shares(
        self, data: mujoco.MjData, leg: FoundLeg, peaks: Mapping[str, float]
    ) -> list[float]:
        copy = mujoco.MjData(self._model)
        copy.qpos[:] = data.qpos
        sole = (leg.foot, leg.sole.in_link)
        # What an ankle bears, no bend of the knee changes.
        bend = [joint for role in (HIP_PITCH, KNEE) if (joint := leg.joint(role)) is not None]
        return [load.share for load in load_on(self._model, copy, bend, sole, peaks)]

    def _bent(self, knee: float, others: Mapping[str, float]) -> mujoco.MjData:
        """Return the posture with knees bent so far."""
        model, data = self._model, mujoco.MjData(self._model)
        data.qpos[:] = self._zero
        for name, angle in others.items():
            data.qpos[model.joint(name).qposadr[0]] = angle
        for leg in self._legs.values():
            self._bend(data, leg, knee)
        for _ in range(ROUNDS):
            _place(model, data)
            ahead = float(data.subtree_com[0][0])
            heights = [
                float(place_of(data, self._link(leg), leg.sole)[2]) for leg in self._legs.values()
            ]
            for side, leg in self._legs.items():
                target = np.array([ahead, self._aside(data, leg), sum(heights) / len(heights)])
                self.missed[side] = self._reach(data, leg, target)
        return data

    def _aside(self, data: mujoco.MjData, leg: FoundLeg) -> float:
        """Return where to the side a sole is to be, m: where it is, but not too far."""
        place = float(place_of(data, self._link(leg), leg.sole)[1])
        if len(leg.joints) < ALL_SIX:
            return place
        hip, sole = self._anatomy.hip(leg), self._anatomy.sole_place(self._link(leg), leg.sole)
        widest = max(abs(float(hip[1])), 0.5 * WIDTH_SHARE * float(hip[2] - sole[2]))
        return place if abs(place) <= WIDE * widest else float(np.copysign(widest, place))

    def _link(self, leg: FoundLeg) -> int:
        return int(self._model.body(leg.foot).id)

    def _bend(self, data: mujoco.MjData, leg: FoundLeg, bend: float) -> None:
        """Bend a knee forwards, and turn hip and ankle against it by half."""
        model, signs = self._model, {}
        _place(model, data)
        across = np.cross([0.0, 0.0, 1.0], FORWARD)
        for role in (HIP_PITCH, KNEE, ANKLE_PITCH):
            name = leg.joint(role)
            if name is not None:
                joint = model.joint(name).id
                signs[role] = (joint, float(np.sign(data.xaxis[joint] @ across)))
        for role, share in ((KNEE, 1.0), (HIP_PITCH, -0.5), (ANKLE_PITCH, -0.5)):
            if role in signs:
                joint, sign = signs[role]
                at = int(model.jnt_qposadr[joint])
                # Where a shin leans at zero, the knee counts from where it is.
                data.qpos[at] = _within(model, joint, float(data.qpos[at]) + share * sign * bend)

    def _reach(self, data: mujoco.MjData, leg: FoundLeg, target: Floats) -> float:
        """Bring a sole to a place, level and ahead, by damped Newton steps; return what is left."""
        model, link = self._model, self._link(leg)
        joints = [model.joint(name).id for name in leg.joints]
        dofs = [int(model.jnt_dofadr[joint]) for joint in joints]
        turns = leg.joint(HIP_YAW) is not None and len(joints) > 5
        left = np.inf
        for _ in range(STEPS):
            _place(model, data)
            place = place_of(data, link, leg.sole)
            error = np.concatenate([target - place, _turn_to_level(data, link, leg, turns)])
            left = float(np.abs(error).max())
            if left < 1e-9:
                break
            ahead, turn = np.zeros((3, model.nv)), np.zeros((3, model.nv))
            mujoco.mj_jac(model, data, ahead, turn, place, link)
            rows = np.concatenate([ahead[:, dofs], turn[:, dofs][: 3 if turns else 2]])
            step = rows.T @ np.linalg.solve(rows @ rows.T + DAMPED * np.eye(len(rows)), error)
            step *= min(1.0, 0.3 / max(float(np.abs(step).max()), 1e-12))
            for joint, by in zip(joints, step, strict=True):
                at = int(model.jnt_qposadr[joint])
                data.qpos[at] = _within(model, joint, float(data.qpos[at] + by))
        _place(model, data)
        return left


def _place(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)


def _within(model: mujoco.MjModel, joint: int, angle: float) -> float:
    if not model.jnt_limited[joint]:
        return angle
    low, high = (float(bound) for bound in model.jnt_range[joint])
    margin = min(MARGIN_RAD, 0.25 * (high - low))
    return min(max(angle, low + margin if low < -margin else low), high - margin)


def _turn_to_level(data: mujoco.MjData, link: int, leg: FoundLeg, turns: bool) -> Floats:
    """Return about which vector a sole has to be turned, rad: (x, y), and z where it can."""
    rotation = data.xmat[link].reshape(3, 3)
    if leg.sole.orientation is not None:
        turn = np.empty(9)
        mujoco.mju_quat2Mat(turn, np.array(leg.sole.orientation))
        rotation = rotation @ turn.reshape(3, 3)
    level = np.cross(rotation[:, 2], [0.0, 0.0, 1.0])
    yaw = float(np.cross(rotation[:, 0], FORWARD)[2])
    return np.array([level[0], level[1], yaw]) if turns else level[:2]
