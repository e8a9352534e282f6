"""What the legs of a robot can do: where their inverse kinematics reaches, and what joints bear."""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell._core import Legs
from treadwell.robot.file import LegTable
from treadwell.robot.load import Robot
from treadwell.robot.step_blocks import TREAD_M, Steps, add_steps

Floats = NDArray[np.float64]

TRANSFER = 0.75
"""How far the weight has gone to the foot ahead when the one behind lifts off."""
MOST_TORQUE = 0.9
"""Of the peak: the rest is for balance."""
HIGHEST_M, RISE_STEP_M = 0.12, 0.005
FARTHEST_M, REACH_STEP_M = 0.4, 0.005
"""What is tried, and how finely, of a robot as large as `qrio`."""
MOST_TURN_RAD, TURN_STEP_RAD = 1.5, 0.05
END_RAD = 1e-3
"""How near a joint is to the end of its range that is there."""
LOWERING_M = 0.002
"""Steps in which the hips of such a robot are lowered until both soles are reached."""
LOWEST_SHARE = 0.4
"""The hips are lowered to this share of their height at most."""


@dataclass(frozen=True, slots=True)
class Rise:
    """A step up or down, both soles on the ground, all the weight on the leg that lifts or lowers.

    Attributes:
        height_m: of the step; below zero: down.
        reached: whether both soles get there, and a foot over the edge.
        hips_m: how high the hips are over the sole that carries, m.
        torque_share: the largest share of a motor's peak torque that holding still takes.
        joint: the joint that bears it.
        knee_torque_nm: what the knee bears.
        touches: a link other than a foot that would touch a step, or None.
        ended: a joint that comes to its end where the soles do not get there, or None.
    """

    height_m: float
    reached: bool
    hips_m: float
    torque_share: float
    joint: str
    knee_torque_nm: float
    touches: str | None = None
    ended: str | None = None

    @property
    def possible(self) -> bool:
        """Whether the legs reach, nothing touches, and the motors hold."""
        return self.reached and self.touches is None and self.torque_share <= MOST_TORQUE


def what_ends(rise: Rise) -> str | None:
    """Say why a step is not possible; None where it is."""
    if rise.possible:
        return None
    if not rise.reached:
        return "the legs do not reach" + (f": {rise.ended}" if rise.ended else "")
    if rise.touches is not None:
        return f"{rise.touches} touches a step"
    share = rise.torque_share
    needs = (
        f"{share:.3g} times its peak torque"
        if share > 1.0
        else f"{100 * share:.3g} % of its peak torque, of which {100 * MOST_TORQUE:g} % may be used"
    )
    return f"the {rise.joint} needs {needs}"


