"""What an MJCF says of its motors, and rules for what it does not say."""

from dataclasses import dataclass

import mujoco
import numpy as np

GRAVITY = 9.81
TORQUE_LEVER = 0.08
"""Lever of a leg's motor that bears the whole weight, m, for a leg of 0.25 m."""
ARM_SHARE = 0.25
"""What motors that are not a leg's have of that, where the model says nothing."""
REFERENCE_MASS_KG, REFERENCE_LEG_M = 7.0, 0.25
"""Of the robot for which the stiffnesses below are: others by mass times length."""
STIFF = 120.0
"""N m/rad, of its legs' servos."""
DAMPED = 0.02
"""Damping of a servo over its stiffness, s, at that size; longer by the root of the length."""
SOFT, STIFFEST = 0.8, 3.0
"""A leg's servo of the model counts where it has between these shares of the rule's stiffness."""
SOFT_ARM = 0.2
"""For the others the least share is this: they carry nothing."""
GIVES_RAD = 0.15
"""By how much other servos give way to their peak torque."""
SPEED = 8.0
"""No-load speed where nothing tells it, rad/s."""
STALL = 1.4
"""Torque at which the torque-speed line starts, over the peak, where nothing tells it."""
STEP_S = 0.002
MOST_DAMPING = 0.8
"""Of what a servo's damping could take from a free joint's speed in a physics step."""
LOSING = 0.1
"""A joint's damping above this share of its torque stands for the speed that the motor loses."""
SLOWEST = 4.0
"""No-load speed, rad/s, below which it stands for the servo's damping instead."""
OWN_DAMPING = 0.02
"""What is left of such a damping for the gear, over the torque, s/rad."""
STIFFEST_RAD = 0.03
"""No servo of a leg gives its peak torque for less than this."""
STEADY = 0.4
"""Stiffness times a physics step squared, over what a joint moves, is no more than this."""
SAME_FOR_ALL = 3.0
"""A control range that is alike on all joints, and so many times what the legs need, is a bound."""


@dataclass(frozen=True, slots=True)
class FoundMotor:
    """What is known of a joint's motor.

    Attributes:
        torque: peak, N m.
        torque_from: which attribute says so; "" where it is a guess.
        stiffness: of the model's position servo at the joint, N m/rad; None where there is none.
        stiffness_damping: of that servo, N m s/rad.
    """

    torque: float
    torque_from: str
    stiffness: float | None = None
    stiffness_damping: float = 0.0


@dataclass(frozen=True, slots=True)
class Servo:
    """What a motor and its servo are drafted as; SI units.

    Attributes:
        torque: peak, N m.
        stall: where the torque-speed line starts, N m.
        speed: where it ends, rad/s.
        kp: N m/rad.
        kv: N m s/rad.
        damping: of the joint, N m s/rad; None: the model's.
        armature: kg m²; None: the model's. Where that is so small that the servo would shake.
        said: what of it the model says.
    """

    torque: float
    stall: float
    speed: float
    kp: float
    kv: float
    damping: float | None
    armature: float | None
    said: str


def needed_torque(model: mujoco.MjModel, leg_m: float) -> float:
    """Return the torque that a leg's motor needs for this weight and length, N m."""
    mass = float(model.body_subtreemass[0])
    return TORQUE_LEVER * (leg_m / REFERENCE_LEG_M) * GRAVITY * mass


def find_motor(model: mujoco.MjModel, joint: int) -> FoundMotor:
    """Return what a model says of a joint's motor; a torque of 0 where it says none.

    The first of these counts: the joint's actuatorfrcrange, the actuator's forcerange times its
    gear, the ctrlrange of a torque motor times gain and gear. The ctrlrange of a position servo is
    an angle, and never counts.
    """
    torque, told = 0.0, ""
    if model.jnt_actfrclimited[joint]:
        torque, told = _largest(model.jnt_actfrcrange[joint]), "actuatorfrcrange"
    for number in range(model.nu):
        if not _drives(model, number, joint):
            continue
        gear, gain = (
            abs(float(model.actuator_gear[number, 0])),
            float(model.actuator_gainprm[number, 0]),
        )
        if not torque and model.actuator_forcelimited[number]:
            torque, told = gear * _largest(model.actuator_forcerange[number]), "forcerange"
        if model.actuator_biastype[number] == mujoco.mjtBias.mjBIAS_NONE:
            if not torque and model.actuator_ctrllimited[number]:
                torque = gear * abs(gain) * _largest(model.actuator_ctrlrange[number])
                told = "ctrlrange"
        elif model.actuator_biasprm[number, 1] < 0.0:
            kp, kv = (-float(model.actuator_biasprm[number, k]) * gear**2 for k in (1, 2))
            return FoundMotor(torque, told, kp, kv)
    return FoundMotor(torque, told)


