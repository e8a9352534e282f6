"""What happens on the way: a scenario's events, applied to the physics and logged for the audit."""

import math
from dataclasses import dataclass, field
from typing import Final, Literal

import mujoco
import numpy as np

from treadwell.course import LEVEL_TOLERANCE, Course, CourseElement
from treadwell.course_model import parked
from treadwell.course_pieces import Floats, about_z
from treadwell.robot import Robot
from treadwell.scenario import Scenario
from treadwell.scenario_events import (
    Add,
    Blind,
    ChangeFriction,
    EncoderOffset,
    Event,
    Kidnap,
    Move,
    Push,
    Remove,
)
from treadwell.scenario_values import element_names

PUSH_SECONDS: Final = 0.1
STEPS_A_MOVE: Final = 5
"""Physics steps between two places of a moving element: one control tick."""

Field = Literal["xfrc_applied", "qpos", "mocap_pos", "geom_friction"]


@dataclass(frozen=True, eq=False)
class Change:
    """One write to the physics, for the audit: before step `step`, `field` became `value`.

    Attributes:
        step: the number of steps done before; setting the field and then stepping repeats it.
        field: of `MjData`, or of `MjModel` for `geom_friction`.
        value: the whole field as it was set.
    """

    step: int
    field: Field
    value: Floats


@dataclass
class Motion:
    """An element on its way."""

    element: CourseElement
    target: Floats
    """(2,) world x, y of its reference point."""
    speed: float


