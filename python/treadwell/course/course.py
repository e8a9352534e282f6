"""The course as it was built: the model with the robot in it, and what stands where."""

import math
from dataclasses import dataclass, field, replace
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from treadwell.course.levels import levels, surface_height
from treadwell.course.outlines import Floats
from treadwell.course.pieces import Piece, Top, about_z
from treadwell.scenario.events import Event

LEVEL_TOLERANCE: Final = 0.02
"""Metres: a height that a scenario names means the surface within this."""

QUARTER: Final = math.pi / 2
"""Radians by which a door is open that is wholly open."""


@dataclass(frozen=True, slots=True)
class Hinge:
    """What a door's leaf turns about.

    Attributes:
        door: the door's name.
        open: how far the leaf is open as its pieces lie, 0 to 1.
    """

    door: str
    open: float

    def turn(self, opened: float) -> Floats:
        """Return the quaternion (w, x, y, z) of the leaf's body with the door so far open."""
        return about_z(QUARTER * (opened - self.open))


@dataclass(frozen=True)
class CourseElement:
    """One element as it was built.

    Attributes:
        name: unique on the course.
        kind: as in the scenario file.
        mapped: whether an a-priori map has it.
        texture: how well stereo sees it, 0 to 1.
        pieces: its convex solids in the world frame, where the scenario file puts them.
        tops: its walkable surfaces in the world frame; empty for an obstacle.
        geom_ids: its geoms; geom `geom_ids[i]` is piece `i`.
        mocap_id: its row of `data.mocap_pos` when events can move it, else None.
        origin: (3,) world: where its body stands when it is where the file puts it.
        present: whether it is there from the beginning.
        hinge: what it turns about where it is the leaf of a door, else None.
        soft_ids: its geoms that are seen and give way: nothing touches them.
        slippery: whether its geoms have a friction of their own.
    """

    name: str
    kind: str
    mapped: bool
    texture: float
    pieces: tuple[Piece, ...]
    tops: tuple[Top, ...]
    geom_ids: tuple[int, ...]
    mocap_id: int | None
    origin: Floats
    present: bool
    hinge: Hinge | None = None
    soft_ids: tuple[int, ...] = ()
    slippery: bool = False

    @property
    def walkable(self) -> bool:
        """Whether it has tops to walk on."""
        return bool(self.tops)

    def multiplied(self, factor: float) -> "CourseElement":
        """Return the element with all lengths multiplied, its distance from the origin, too."""
        return replace(
            self,
            pieces=tuple(piece.multiplied(factor) for piece in self.pieces),
            tops=tuple(top.multiplied(factor) for top in self.tops),
            origin=factor * self.origin,
        )


@dataclass(frozen=True)
class Place:
    """A pose on the course: world x, y, height of the surface there (m) and yaw (rad)."""

    position: tuple[float, float]
    height: float
    yaw: float

    def multiplied(self, factor: float) -> "Place":
        """Return the place so many times as far from the origin."""
        x, y = self.position
        return Place((factor * x, factor * y), factor * self.height, self.yaw)


@dataclass(frozen=True, eq=False)
class Course:
    """The model, with the robot standing at the start, and what stands where.

    Attributes:
        model: compiled; options are the robot's.
        elements: in the order of the file, scattered ones in place, those of events last.
        start: where the robot stands.
        goal_height: height of the surface at the goal, metres.
        qpos: (nq,) the robot in its standing posture at the start, its soles' middle there.
        texture: (ngeom,) how well stereo sees each geom, 0 to 1.
        geom_element: (ngeom,) index into `elements`, -1 for the ground and the robot.
        events: what happens on the way: the scenario's, then what drawn elements bring.
        scale: what the lengths of the scenario's file were multiplied by.
    """

    model: mujoco.MjModel
    elements: tuple[CourseElement, ...]
    start: Place
    goal_height: float
    qpos: Floats
    texture: Floats
    geom_element: npt.NDArray[np.intp]
    events: tuple[Event, ...] = ()
    scale: float = 1.0
    _by_name: dict[str, CourseElement] = field(default_factory=dict)

    def element(self, name: str) -> CourseElement | None:
        """Return an element by its name, None when there is none."""
        if not self._by_name:
            self._by_name.update({element.name: element for element in self.elements})
        return self._by_name.get(name)

    def set_friction(self, friction: Floats, value: float) -> None:
        """Set the sliding friction of all geoms but of those that have their own, in place.

        Args:
            friction: (ngeom, 3), MuJoCo's `geom_friction`.
            value: of the soles on everything.
        """
        own = [geom for e in self.elements if e.slippery for geom in e.geom_ids]
        kept = friction[own, 0].copy()
        friction[:, 0] = value
        friction[own, 0] = kept

    def tops(self) -> list[tuple[CourseElement, Top]]:
        """Return every walkable top that is there from the beginning, with its element."""
        return [(e, top) for e in self.elements if e.present for top in e.tops]

    def height_at(self, points: Floats) -> Floats:
        """Return the height of the highest surface at world points (n, 2), metres."""
        points = np.atleast_2d(np.asarray(points, dtype=np.float64))
        return surface_height([top for _, top in self.tops()], points)

    def levels_at(self, x: float, y: float) -> list[float]:
        """Return the heights of all surfaces at a world point that something can stand on."""
        return levels_at(self.elements, x, y)


def levels_at(elements: tuple[CourseElement, ...], x: float, y: float) -> list[float]:
    """Return the heights of all surfaces of elements, and of the ground, at a world point."""
    there = [element for element in elements if element.present and element.walkable]
    tops = [top for element in there for top in element.tops]
    return levels(tops, [piece for element in there for piece in element.pieces], x, y)
