"""A robot's folder, loaded and checked: its MJCF, its `robot.toml`, and what follows from both."""

import difflib
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.data import data_folder
from treadwell.data import robot_names as robot_names
from treadwell.errors import InputError
from treadwell.mjcf.build import check_builds, compiled, read_spec
from treadwell.mjcf.xml import check_xml
from treadwell.robot.additions import complete, prepare
from treadwell.robot.check import check_robot
from treadwell.robot.description import describe
from treadwell.robot.file import MotorsTable, RobotFile
from treadwell.robot.followers import Tie, ties
from treadwell.robot.keyframes import STAND
from treadwell.robot.motor_limits import MotorLimits, rotors
from treadwell.robot.reading import read_robot_file
from treadwell.robot.size import Upright, scale_of, with_size
from treadwell.scenario.messages import shortened

MOST_FILES = 2000
LARGEST_FOLDER = 500 << 20
"""Files of a robot's folder, and their bytes."""
NO_MOTOR = MotorsTable.model_construct(
    joints=(), peak_torque=0.0, stall_torque=None, no_load_speed=1.0, kp=0.0, kv=0.0
)
"""Of a joint that only what is around it turns."""


@dataclass(frozen=True, eq=False)
class Robot:
    """A robot that fits its own files.

    Arrays over joints are in joint order: that of the tree, depth first, as MuJoCo numbers them.

    Attributes:
        name: the folder's name.
        folder: where its files are.
        file: the parsed `robot.toml`.
        nominal: the compiled MJCF with what `robot.toml` adds, alone in an empty world. Not to be
            changed.
    """

    name: str
    folder: Path
    file: RobotFile
    nominal: mujoco.MjModel

    def spec(self) -> mujoco.MjSpec:
        """Return a fresh specification of the robot, to which a course can be added.

        Its keyframes are left out: they would not fit a model with more joints. It has the
        harness's time step, and its joints are without friction: the servos have it, since in the
        solver it takes a third of the time.
        """
        path = self.folder / self.file.robot.model
        spec = read_spec(path, str(path))
        complete(spec, self.file, self.folder / "robot.toml")
        for key in list(spec.keys):
            spec.delete(key)
        prepare(spec)
        return spec

    @cached_property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints in joint order."""
        return tuple(self.nominal.joint(i).name for i in range(1, self.nominal.njnt))

    @cached_property
    def base(self) -> str:
        """Name of the free joint."""
        return str(self.nominal.joint(0).name)

    @cached_property
    def root(self) -> str:
        """Name of the root link, the one that the free joint moves."""
        return str(self.nominal.body(1).name)

    @cached_property
    def actuators(self) -> tuple[str, ...]:
        """Names of the motors' actuators, in the order of the joints that have one."""
        of_joint = {int(self.nominal.actuator_trnid[i, 0]): i for i in range(self.nominal.nu)}
        return tuple(self.nominal.actuator(of_joint[joint]).name for joint in sorted(of_joint))

    @cached_property
    def ties(self) -> dict[int, Tie]:
        """How each joint without a motor follows the one whose motor turns it, in joint order."""
        return {
            follower - 1: tie._replace(leader=tie.leader - 1)
            for follower, tie in ties(self.nominal).items()
        }

    @cached_property
    def driven(self) -> tuple[int, ...]:
        """The joints that have a motor of their own, in joint order."""
        motors = self.nominal.actuator_trnid[: self.nominal.nu, 0]
        return tuple(sorted(int(joint) - 1 for joint in motors))

    @cached_property
    def stand_qpos(self) -> NDArray[np.float64]:
        """(7 + n,) m, wxyz and rad: the robot's generalised positions in the keyframe."""
        return np.array(self.nominal.key(STAND).qpos)

    @cached_property
    def stand(self) -> NDArray[np.float64]:
        """(n,) rad: the joint angles of the keyframe, in joint order."""
        return self.stand_qpos[7:].copy()

    @cached_property
    def scale(self) -> float:
        """How large the robot is against `qrio`, of which the defaults of all settings are."""
        return scale_of(self.upright, self.file)

    @cached_property
    def mass(self) -> float:
        """All of it, kg."""
        return float(self.nominal.body_subtreemass[1])

    @cached_property
    def upright(self) -> Upright:
        """The robot as it stands upright, its root level."""
        return Upright.of(self.nominal, self.stand_qpos)

    @cached_property
    def limits(self) -> MotorLimits:
        """What the motors can do, in joint order.

        A follower's is its leader's by their gear, and that of a joint that nothing turns is 0.
        """
        model = self.nominal
        inertia, friction = rotors(
            model.dof_armature[6:], model.dof_M0[6:], model.dof_frictionloss[6:], self.ties
        )
        tied = [self.ties.get(i, Tie(i)) for i in range(len(self.joints))]
        groups = [self._group(tie.leader) for tie in tied]
        gear = np.array([abs(tie.ratio) for tie in tied])
        return MotorLimits(
            kp=np.array([group.kp for group in groups]) / gear**2,
            kv=np.array([group.kv for group in groups]) / gear**2,
            peak_torque=np.array([group.peak_torque for group in groups]) / gear,
            stall_torque=np.array([group.stall_torque or group.peak_torque for group in groups])
            / gear,
            no_load_speed=np.array([group.no_load_speed for group in groups]) * gear,
            friction=friction,
            inertia=inertia,
        )

    def description(self) -> dict[str, Any]:
        """Return what the core is told of the robot: plain data that JSON can hold.

        Links, masses and mounts are read from the compiled MJCF, so that each number exists once.
        """
        told = describe(self.name, self.nominal, self.file, self.stand, self.limits)
        return with_size(told, self.scale, self.upright, self.file)

    def _group(self, joint: int) -> MotorsTable:
        name = self.joints[joint]
        of_joint = (group for group in self.file.motors.values() if name in group.joints)
        return next(of_joint, NO_MOTOR.model_copy(update={"joints": (name,)}))