class Reach:
    """Tries postures of a robot's legs: statics alone, nothing moves.

    Attributes:
        gait: `[gait]` with its defaults.
        legs: the inverse kinematics of both legs.
    """

    def __init__(self, robot: Robot) -> None:
        """Read the legs.

        Raises:
            InputError: the legs are no chains that end at the soles, or the gait a bad setting.
        """
        self._robot = robot
        self._scale = robot.scale
        self.legs = Legs(json.dumps(robot.description()))
        self.gait: dict[str, float] = json.loads(self.legs.gait_json)
        spec = robot.spec()
        steps = add_steps(spec)
        self._model = spec.compile()
        self._steps = Steps(self._model, robot, steps)
        self._model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        self._data = mujoco.MjData(self._model)
        self._hip_m = float(self.legs.lengths("left")[0][2])
        self._width_m = self.gait["stance_width"]
        self._missed: set[str] = set()
        self._ended: str | None = None

    def longest_step_m(self) -> float:
        """Return the longest step forward that keeps the hips at the gait's height, m."""
        half = 0.5 * self._width_m
        return _greatest(
            lambda x: self._level([(x / 2, half, 0.0), (-x / 2, -half, 0.0)]),
            FARTHEST_M * self._scale,
            REACH_STEP_M * self._scale,
        )

    def widest_step_m(self) -> float:
        """Return by how much the feet may be farther apart than side by side, m."""

        def reached(extra: float) -> bool:
            half = 0.5 * (self._width_m + extra)
            return self._level([(0.0, half, 0.0), (0.0, -half, 0.0)])

        return _greatest(reached, FARTHEST_M * self._scale, REACH_STEP_M * self._scale)

    def largest_turn_rad(self) -> float:
        """Return by how much one foot may be turned outwards against the other, rad."""
        half = 0.5 * self._width_m
        soles = [(0.0, half, 0.0), (0.0, -half, 0.0)]
        return _greatest(
            lambda turn: self._level(soles, (turn / 2, -turn / 2)), MOST_TURN_RAD, TURN_STEP_RAD
        )

    def rises(self, direction: float) -> list[Rise]:
        """Return steps up (1) or down (-1), ever higher, to the first that is not possible."""
        found = []
        for number in range(1, round(HIGHEST_M / RISE_STEP_M) + 1):
            found.append(self.rise(direction * number * RISE_STEP_M * self._scale))
            if not found[-1].possible:
                break
        return found

    def rise(self, height_m: float) -> Rise:
        """Try one step: the left foot is on it, a tread ahead; the right one behind.

        Up, the left leg lifts the body until the right foot comes free; down, the right leg lowers
        it until the left foot stands.
        """
        half = 0.5 * self._width_m
        soles = [(TREAD_M * self._scale, half, height_m), (0.0, -half, 0.0)]
        carries = 0 if height_m > 0.0 else 1
        over = self._over(soles, carries)
        # Who walks has not come all the way when the foot behind lifts off, and has set out for the
        # foot ahead when that one lands.
        behind, ahead = self._over(soles, 1), self._over(soles, 0)
        lifting = behind + (TRANSFER if carries == 0 else 1.0 - TRANSFER) * (ahead - behind)
        hips = self._lowered(soles, lifting, soles[carries][2])
        if hips is None:
            return Rise(height_m, False, math.nan, math.nan, "", math.nan, ended=self._ended)
        self._steps.place(self._data, height_m)
        self._pose(soles, lifting, hips)
        touches = self._steps.touched(self._data)
        reached = self._swings(soles, height_m)
        ended = None if reached else self._ended
        self._pose(soles, over, hips)
        touches = touches or self._steps.touched(self._data)
        shares = self._shares(carries, over)
        joint = max(shares, key=lambda name: shares[name][0])
        leg = (self._robot.file.legs.left, self._robot.file.legs.right)[carries]
        return Rise(
            height_m,
            reached,
            hips - soles[carries][2],
            shares[joint][0],
            joint,
            shares[self._robot.upright.knee(leg)][1],
            touches,
            ended,
        )

    def _over(self, soles: list[tuple[float, float, float]], carries: int) -> Floats:
        """Return where the weight is when one foot carries it all, (x, y)."""
        sign = 1.0 - 2.0 * carries
        (x, y, z), goes = soles[carries], ("right", "left")[carries]
        to_x, to_y, to_z = soles[1 - carries]
        ahead = self.legs.carries_ahead(goes, (to_x - x, to_y - y, to_z - z))
        return np.array([x + ahead, y - sign * self.gait["support_inward"]])

    def _swings(self, soles: list[tuple[float, float, float]], height_m: float) -> bool:
        """Whether the left foot gets there from beside the right one, which carries."""
        over = self._over(soles, 1)
        hips = self._lowered(soles, over, 0.0)
        if hips is None:
            return False
        (x, y, _), right = soles[0], soles[1]
        lifted = max(height_m, 0.0) + self.gait["climb_clearance"]
        return all(
            self._pose([(share * x, y, lifted), right], over, hips) or self._clears(height_m)
            for share in (0.0, 0.5, 1.0)
        )

    def _clears(self, height_m: float) -> bool:
        """Whether the left sole, as it lies where its ankle came to an end, is over both levels."""
        if "right" in self._missed:
            return False
        sole = self._robot.file.legs.left.sole
        link = self._model.body(sole.link).id
        up = self._data.xmat[link].reshape(3, 3)[2]
        middle = float(self._data.xpos[link][2] + up @ np.array(sole.position))
        lowest = middle - 0.5 * (abs(float(up[0])) * sole.length + abs(float(up[1])) * sole.width)
        return lowest > max(height_m, 0.0)

    def _level(
        self, soles: list[tuple[float, float, float]], yaws: tuple[float, float] = (0.0, 0.0)
    ) -> bool:
        """Whether both soles are reached, the weight between them, the hips at their height."""
        middle = np.array(soles)[:, :2].mean(axis=0)
        return self._pose(soles, middle, self.gait["hip_height"], yaws)

    def _lowered(
        self, soles: list[tuple[float, float, float]], over: Floats, ground_m: float
    ) -> float | None:
        """Return the greatest height of the hips at which both soles are reached, or None."""
        full = self.gait["hip_height"]
        lowering = LOWERING_M * self._scale
        for number in range(int((1.0 - LOWEST_SHARE) * full / lowering)):
            hips = ground_m + full - number * lowering
            if self._pose(soles, over, hips):
                return hips
        return None

    def _pose(
        self,
        soles: list[tuple[float, float, float]],
        over: Floats,
        hips_m: float,
        yaws: tuple[float, float] = (0.0, 0.0),
    ) -> bool:
        """Pose the model: soles there, upright, centre of mass `over`; whether all is reached."""
        model, data, robot = self._model, self._data, self._robot
        root = np.array([0.0, 0.0, hips_m - self._hip_m])
        data.qpos[:] = robot.stand_qpos
        for _ in range(3):
            data.qpos[:3], data.qpos[3:7] = root, (1.0, 0.0, 0.0, 0.0)
            mujoco.mj_kinematics(model, data)
            mujoco.mj_comPos(model, data)
            root[:2] = over - (data.subtree_com[1][:2] - data.qpos[:2])
            self._missed = set()
            legs = (robot.file.legs.left, robot.file.legs.right)
            for side, leg, sole, yaw in zip(("left", "right"), legs, soles, yaws, strict=True):
                x, y, z = (float(value) for value in np.array(sole) - root)
                angles, found = self.legs.solve(side, (x, y, z), yaw)
                if not found:
                    self._missed.add(side)
                    self._ended = self._at_end(leg, angles)
                for joint, angle in zip(leg.joints, angles, strict=True):
                    data.qpos[model.joint(joint).qposadr[0]] = angle
        data.qpos[:3] = root
        mujoco.mj_kinematics(model, data)
        return not self._missed

    def _at_end(self, leg: LegTable, angles: Floats) -> str | None:
        """Return a joint of a leg that is at the end of its range, the lowest of them; or None."""
        for name, angle in zip(reversed(leg.joints), angles[::-1], strict=True):
            low, high = self._model.joint(name).range
            if not low + END_RAD < angle < high - END_RAD:
                return f"{name} ends at {low if angle < 0.5 * (low + high) else high:.2f} rad"
        return None

    def _shares(self, carries: int, over: Floats) -> dict[str, tuple[float, float]]:
        """Return (share of the peak, N·m) of the leg's joints, all the weight on one sole."""
        model, data, robot = self._model, self._data, self._robot
        leg = (robot.file.legs.left, robot.file.legs.right)[carries]
        data.qvel[:] = 0.0
        mujoco.mj_forward(model, data)
        link = model.body(leg.sole.link).id
        sole = data.xpos[link] + data.xmat[link].reshape(3, 3) @ np.array(leg.sole.position)
        jacobian = np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, jacobian, None, np.array([*over, sole[2]]), link)
        weight = float(model.body_subtreemass[1]) * -float(model.opt.gravity[2])
        torques = data.qfrc_bias - weight * jacobian[2]
        shares = {}
        for name in leg.joints:
            order = robot.joints.index(name)
            torque = float(torques[model.joint(name).dofadr[0]])
            shares[name] = (abs(torque) / float(robot.limits.peak_torque[order]), abs(torque))
        return shares


def _greatest(holds: Callable[[float], bool], most: float, step: float) -> float:
    """Return the greatest multiple of a step up to which all hold."""
    number = 0
    while (number + 1) * step <= most and holds((number + 1) * step):
        number += 1
    return number * step
