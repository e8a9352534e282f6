"""`[motors]` of a drafted `robot.toml`: groups of joints whose motors are drafted alike."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.robot.anatomy import Anatomy, FoundLeg, place_of
from treadwell.robot.calm_servos import calmed
from treadwell.robot.joint_roles import ANKLE_PITCH, HIP_PITCH, KNEE
from treadwell.robot.loops import drivers, ties_of
from treadwell.robot.motors_found import ARM_SHARE, REFERENCE_MASS_KG, Fitting, Servo

REFERENCE_ANKLE = 80.0
"""Stiffness of the ankles for which the gait's `ankle_gain` is, N m/rad."""
REFERENCE_SPEED = 8.0
"""No-load speed of the legs for which its climbing speeds are, rad/s."""
ANKLE_GAIN, CLIMB_SPEED, CLIMB_LIFT_SPEED = 30.0, 0.195, 0.172
"""The gait's defaults for a scale of 1."""
SLOW = 0.9
"""Motors that are no slower than this share of that climb as the defaults do."""
TRUNK = "trunk"
CAMERA_MOTORS = """[motors.camera]                 # of the unit that turns the camera
joints = ["camera_pan", "camera_tilt"]
peak_torque = 2.0
no_load_speed = 8.0
kp = 20.0
kv = 0.4
"""


def size_of(anatomy: Anatomy, legs: Mapping[str, FoundLeg]) -> float:
    """Return how high the hips' centres are over the soles at angles zero, m."""
    heights = []
    for leg in legs.values():
        sole = place_of(anatomy.data, anatomy.model.body(leg.foot).id, leg.sole)
        heights.append(float(anatomy.hip(leg)[2] - sole[2]))
    return sum(heights) / len(heights)


def motor_roles(
    model: mujoco.MjModel, legs: Mapping[str, FoundLeg], trunk: Sequence[str] = ()
) -> dict[int, str]:
    """Return what the motors that carry the robot do, by the joint that has the motor.

    Args:
        model: the compiled model.
        legs: both.
        trunk: joints between pelvis and torso: `TRUNK`; so are those that a tendon couples to them.
    """
    tied = ties_of(model)
    names = {name: TRUNK for name in trunk}
    for leg in legs.values():
        names |= dict(zip(leg.joints, leg.roles, strict=True))
    roles = {}
    for name, role in names.items():
        joint = int(model.joint(name).id)
        roles[tied[joint].leader if joint in tied else joint] = role
        for coupled in _coupled(model, joint):
            roles.setdefault(coupled, role)
    return roles


def _coupled(model: mujoco.MjModel, joint: int) -> set[int]:
    """Return the joints that share a tendon with a joint."""
    found: set[int] = set()
    for tendon in range(model.ntendon):
        first = int(model.tendon_adr[tendon])
        wraps = range(first, first + int(model.tendon_num[tendon]))
        kind = mujoco.mjtWrap.mjWRAP_JOINT
        joints = {int(model.wrap_objid[w]) for w in wraps if model.wrap_type[w] == kind}
        if joint in joints:
            found |= joints - {joint}
    return found


def peaks_of(
    legs: Mapping[str, FoundLeg], model: mujoco.MjModel, fitting: Fitting
) -> dict[str, float]:
    """Return the peak torques at the joints of the legs, N m, by joint."""
    tied, roles, peaks = ties_of(model), motor_roles(model, legs), {}
    for leg in legs.values():
        for name in leg.joints:
            joint = int(model.joint(name).id)
            motor = tied[joint].leader if joint in tied else joint
            ratio = abs(tied[joint].ratio) if joint in tied else 1.0
            peaks[name] = fitting.torque(motor, roles.get(motor))[0] / max(ratio, 1e-6)
    return peaks


def gait_of(
    fitting: Fitting, motors: Mapping[str, int], mass_kg: float, scale: float
) -> dict[str, float]:
    """Return settings of the gait that follow from the servos, and not from the size alone.

    How fast an ankle yields to where the ground presses: by how far that moves for an angle. How
    fast feet are put on steps: no faster than the legs' motors turn.

    Args:
        fitting: drafts one motor.
        motors: the joints with the motors of a leg, by what they do.
        mass_kg: of the robot.
        scale: of the robot.
    """
    found = {}
    if ANKLE_PITCH in motors:
        ankle = fitting.servo(motors[ANKLE_PITCH], ANKLE_PITCH, 1.0)
        stiffer = ankle.kp / REFERENCE_ANKLE / (mass_kg / REFERENCE_MASS_KG)
        found["ankle_gain"] = ANKLE_GAIN / stiffer / scale**0.5
    bending = [role for role in (HIP_PITCH, KNEE) if role in motors]
    slowest = min(fitting.servo(motors[role], role, 1.0).speed for role in bending)
    slower = slowest * scale**0.5 / REFERENCE_SPEED
    if slower < SLOW:
        found["climb_speed"] = CLIMB_SPEED * slower * scale**0.5
        found["climb_lift_speed"] = CLIMB_LIFT_SPEED * slower * scale**0.5
    return found