def load_robot(name_or_path: str | Path) -> Robot:
    """Load and check a robot.

    Args:
        name_or_path: the name of a folder of `models`, or a path to a robot's folder.

    Raises:
        InputError: there is no such robot, or its files are broken or do not fit each other.
    """
    return load_folder(_find(name_or_path))


def load_folder(folder: Path) -> Robot:
    """Load and check the robot of a folder.

    Raises:
        InputError: its files are broken or do not fit each other.
    """
    path = folder / "robot.toml"
    file = read_robot_file(path)
    model_path = folder / file.robot.model
    spec = robot_spec(folder, model_path)
    complete(spec, file, path)
    nominal = compiled(spec, str(model_path))
    check_robot(path, model_path, nominal, file)
    return Robot(name=folder.resolve().name, folder=folder, file=file, nominal=nominal)


def _find(name_or_path: str | Path) -> Path:
    shipped = data_folder("models")
    text = str(name_or_path)
    names = robot_names()
    if text in names:
        return shipped / text
    folder = Path(text)
    with suppress(OSError, ValueError):  # what no folder can be called
        if text and folder.is_dir():
            return folder
    near = difflib.get_close_matches(text[:100], names, n=1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    raise InputError(
        f"robot: there is no robot {shortened(text)!r}: allowed are {', '.join(names)}, "
        f"or the path of a folder with a robot.toml{hint}"
    )


def robot_spec(folder: Path, model_path: Path) -> mujoco.MjSpec:
    """Read the MJCF of a robot's folder, a stranger's after a child process has built it.

    Raises:
        InputError: it is missing, broken, too large, or reaches out of its folder.
    """
    _check_folder(folder)
    if not model_path.is_file():
        raise InputError(f"{model_path}: the robot's model is missing (robot.model in robot.toml)")
    check_xml(model_path, folder, str(model_path))
    if not folder.resolve().is_relative_to(data_folder("models").resolve()):
        check_builds(model_path.resolve(), str(model_path))
    return read_spec(model_path, str(model_path))


def _check_folder(folder: Path) -> None:
    """Refuse a folder that holds more than a robot's.

    Raises:
        InputError: too many files, or too large ones.
    """
    count = size = 0
    for path in folder.rglob("*"):
        if path.is_file():
            count, size = count + 1, size + path.stat().st_size
        if count > MOST_FILES or size > LARGEST_FOLDER:
            raise InputError(
                f"{folder}: a robot's folder may have {MOST_FILES} files and "
                f"{LARGEST_FOLDER >> 20} MB, this one has more"
            )
