"""What the robot truly touches: soles on floors, falls, and collisions as the contract has them."""

from dataclasses import dataclass
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell._core import Surfaces
from treadwell.course.course import Course
from treadwell.course.height_field import FieldPiece
from treadwell.judging.encounters import Encounter, Encounters
from treadwell.robot.load import Robot
from treadwell.scenario.scaling import size_of

SAME_CONTACT_SECONDS = 0.5
"""Contacts of one pair that are no further apart in time are one collision."""
RISER_IMPULSE = 1.0
"""N·s from which on a touch of a riser counts that the sole of a robot of scale 1 makes."""
SOLE_ON_TOP = 0.7
"""Least z of the normal (from the floor up) with which a sole stands on a walkable top."""
LIES_ON_TOP = 0.9
"""The same for any other part: leaning on an edge is a collision, lying on a top is a fall."""
FIELD_TOUCH = 0.003
"""Metres from a height field's surface within which a contact is on it, on a course of scale 1."""
_GROUND, _NOTHING = -1, -2
_AROUND = 0.002 * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])
"""Metres: a contact on the crease between two triangles of a height field is on either."""


@dataclass(slots=True)
class Collision:
    """Touches of one pair of robot part and element, none later than 0.5 s after the one before.

    Attributes:
        time: s, of the first touch.
        robot_part: name of the robot's link.
        element: name of the course element.
        impulse: N·s, integral of the normal force.
        last: s, of the last touch.
        riser_only: a sole on a riser; counts where the impulse is above `least`.
        least: N·s.
        encounter: how the two met, where the element moved when it began.
    """

    time: float
    robot_part: str
    element: str
    impulse: float
    last: float
    riser_only: bool
    least: float = RISER_IMPULSE
    encounter: Encounter | None = None

    @property
    def counts(self) -> bool:
        """Whether the contract calls it a collision."""
        return not self.riser_only or self.impulse > self.least


class Touch(NamedTuple):
    """What a look at the contacts found.

    Attributes:
        left: whether the left sole stands on a floor.
        right: whether the right sole does.
        fallen_part: a link other than a sole that lies on a floor, or None.
    """

    left: bool
    right: bool
    fallen_part: str | None


_STANCES = [[Touch(left, right, None) for right in (False, True)] for left in (False, True)]
"""What is found but for falls, by left and right."""


class Contacts:
    """Sorts MuJoCo's contacts, as often as it is asked to look."""

    def __init__(
        self, model: mujoco.MjModel, course: Course, robot: Robot, sole_bodies: tuple[int, ...]
    ) -> None:
        """Sort the geoms once.

        Args:
            model: the compiled course with the robot in it.
            course: what stands on it.
            robot: the robot.
            sole_bodies: ids of the left and the right link that carry a sole.
        """
        self._model = model
        self._least = RISER_IMPULSE * size_of(robot).impulse
        self._field_touch = FIELD_TOUCH * course.scale
        self._scratch = mujoco.MjData(model)
        self._encounters = Encounters(model)
        body_of = np.asarray(model.geom_bodyid)
        is_robot = np.asarray(model.body_rootid)[body_of] == model.body(robot.root).id
        foot = np.full(model.ngeom, -1)
        for side, body in enumerate(sole_bodies):
            foot[body_of == body] = side
        self._foot: list[int] = foot.tolist()
        self._part = [str(model.body(int(body)).name) for body in body_of]
        # For each geom: index of its element, -1 for the ground, -2 for the robot.
        element = np.where(is_robot, _NOTHING, np.asarray(course.geom_element))
        self._element: list[int] = element.tolist()
        self._names = [element.name for element in course.elements]
        self._walkable = [*(element.walkable for element in course.elements), True]
        words = [self._word(geom) for geom in range(model.ngeom)]
        self._surfaces = Surfaces(words, SOLE_ON_TOP, LIES_ON_TOP)
        self._fields = {
            geom: piece.field
            for element in course.elements
            for geom, piece in zip(element.geom_ids, element.pieces, strict=True)
            if isinstance(piece, FieldPiece)
        }
        self._open: dict[tuple[str, str], Collision] = {}
        self._closed: list[Collision] = []

    def look(self, data: mujoco.MjData, time: float, interval: float, still: float = 0.0) -> Touch:
        """Sort the contacts there are now.

        Args:
            data: after a tick; contacts are those of the present positions.
            time: s, now.
            interval: s since the last look: for how long the forces are taken to have acted.
            still: s for which the robot had stood on both soles at the last look.
        """
        contact = data.contact
        frames = contact.frame if not self._fields else self._by_surface(data)
        left, right, lying, hits = self._surfaces.sort(contact.geom, frames)
        if hits:
            self._add(data, hits, time, interval, still)
        self._encounters.note(data)
        if lying is None:
            return _STANCES[left][right]
        return Touch(left, right, self._part[lying])

    def collisions(self) -> list[Collision]:
        """Return the collisions so far that count, in the order of time."""
        every = [*self._closed, *self._open.values()]
        counted = [collision for collision in every if collision.counts]
        return sorted(counted, key=lambda hit: (hit.time, hit.robot_part, hit.element))

    def _word(self, geom: int) -> str:
        """Return what `Surfaces` calls a geom."""
        element, foot = self._element[geom], self._foot[geom]
        if element == _NOTHING:
            return "robot" if foot < 0 else ("left", "right")[foot]
        if element == _GROUND:
            return "ground"
        return "walkable" if self._walkable[element] else "obstacle"

    def _by_surface(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """Return the contacts' frames; on height fields with the normals of their surfaces.

        MuJoCo makes a column of each triangle, and a sole that slides over level ones is told to
        touch their sides, too. What lies on the surface has the normal of the surface there.
        """
        contact = data.contact
        frames: NDArray[np.float64] = contact.frame.copy()
        for index, (first, second) in enumerate(contact.geom.tolist()):
            field = self._fields.get(first) or self._fields.get(second)
            if field is None:
                continue
            x, y, z = contact.pos[index]
            around = np.array([x, y]) + _AROUND
            on_it = np.abs(field.surface(around) - z) <= self._field_touch
            if on_it.any():
                up = float(field.upward(around[on_it]).max())
                frames[index, 2] = up if first in self._fields else -up
        return frames

    def _add(
        self,
        data: mujoco.MjData,
        hits: list[tuple[int, int, int]],
        time: float,
        interval: float,
        still: float,
    ) -> None:
        # After a tick the contacts are there but not yet their forces: they are found on a copy.
        scratch, force = self._scratch, np.zeros(6)
        mujoco.mj_copyData(scratch, self._model, data)
        mujoco.mj_forward(self._model, scratch)
        for index, mine, other in hits:
            element = self._element[other]
            riser = self._foot[mine] >= 0 and self._walkable[element]
            mujoco.mj_contactForce(self._model, scratch, index, force)
            pair = (self._part[mine], self._names[element])
            known = self._open.get(pair)
            if known is not None and time - known.last > SAME_CONTACT_SECONDS + 1e-9:
                self._closed.append(known)
                known = None
            if known is None:
                known = self._open[pair] = Collision(time, *pair, 0.0, time, riser, self._least)
                known.encounter = self._encounters.at(scratch, index, other, interval, still)
            known.impulse += float(force[0]) * interval
            known.last = time
            known.riser_only = known.riser_only and riser