def moved_by(model: mujoco.MjModel, joint: int) -> float:
    """Return what a joint has to move while all others are free to give way, kg m²."""
    return 1.0 / max(float(model.dof_invweight0[model.jnt_dofadr[joint]]), 1e-9)


def draft_motors(
    model: mujoco.MjModel,
    qpos: NDArray[np.float64],
    legs: Mapping[str, FoundLeg],
    trunk: Sequence[str],
    fitting: Fitting,
    camera: bool,
) -> str:
    """Return the tables of all motors.

    Args:
        model: the compiled model.
        qpos: (nq,) the stance.
        legs: both.
        trunk: joints between pelvis and torso.
        fitting: drafts one motor.
        camera: whether the camera gets a unit of its own that turns it.
    """
    roles, tied = motor_roles(model, legs, trunk), ties_of(model)
    servos: dict[int, Servo] = {}
    for joint in sorted(drivers(model)):
        moved = moved_by(model, joint)
        for follower, tie in tied.items():
            if tie.leader == joint:
                moved += tie.ratio**2 * moved_by(model, follower)
        servos[joint] = fitting.servo(joint, roles.get(joint), moved)
    dampings = calmed(
        model,
        qpos,
        {joint: servo.kv for joint, servo in servos.items()},
        {joint: servo.armature for joint, servo in servos.items() if servo.armature is not None},
    )
    groups: dict[tuple[str, Servo], list[str]] = {}
    for joint, servo in servos.items():
        rounded = _rounded(replace(servo, kv=dampings[joint]))
        groups.setdefault((_part(roles.get(joint)), rounded), []).append(model.joint(joint).name)
    text = _heading(fitting, model)
    counts: dict[str, int] = {}
    for (part, servo), names in groups.items():
        counts[part] = counts.get(part, 0) + 1
        text += _group(f"{part}{counts[part]}", names, servo)
    return text + (CAMERA_MOTORS if camera else "")


def _part(role: str | None) -> str:
    """Return the word by which a group of motors begins."""
    if role is None:
        return "other"
    return TRUNK if role == TRUNK else "leg"


def _rounded(servo: Servo) -> Servo:
    """Return a servo with two digits of what was guessed: alike is what differs by less."""
    return replace(
        servo,
        torque=_digits(servo.torque, 3),
        stall=_digits(servo.stall, 3),
        speed=_digits(servo.speed, 2),
        kp=_digits(servo.kp, 2),
        kv=_digits(servo.kv, 2),
    )


def _digits(value: float, count: int) -> float:
    return float(f"{value:.{count}g}")


def _heading(fitting: Fitting, model: mujoco.MjModel) -> str:
    mass = float(model.body_subtreemass[0])
    lines = [
        "",
        "# Motors. What the model says of a group stands behind its name; the rest are guesses:",
        f"# torques by what such legs need under {mass:.1f} kg, elsewhere {ARM_SHARE:g} of",
        "# that; stiffness by mass and length; speeds as common servos have them. Put in the data",
        "# sheet's figures where you know them.",
    ]
    if fitting.bound:
        lines.append(
            f"# The model bounds all controls by {fitting.bound:g}: that is no motor's torque."
        )
    return "\n".join(lines) + "\n"


def _group(name: str, names: list[str], servo: Servo) -> str:
    said = f"by the model: {servo.said}" if servo.said else "the model says nothing of it: a guess"
    lines = [
        f"[motors.{name}]".ljust(32) + f"# {said}",
        f"joints = [{', '.join(json.dumps(joint, ensure_ascii=False) for joint in names)}]",
        f"peak_torque = {servo.torque:g}",
    ]
    if servo.stall > servo.torque:
        lines.append(f"stall_torque = {servo.stall:g}")
    lines += [f"no_load_speed = {servo.speed:g}", f"kp = {servo.kp:g}", f"kv = {servo.kv:g}"]
    if servo.damping is not None:
        lines.append(
            f"damping = {servo.damping:g}".ljust(32)
            + "# the model's stands for a servo or its speed limit"
        )
    if servo.armature is not None:
        lines.append(
            f"armature = {servo.armature:g}".ljust(32)
            + "# with the model's, such a servo would shake"
        )
    return "\n".join(lines) + "\n"
