"""Whether `[motors]` of a `robot.toml` fits its MJCF: a motor for whatever carries the robot."""

import math
from collections.abc import Iterable
from pathlib import Path
from typing import NoReturn

import mujoco

from treadwell.errors import InputError
from treadwell.robot.file import LegTable, RobotFile
from treadwell.robot.followers import followers
from treadwell.scenario.messages import nearest


class Lookup:
    """Looks up what `robot.toml` names in the model."""

    def __init__(self, toml: Path, mjcf: Path, model: mujoco.MjModel, file: RobotFile) -> None:
        self.toml, self.mjcf, self.model, self.file = toml, mjcf, model, file
        self.joints = {model.joint(i).name: i for i in range(1, model.njnt)}
        self.links = {model.body(i).name: i for i in range(1, model.nbody)}
        self.sites = {model.site(i).name: i for i in range(model.nsite)}
        self.sensors = {model.sensor(i).name: i for i in range(model.nsensor)}
        self.cameras = {model.camera(i).name: i for i in range(model.ncam)}

    def fail(self, key: str, message: str) -> NoReturn:
        """Raise an InputError that names the file and a key."""
        raise InputError(f"{self.toml}: {key}: {message}")

    def find(self, key: str, name: str, known: dict[str, int], kind: str) -> int:
        """Return the number of what a key names.

        Raises:
            InputError: there is nothing of that name.
        """
        if name not in known:
            self.fail(
                key,
                f"there is no {kind} {name!r} in {self.mjcf.name}; it has {listed(known)}"
                f"{nearest(name, known)}",
            )
        return known[name]


class _Motors(Lookup):
    """Checks the motors."""

    def check(self) -> None:
        model = self.model
        actuators: dict[int, int] = {}
        for i in range(model.nu):
            name, joint = model.actuator(i).name, int(model.actuator_trnid[i, 0])
            on_joint = model.actuator_trntype[i] == mujoco.mjtTrn.mjTRN_JOINT
            torque = (
                model.actuator_gaintype[i] == mujoco.mjtGain.mjGAIN_FIXED
                and model.actuator_biastype[i] == mujoco.mjtBias.mjBIAS_NONE
                and model.actuator_dyntype[i] == mujoco.mjtDyn.mjDYN_NONE
                and model.actuator_gainprm[i, 0] == 1.0
                and model.actuator_gear[i, 0] == 1.0
            )
            if not on_joint or not torque or joint in actuators:
                raise InputError(
                    f"{self.mjcf}: actuator {name!r} must be a <motor> of gear 1 on its own joint"
                )
            actuators[joint] = i
        groups: dict[str, str] = {}
        tied = followers(model)
        for group, motors in self.file.motors.items():
            for joint_name in motors.joints:
                key = f"motors.{group}.joints"
                joint = self.find(key, joint_name, self.joints, "joint")
                if joint_name in groups:
                    self.fail(key, f"joint {joint_name!r} is in motors.{groups[joint_name]} too")
                groups[joint_name] = group
                if joint in tied:
                    self.fail(key, f"joint {joint_name!r} has no motor of its own")
                if joint not in actuators:
                    raise InputError(f"{self.mjcf}: joint {joint_name!r} has no <motor>")
                low, high = model.actuator_ctrlrange[actuators[joint]]
                peak = motors.peak_torque
                limited = model.actuator_ctrllimited[actuators[joint]]
                if not limited or not (math.isclose(high, peak) and math.isclose(low, -peak)):
                    self.fail(
                        f"motors.{group}.peak_torque",
                        f"is {peak:g}, but the motor of {joint_name!r} in {self.mjcf.name} "
                        f"has a ctrlrange of {low:g} to {high:g}",
                    )
                self._check_bound(f"motors.{group}.peak_torque", joint, peak)
        missing = [name for name, joint in self.joints.items() if joint in actuators]
        missing = [name for name in missing if name not in groups]
        if missing:
            self.fail("motors", f"no group has the joints {listed(missing)}")
        self._check_carrying({*groups, *(self.model.joint(joint).name for joint in tied)})

    def _check_carrying(self, moved: set[str]) -> None:
        """Refuse a joint that carries the robot, or turns its camera, and that nothing moves."""
        file = self.file
        needed: dict[str, tuple[str | None, ...]] = {
            "head.pan": (file.head.pan,),
            "head.tilt": (file.head.tilt,),
        }
        needed |= {f"legs.{side}.joints": leg.joints for side, leg in legs_of(file)}
        for key, joints in needed.items():
            for joint in joints:
                if joint in self.joints and joint not in moved:
                    self.fail(
                        key,
                        f"joint {joint!r} is in no table of [motors], and no equality of "
                        f"{self.mjcf.name} ties it to one that is",
                    )
        held = self._held()
        for joint in file.trunk.joints:
            if joint in self.joints and joint not in moved and self.joints[joint] not in held:
                self.fail(
                    "trunk.joints",
                    f"joint {joint!r} carries the robot, but is in no table of [motors], and "
                    f"nothing in {self.mjcf.name} holds it",
                )

    def _held(self) -> set[int]:
        """Return the joints that tendons hold."""
        model, held = self.model, set()
        for wrap in range(model.nwrap):
            if model.wrap_type[wrap] == mujoco.mjtWrap.mjWRAP_JOINT:
                held.add(int(model.wrap_objid[wrap]))
        return held

    def _check_bound(self, key: str, joint: int, peak: float) -> None:
        """Refuse a torque that the model does not let its joint have."""
        model = self.model
        low, high = model.jnt_actfrcrange[joint]
        if model.jnt_actfrclimited[joint] and max(-low, high) < peak * (1.0 - 1e-9):
            self.fail(
                key,
                f"is {peak:g}, but joint {model.joint(joint).name!r} in {self.mjcf.name} has an "
                f"actuatorfrcrange of {low:g} to {high:g}",
            )


def check_motors(lookup: Lookup) -> None:
    """Check that every motor of `robot.toml` is one of the model's, and the other way round.

    Raises:
        InputError: they are not; or a joint that carries the robot is moved by nothing.
    """
    _Motors(lookup.toml, lookup.mjcf, lookup.model, lookup.file).check()


def legs_of(file: RobotFile) -> tuple[tuple[str, LegTable], tuple[str, LegTable]]:
    """Return both legs with their sides."""
    return (("left", file.legs.left), ("right", file.legs.right))


def listed(names: Iterable[str]) -> str:
    """Return names as a message lists them."""
    return ", ".join(names) or "none"