def _largest(bounds: np.ndarray) -> float:
    return float(np.abs(bounds).max())


def _drives(model: mujoco.MjModel, number: int, joint: int) -> bool:
    kinds = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))
    on_joint = int(model.actuator_trntype[number]) in kinds
    return on_joint and int(model.actuator_trnid[number, 0]) == joint


class Fitting:
    """Drafts the servos of a model."""

    def __init__(self, model: mujoco.MjModel, leg_m: float) -> None:
        """Remember the robot's size.

        Args:
            model: the compiled model.
            leg_m: from the hip to the ground, m.
        """
        self._model = model
        self._needed = needed_torque(model, leg_m)
        self._scale = leg_m / REFERENCE_LEG_M
        mass = float(model.body_subtreemass[0])
        self._stiffer = mass / REFERENCE_MASS_KG * self._scale
        told = [find_motor(model, joint) for joint in range(1, model.njnt)]
        ranges = {motor.torque for motor in told if motor.torque_from == "ctrlrange"}
        self._bound = 0.0
        if len(ranges) == 1 and len({motor.torque_from for motor in told} - {""}) == 1:
            only = ranges.pop()
            self._bound = only if only > SAME_FOR_ALL * self._needed else 0.0

    @property
    def bound(self) -> float:
        """A control range of all joints that is no motor's torque, N m; 0 where there is none."""
        return self._bound

    def torque(self, joint: int, role: str | None) -> tuple[float, str]:
        """Return a motor's peak torque, N m, and what says so; "" where it is a guess."""
        found = find_motor(self._model, joint)
        if found.torque > 0.0 and found.torque != self._bound:
            return found.torque, found.torque_from
        share = ARM_SHARE if role is None else 1.0
        return float(f"{share * self._needed:.2g}"), ""

    def servo(self, joint: int, role: str | None, moved: float) -> Servo:
        """Return a draft of a joint's motor and servo.

        Args:
            joint: its number.
            role: what it, or the joint that it turns by a gear, does in a leg.
            moved: what it has to move while all other joints give way, kg m².
        """
        model, found = self._model, find_motor(self._model, joint)
        torque, told = self.torque(joint, role)
        said = [told] if told else []
        kp = torque / GIVES_RAD
        if role is not None:
            kp = min(STIFF * self._stiffer, torque / STIFFEST_RAD)
        kv = kp * DAMPED * self._scale**0.5
        least_share = SOFT_ARM if role is None else SOFT
        if found.stiffness is not None and least_share * kp <= found.stiffness <= STIFFEST * kp:
            kp, said = found.stiffness, [*said, "kp"]
            kv = max(found.stiffness_damping, 0.5 * kv)
        dof = int(model.jnt_dofadr[joint])
        armature = None
        least = kp * STEP_S**2 / STEADY
        if moved < least:
            armature = float(f"{float(model.dof_armature[dof]) + least - moved:.2g}")
        kv = min(kv, MOST_DAMPING * max(moved, least) / STEP_S)
        stall, speed, damping = STALL * torque, SPEED, None
        losing = float(model.dof_damping[dof])
        if losing > LOSING * torque:
            damping = float(f"{OWN_DAMPING * torque:.2g}")
            if torque / losing >= SLOWEST:
                stall, speed = torque, torque / losing
        return Servo(torque, stall, speed, kp, kv, damping, armature, " and ".join(said))
