"""What is solid on a true course: where it stands, and what it lies on and keeps from passing."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from treadwell.course.course import Course, CourseElement, Hinge
from treadwell.course.doors import with_leaf
from treadwell.course.height_field import FieldPiece, HeightField
from treadwell.course.outlines import Floats, near, signed_distance
from treadwell.scenario.events import SetDoor

LEG_ROOM: Final = 0.15
"""Metres: what can be walked on stands in the body's way only where it is higher than this."""
BARELY: Final = 1e-3
FOOT_ROOM: Final = 0.01
"""Metres: what is no floor stands in the way where it is higher than this."""


def lasting(course: Course) -> list[CourseElement]:
    """Return the elements that stay where they are, doors as their last events leave them."""
    doors = {event.name: event.open for event in course.events if isinstance(event, SetDoor)}
    return [
        element if element.hinge is None else with_leaf(element, _last(element.hinge, doors))
        for element in course.elements
        if element.present and (element.mocap_id is None or element.hinge is not None)
    ]


def _last(hinge: Hinge, doors: Mapping[str, float]) -> float:
    return doors.get(hinge.door, hinge.open)


@dataclass(frozen=True, slots=True)
class Solid:
    """A piece: its outline from above, and from where to where it reaches, metres.

    That of a height field reaches up to its surface.
    """

    outline: Floats
    low: float
    high: float
    upright: bool
    walkable: bool
    field: HeightField | None = None

    def bars(self, level: float, tall: float) -> bool:
        """Say whether a body on a level is stopped by it, in front or above, metres.

        Args:
            level: of the soles.
            tall: height of the body.
        """
        least = LEG_ROOM if self.walkable else FOOT_ROOM
        under = self.low <= level + LEG_ROOM
        if self.walkable and under:
            return False  # that is climbed
        return self.high > level + least and self.low < level + tall


def solids_of(element: CourseElement) -> list[Solid]:
    """Return the solids of an element."""
    return [
        Solid(
            piece.outline,
            float(piece.vertices[:, 2].min()),
            float(piece.vertices[:, 2].max()),
            piece.is_upright,
            element.walkable,
            piece.field if isinstance(piece, FieldPiece) else None,
        )
        for piece in element.pieces
    ]


def with_own_surfaces(
    elements: Sequence[CourseElement], solids: Sequence[Sequence[Solid]]
) -> list[tuple[Solid, range]]:
    """Return every solid with the numbers of its element's surfaces; surface 0 is the ground."""
    every, first = [], 1
    for element, ones in zip(elements, solids, strict=True):
        own = range(first, first + len(element.tops))
        first += len(element.tops)
        every += [(solid, own) for solid in ones]
    return every


class Boxes:
    """The boxes around many outlines: which of these points can touch, at one look."""

    def __init__(self, outlines: Sequence[Floats]) -> None:
        """Measure the outlines, (n, 2) each, metres."""
        self._low = np.array([each.min(axis=0) for each in outlines]).reshape(-1, 2)
        self._high = np.array([each.max(axis=0) for each in outlines]).reshape(-1, 2)

    def near(self, points: Floats, margin: float = 1e-6) -> list[int]:
        """Return the outlines whose box, grown by a margin, meets the box around points (n, 2)."""
        low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
        found: list[int] = np.flatnonzero(
            ((self._low <= high) & (self._high >= low)).all(axis=1)
        ).tolist()
        return found


def bury(found: Floats, points: Floats, solid: Solid, own: range) -> None:
    """Take away the surfaces that a solid lies on, in place; `own` are its element's."""
    close = near(solid.outline, points, 0.0)
    inside = close[signed_distance(solid.outline, points[close]) < 0.0]
    levels = found[:, inside]
    high = solid.high if solid.field is None else solid.field.surface(points[inside])
    buried = (solid.low <= levels + BARELY) & (levels < high - 5 * BARELY)
    if not solid.upright:
        buried[own.start : own.stop] = False  # a slope lies in the box around it
    found[:, inside] = np.where(buried, np.nan, levels)
