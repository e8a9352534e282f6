"""What happens on the way: a scenario's events, applied to the physics when they are due."""

import math
from dataclasses import replace
from typing import Final, Protocol

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from treadwell.course.course import LEVEL_TOLERANCE, Course, CourseElement
from treadwell.course.doors import with_leaf
from treadwell.course.geometry import parked
from treadwell.course.motions import ROOM, Motion, Swing
from treadwell.course.outlines import Floats
from treadwell.course.pieces import about_z
from treadwell.robot.load import Robot
from treadwell.scenario.events import (
    Add,
    Blind,
    ChangeFriction,
    EncoderOffset,
    Event,
    Kidnap,
    Knock,
    Move,
    Push,
    Remove,
    SetDoor,
)
from treadwell.scenario.faults import Fault
from treadwell.scenario.model import Scenario
from treadwell.scenario.values import element_names

PUSH_SECONDS: Final = 0.1


class Physics(Protocol):
    """What events change: the simulation, as far as they need it."""

    model: mujoco.MjModel
    data: mujoco.MjData
    steps: int

    def set(self, field: str, value: ArrayLike) -> None:
        """Set a whole field of the model or the data before the next step, and audit it."""


class Events:
    """Applies each event of a scenario once, when its time or place has come.

    Call `before_tick` before every control tick. What events do to senses and motors is read from
    `is_blind`, `encoder_offsets`, `broken` and `knocks`.

    Attributes:
        encoder_offsets: joint -> radians that its encoder reads wrong by.
        present: names of the elements that are there now.
        faults: what has broken, each with the time in seconds at which it is whole again.
        knocks: how the camera was turned since somebody took them out, in order.
        carried: whether the robot was put elsewhere before this tick.
        fired: (time in seconds, `do`) of what has happened, in order, for the record.
    """

    def __init__(self, scenario: Scenario, course: Course, robot: Robot) -> None:
        """Resolve names and indices once.

        Args:
            scenario: whose course it is.
            course: built from it; its events are those that are applied.
            robot: the robot on it.
        """
        self.encoder_offsets: dict[str, float] = {}
        self.present = {element.name for element in course.elements if element.present}
        self.faults: list[tuple[Fault, float]] = []
        self.knocks: list[Knock] = []
        self.carried = False
        self.fired: list[tuple[float, str]] = []
        self._course = course
        self._pending: list[tuple[int, Event]] = list(enumerate(course.events))
        self._added = _added_names(scenario)
        self._torso = course.model.body(robot.file.body.torso).id
        self._base = int(course.model.joint(robot.base).qposadr[0])
        self._pushes: list[tuple[int, Floats]] = []
        self._motions: dict[str, Motion] = {}
        self._swings: dict[str, Swing] = {}
        self._open = {e.name: e.hinge.open for e in course.elements if e.hinge is not None}
        self._radius = robot.file.body.radius
        self._blind_until = -math.inf

    def before_tick(self, physics: Physics) -> None:
        """Do what is due before the physics goes on by one control tick."""
        self.carried = False
        if not (self._pending or self._pushes or self._motions or self._swings):
            return
        time = physics.steps * physics.model.opt.timestep
        position = physics.data.qpos[self._base : self._base + 2].copy()
        for item in [item for item in self._pending if _is_due(item[1], time, position)]:
            self._pending.remove(item)
            self.fired.append((time, item[1].do))
            self._apply(*item, physics, time)
        self._end_pushes(physics)
        self._advance_motions(physics, position)
        self._advance_swings(physics)

    def is_blind(self, time: float) -> bool:
        """Say whether the depth camera sees nothing at a simulated time, seconds."""
        return time < self._blind_until - 1e-9

    def broken(self, time: float) -> list[Fault]:
        """Return what is broken at a simulated time, seconds, in the order in which it broke."""
        return [fault for fault, until in self.faults if time < until - 1e-9]

    def place(self, element: CourseElement, data: mujoco.MjData) -> Floats:
        """Return by how much an element now stands away from where its pieces are, (3,) metres."""
        if element.mocap_id is None:
            return np.zeros(3)
        offset: Floats = data.mocap_pos[element.mocap_id] - element.origin
        return offset

    def course_now(self) -> Course:
        """Return the course with its doors as they now are."""
        if not self._open:
            return self._course
        elements = tuple(self.stands(element) for element in self._course.elements)
        return replace(self._course, elements=elements, _by_name={})

    def stands(self, element: CourseElement) -> CourseElement:
        """Return an element as its door now is; where it was moved to, `place` says."""
        return with_leaf(element, self._open.get(element.name, 0.0))

    def _apply(  # noqa: C901, PLR0912 - one case for each kind of event
        self, index: int, event: Event, physics: Physics, time: float
    ) -> None:
        match event:
            case Add():
                self._put(self._added[index], physics, there=True)
            case Remove():
                if event.name in self.present:
                    self._motions.pop(event.name, None)
                    self._put(event.name, physics, there=False)
            case Move():
                element = self._course.element(event.name)
                if element is not None and event.name in self.present:
                    room = ROOM * self._course.scale
                    self._motions[event.name] = Motion(element, event, room)
            case SetDoor():
                for leaf in self._course.elements:
                    if leaf.hinge is not None and leaf.hinge.door == event.name:
                        begin = self._open[leaf.name]
                        self._swings[leaf.name] = Swing(leaf, begin, event.open)
            case Push():
                last = physics.steps + round(PUSH_SECONDS / physics.model.opt.timestep)
                self._pushes.append((last, np.array(event.impulse) / PUSH_SECONDS))
                self._set_force(physics)
            case Kidnap():
                self._kidnap(event, physics)
            case Blind():
                self._blind_until = max(self._blind_until, time + event.duration)
            case ChangeFriction():
                friction = physics.model.geom_friction.copy()
                self._course.set_friction(friction, event.value)
                physics.set("geom_friction", friction)
            case EncoderOffset():
                before = self.encoder_offsets.get(event.joint, 0.0)
                self.encoder_offsets[event.joint] = before + event.value
            case Fault():
                lasts = math.inf if event.duration is None else event.duration
                self.faults.append((event, time + lasts))
            case Knock():
                self.knocks.append(event)

    def _put(self, name: str, physics: Physics, *, there: bool) -> None:
        """Let an element appear where the scenario has it, or vanish."""
        element = self._course.element(name)
        if element is None or element.mocap_id is None:
            return
        places = physics.data.mocap_pos.copy()
        places[element.mocap_id] = element.origin if there else parked(element.origin)
        (self.present.add if there else self.present.discard)(name)
        physics.set("mocap_pos", places)

    def _set_force(self, physics: Physics) -> None:
        """Set the sum of all pushes that act, as a force on the torso in the world frame."""
        forces = physics.data.xfrc_applied.copy()
        forces[self._torso, :3] = sum((force for _, force in self._pushes), np.zeros(3))
        physics.set("xfrc_applied", forces)

    def _end_pushes(self, physics: Physics) -> None:
        acting = [push for push in self._pushes if physics.steps < push[0]]
        if len(acting) < len(self._pushes):
            self._pushes = acting
            self._set_force(physics)

    def _advance_motions(self, physics: Physics, robot: Floats) -> None:
        """Take every moving element on by one control tick, in the order in which they began."""
        if not self._motions:
            return
        places = physics.data.mocap_pos.copy()
        for name, motion in list(self._motions.items()):
            if motion.advance(places[motion.element.mocap_id], robot, self._radius):
                del self._motions[name]
        if (places != physics.data.mocap_pos).any():
            physics.set("mocap_pos", places)

    def _advance_swings(self, physics: Physics) -> None:
        """Turn every leaf on by one control tick, in the order in which they began."""
        if not self._swings:
            return
        turns = physics.data.mocap_quat.copy()
        for name, swing in list(self._swings.items()):
            self._open[name] = swing.advance()
            if swing.element.hinge is not None:
                turns[swing.element.mocap_id] = swing.element.hinge.turn(self._open[name])
            if swing.is_over:
                del self._swings[name]
        physics.set("mocap_quat", turns)

    def _kidnap(self, event: Kidnap, physics: Physics) -> None:
        """Put the robot elsewhere as it stands: its height above the surface and its tilt stay."""
        positions = physics.data.qpos.copy()
        pose = positions[self._base : self._base + 7]
        before = self._surface(float(pose[0]), float(pose[1]), float(pose[2]), None)
        after = self._surface(*event.position, math.inf, event.height)
        w, x, y, z = pose[3:7]
        yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        turned = np.zeros(4)
        mujoco.mju_mulQuat(turned, about_z(event.yaw - yaw), pose[3:7])
        pose[:2] = event.position
        pose[2] += after - before
        pose[3:7] = turned
        physics.set("qpos", positions)
        self.carried = True

    def _surface(self, x: float, y: float, z: float, height: float | None) -> float:
        """Return the surface at a point: the one named, or the highest that lies below `z`."""
        levels = self._course.levels_at(x, y) or [0.0]
        if height is not None:
            near = LEVEL_TOLERANCE * self._course.scale
            named = [level for level in levels if abs(level - height) <= near]
            return named[0] if named else height
        return max((level for level in levels if level < z), default=levels[0])


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
