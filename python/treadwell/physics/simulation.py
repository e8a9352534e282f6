"""The physics of one episode: the robot at its start, stepped by its motors alone, and audited."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from treadwell._core import Physics, Servos
from treadwell.errors import SimulationError
from treadwell.physics.audit import DATA_FIELDS, Audit, steps_per_tick
from treadwell.protocols import JointTargets
from treadwell.robot.load import Robot
from treadwell.robot.standing import ROOT, standing_root

TICK_NS = 10_000_000
"""The control tick, nanoseconds."""

_SENSORS = int(mujoco.mjtDisableBit.mjDSBL_SENSOR)


@dataclass(frozen=True, slots=True)
class Start:
    """Where the robot frame (on the ground, between the soles, x forward) is at the start.

    Attributes:
        x: m, world.
        y: m, world.
        yaw: rad.
        height: m, of the ground there.
    """

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    height: float = 0.0


class Simulation:
    """MuJoCo's model and data of one episode.

    After the constructor, `advance` and `set`, all that follows from positions and velocities
    (link and camera poses, contacts, the gyro) is up to date in `data`; forces and accelerations
    (contact forces, the accelerometer) are those of the last physics step. Readers
    must call nothing that writes to `data`; `mj_forward` would break the audit.

    Attributes:
        model: the compiled robot and course.
        data: MuJoCo's state.
        robot: the robot in it.
        motors: the servos: a proportional-derivative one with feed-forward on each joint, within
            what its motor can do, and the play in its gear.
        audit: what a replay needs.
        steps: physics steps so far.
    """

    def __init__(
        self, model: mujoco.MjModel, robot: Robot, start: Start | None = None, *, play: bool = True
    ) -> None:
        """Put the robot at its start, standing as in its keyframe, at rest.

        Args:
            model: compiled from `robot.spec()` and whatever was added to it.
            robot: the robot.
            start: where it stands; the world's origin without.
            play: False for gears without play, as with ideal encoders.
        """
        self.model = model
        self._steps_per_tick = steps_per_tick(model)
        self._controls = np.empty((self._steps_per_tick, model.nu))
        # Each would be made anew at every tick.
        self._but_last, self._last = self._controls[:-1], self._controls[-1:]
        self._options = model.opt
        self.data = mujoco.MjData(model)
        self.robot = robot
        joints = [model.joint(name) for name in robot.joints]
        self._positions = _slice([int(joint.qposadr[0]) for joint in joints])
        self._velocities = _slice([int(joint.dofadr[0]) for joint in joints])
        self.motors = Servos(
            robot.limits,
            play=robot.file.encoders.play if play else 0.0,
            timestep=float(model.opt.timestep),
        )
        actuators = [int(model.actuator(name).id) for name in robot.actuators]
        self._physics = Physics(
            model,
            self.data,
            len(joints),
            self._positions.start,
            self._velocities.start,
            list(zip(robot.driven, actuators, strict=True)),
        )
        self.place(start or Start())
        self.steps = 0
        self._follow()
        self.audit = Audit(model, self.data)

    @property
    def time_ns(self) -> int:
        """Nanoseconds since the start."""
        return self.steps * TICK_NS // self._steps_per_tick

    @property
    def joint_positions(self) -> NDArray[np.float64]:
        """(n,) rad, the true joint angles in joint order; a view."""
        view: NDArray[np.float64] = self.data.qpos[self._positions]
        return view

    @property
    def joint_velocities(self) -> NDArray[np.float64]:
        """(n,) rad/s, the true joint velocities in joint order; a view."""
        view: NDArray[np.float64] = self.data.qvel[self._velocities]
        return view

    def advance(self, targets: JointTargets) -> None:
        """Advance by one control tick: some physics steps, with the servos at each.

        Raises:
            SimulationError: the targets or the state are not finite, or MuJoCo cannot step.
        """
        if not self.motors.command(targets.position, targets.velocity, targets.torque):
            self._refuse(targets)
        options, step = self._options, self._physics.step
        # Nobody reads MuJoCo's sensors between two ticks, and nothing that moves depends on them.
        flags = options.disableflags
        options.disableflags = flags | _SENSORS
        try:
            step(self.motors, self._but_last)
            options.disableflags = flags & ~_SENSORS
            healthy = step(self.motors, self._last)
        except mujoco.FatalError as error:
            options.disableflags = flags & ~_SENSORS
            raise self._failed(error) from None
        self.steps += self._steps_per_tick
        self.audit.tick(self._controls, self.data.qpos)
        if not healthy:
            self._tell_divergence()

    def set(self, field: str, value: ArrayLike) -> None:
        """Do what an event does: set a whole field before the next step, and audit it.

        Args:
            field: `xfrc_applied`, `qpos`, `qvel`, `mocap_pos`, `mocap_quat`, or a field of the
                model that MuJoCo lets change between steps, such as `geom_friction`.
            value: the whole field.

        Raises:
            SimulationError: MuJoCo cannot compute what follows.
        """
        owner = self.data if field in DATA_FIELDS else self.model
        array: NDArray[Any] = getattr(owner, field)
        before = array.copy()
        array[:] = value
        self.audit.event(self.steps, field, before, array)
        self._follow()

    def standing_qpos(self, start: Start) -> NDArray[np.float64]:
        """Return (nq,): all positions as they are, but the robot standing as in its keyframe."""
        robot = self.robot
        qpos: NDArray[np.float64] = self.data.qpos.copy()
        base = int(self.model.joint(robot.base).qposadr[0])
        place = (start.x, start.y, start.height)
        qpos[base : base + ROOT] = standing_root(robot, place, start.yaw)
        qpos[self._positions] = robot.stand
        return qpos

    def place(self, start: Start) -> None:
        """Write the start pose. For the start only: an event that moves the robot uses `set`."""
        self.data.qpos[:] = self.standing_qpos(start)

    def save_audit(self, folder: Path) -> None:
        """Write `model.mjb` and `physics.npz` into a folder that exists.

        Raises:
            RecordingError: they cannot be written.
        """
        self.audit.save(folder)

    def _follow(self) -> None:
        """Bring up to date all that follows from positions and velocities."""
        try:
            mujoco.mj_step1(self.model, self.data)
        except mujoco.FatalError as error:
            raise self._failed(error) from None

    def _failed(self, error: Exception) -> SimulationError:
        time, words = 1e-9 * self.time_ns, " ".join(str(error).split())
        return SimulationError(f"the physics failed at {time:.2f} s (MuJoCo: {words})")

    def _refuse(self, targets: JointTargets) -> NoReturn:
        shape = (len(self.robot.joints),)
        arrays = {name: getattr(targets, name) for name in ("position", "velocity", "torque")}
        wrong = {
            name: array
            for name, array in arrays.items()
            if array.shape != shape or not np.isfinite(array).all()
        }
        name, array = next(iter(wrong.items()))
        raise SimulationError(
            f"joint targets: {name} must be {shape[0]} finite numbers, got {array!r} "
            f"at {1e-9 * self.time_ns:.2f} s"
        )

    def _tell_divergence(self) -> NoReturn:
        names = [
            mujoco.mjtWarning(kind).name.removeprefix("mjWARN_")
            for kind in np.flatnonzero(self.data.warning.number)
        ]
        raise SimulationError(
            f"the physics diverged at {1e-9 * self.time_ns:.2f} s "
            f"(MuJoCo: {', '.join(names) or 'not finite'})"
        )


def _slice(addresses: list[int]) -> slice:
    """Return the addresses as a slice; joints of one tree are numbered without gaps."""
    first = addresses[0]
    assert addresses == list(range(first, first + len(addresses)))
    return slice(first, first + len(addresses))