@dataclass
class Events:
    """Applies each event of a scenario once, when its time or place has come.

    Call `before_step` before every physics step. What events do to the senses is read from
    `is_blind` and `encoder_offsets`.

    Attributes:
        log: every write to the physics in order.
        encoder_offsets: joint -> radians that its encoder reads wrong by.
        present: names of the elements that are there now.
        fired: (time in seconds, what happened) in order, for the record.
    """

    scenario: Scenario
    course: Course
    robot: Robot
    log: list[Change] = field(default_factory=list)
    encoder_offsets: dict[str, float] = field(default_factory=dict)
    present: set[str] = field(default_factory=set)
    fired: list[tuple[float, str]] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Resolve names and indices once."""
        model = self.course.model
        self._pending: list[tuple[int, Event]] = list(enumerate(self.scenario.event))
        self._added = _added_names(self.scenario)
        self._torso = model.body(self.robot.file.body.torso).id
        self._base = int(model.joint(self.robot.base).qposadr[0])
        self._timestep = float(model.opt.timestep)
        self._pushes: list[tuple[int, Floats]] = []
        self._motions: dict[str, Motion] = {}
        self._blind_until = -math.inf
        self.present |= {element.name for element in self.course.elements if element.present}

    def before_step(self, data: mujoco.MjData, step: int) -> None:
        """Do what is due before the physics makes step number `step`, counted from 0."""
        if not (self._pending or self._pushes or self._motions):
            return
        time = step * self._timestep
        position = data.qpos[self._base : self._base + 2]
        due = [item for item in self._pending if _is_due(item[1], time, position)]
        for index, event in due:
            self._pending.remove((index, event))
            self.fired.append((time, event.do))
            self._apply(index, event, data, step)
        self._end_pushes(data, step)
        if step % STEPS_A_MOVE == 0:
            self._advance_motions(data, step)

    def is_blind(self, time: float) -> bool:
        """Say whether the depth camera sees nothing at a simulated time, seconds."""
        return time < self._blind_until - 1e-9

    def place(self, element: CourseElement, data: mujoco.MjData) -> Floats:
        """Return by how much an element now stands away from where its pieces are, (3,) metres."""
        if element.mocap_id is None:
            return np.zeros(3)
        offset: Floats = data.mocap_pos[element.mocap_id] - element.origin
        return offset

    def _apply(  # noqa: C901 - one case for each kind of event
        self, index: int, event: Event, data: mujoco.MjData, step: int
    ) -> None:
        match event:
            case Add():
                self._put(self._added[index], data, step, there=True)
            case Remove():
                if event.name in self.present:
                    self._motions.pop(event.name, None)
                    self._put(event.name, data, step, there=False)
            case Move():
                element = self.course.element(event.name)
                if element is not None and event.name in self.present:
                    self._motions[event.name] = Motion(element, np.array(event.to), event.speed)
            case Push():
                last = step + round(PUSH_SECONDS / self._timestep)
                self._pushes.append((last, np.array(event.impulse) / PUSH_SECONDS))
                self._set_force(data, step)
            case Kidnap():
                self._kidnap(event, data, step)
            case Blind():
                self._blind_until = max(self._blind_until, step * self._timestep + event.duration)
            case ChangeFriction():
                self.course.model.geom_friction[:, 0] = event.value
                self._write("geom_friction", self.course.model.geom_friction, step)
            case EncoderOffset():
                before = self.encoder_offsets.get(event.joint, 0.0)
                self.encoder_offsets[event.joint] = before + event.value

    def _put(self, name: str, data: mujoco.MjData, step: int, *, there: bool) -> None:
        """Let an element appear where the scenario has it, or vanish."""
        element = self.course.element(name)
        if element is None or element.mocap_id is None:
            return
        data.mocap_pos[element.mocap_id] = element.origin if there else parked(element.origin)
        (self.present.add if there else self.present.discard)(name)
        self._write("mocap_pos", data.mocap_pos, step)

    def _set_force(self, data: mujoco.MjData, step: int) -> None:
        """Set the sum of all pushes that act, as a force on the torso in the world frame."""
        data.xfrc_applied[self._torso, :3] = sum((force for _, force in self._pushes), np.zeros(3))
        self._write("xfrc_applied", data.xfrc_applied, step)

    def _end_pushes(self, data: mujoco.MjData, step: int) -> None:
        acting = [push for push in self._pushes if step < push[0]]
        if len(acting) < len(self._pushes):
            self._pushes = acting
            self._set_force(data, step)

    def _advance_motions(self, data: mujoco.MjData, step: int) -> None:
        """Take every moving element on by one control tick, in the order in which they began."""
        if not self._motions:
            return
        for name, motion in list(self._motions.items()):
            place = data.mocap_pos[motion.element.mocap_id]
            way = motion.target - place[:2]
            distance = float(np.hypot(*way))
            stride = motion.speed * STEPS_A_MOVE * self._timestep
            if distance <= stride:
                place[:2] = motion.target
                del self._motions[name]
            else:
                place[:2] += way * (stride / distance)
        self._write("mocap_pos", data.mocap_pos, step)

    def _kidnap(self, event: Kidnap, data: mujoco.MjData, step: int) -> None:
        """Put the robot elsewhere as it stands: its height above the surface and its tilt stay."""
        pose = data.qpos[self._base : self._base + 7]
        below = self._surface(float(pose[0]), float(pose[1]), float(pose[2]), None)
        above = self._surface(*event.position, math.inf, event.height)
        w, x, y, z = pose[3:7]
        yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        turned = np.zeros(4)
        mujoco.mju_mulQuat(turned, about_z(event.yaw - yaw), pose[3:7])
        pose[:2] = event.position
        pose[2] += above - below
        pose[3:7] = turned
        self._write("qpos", data.qpos, step)

    def _surface(self, x: float, y: float, z: float, height: float | None) -> float:
        """Return the surface at a point: the one named, or the highest that lies below `z`."""
        levels = self.course.levels_at(x, y) or [0.0]
        if height is not None:
            named = [level for level in levels if abs(level - height) <= LEVEL_TOLERANCE]
            return named[0] if named else height
        return max((level for level in levels if level < z), default=levels[0])

    def _write(self, name: Field, value: Floats, step: int) -> None:
        self.log.append(Change(step, name, np.array(value)))


def _added_names(scenario: Scenario) -> dict[int, str]:
    """Return the name of the element that each `add` event brings, by the event's index."""
    adds = [(i, e.element) for i, e in enumerate(scenario.event) if isinstance(e, Add)]
    tables = [{"kind": e.kind, "name": e.name} for e in (*scenario.course, *(e for _, e in adds))]
    names = element_names(tables)[len(scenario.course) :]
    return {i: name for (i, _), name in zip(adds, names, strict=True)}


def _is_due(event: Event, time: float, position: Floats) -> bool:
    if event.at is not None:
        return time >= event.at - 1e-9
    if event.near is None or event.within is None:
        return False
    return math.dist(event.near, (float(position[0]), float(position[1]))) <= event.within
