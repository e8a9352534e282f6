"""What the map has in the end where each element of the course stands."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from treadwell.course.course import CourseElement
from treadwell.course.outlines import signed_distance
from treadwell.episode import Episode
from treadwell.map_memory import FLOOR, OBSTACLE
from treadwell.measuring.cells import lattice
from treadwell.trace import Trace

Floats = NDArray[np.float64]

LEAST_CELLS = 6
"""Floor cells that a plane is fitted to."""


@dataclass(frozen=True, slots=True)
class ElementCells:
    """The cells over one element: whole, or by their centres where none is.

    Attributes:
        name: of the element.
        cells: how many there are in the map's window.
        floor: those of them that the map has as floor.
        obstacle: those that it has as an obstacle.
        errors: m, height of the floor there minus that of the element's top, floor cell by cell.
        tilt_error: rad, between the plane through the floor's cells and the element's top; None
            with too few of them, or for an element that is not walked on.
    """

    name: str
    cells: int
    floor: int
    obstacle: int
    errors: tuple[float, ...]
    tilt_error: float | None


class ElementWatch:
    """Looks at the map's last frame, element by element."""

    def __init__(self, episode: Episode) -> None:
        """Watch this episode."""
        self._elements = episode.course.elements
        self._last: Trace | None = None

    def frame(self, trace: Trace) -> None:
        """Take in a camera frame."""
        self._last = trace

    def findings(self) -> tuple[ElementCells, ...]:
        """Return an entry for each element, in the order of the course."""
        if self._last is None:
            return ()
        return tuple(_counted(element, self._last) for element in self._elements)


def _counted(element: CourseElement, trace: Trace) -> ElementCells:
    centres, _ = lattice(trace)
    half_diagonal = trace.view_cell * math.sqrt(0.5)
    every = [signed_distance(p.outline, centres) for p in element.pieces]
    distance = np.min(every, axis=0) if every else np.full(len(centres), np.inf)
    whole = distance <= -half_diagonal
    # Of what is thinner than a cell those count whose centre lies over it.
    inside = whole if whole.any() else distance <= 0.0
    kind = trace.view_kind.ravel()
    floor = inside & (kind == FLOOR)
    heights = trace.view_height.ravel()[floor].astype(np.float64)
    return ElementCells(
        element.name,
        int(inside.sum()),
        int(floor.sum()),
        int((inside & (kind == OBSTACLE)).sum()),
        tuple((heights - _top(element, centres[floor])).tolist()),
        _tilt_error(element, centres[floor], heights),
    )


def _top(element: CourseElement, points: Floats) -> Floats:
    """Return the height of an element's top at points (n, 2), m."""
    highest = max((float(piece.vertices[:, 2].max()) for piece in element.pieces), default=0.0)
    height = np.full(len(points), highest)
    for top in element.tops:
        over = top.contains(points)
        height[over] = top.height_at(points[over])
    return height


def _tilt_error(element: CourseElement, points: Floats, heights: Floats) -> float | None:
    """Return the angle between the best plane through points and heights and the one top."""
    if len(element.tops) != 1 or len(points) < LEAST_CELLS:
        return None
    columns = np.column_stack([points - points.mean(axis=0), np.ones(len(points))])
    (slope_x, slope_y, _), *_ = np.linalg.lstsq(columns, heights, rcond=None)
    normal = np.array([-slope_x, -slope_y, 1.0])
    cosine = float(normal @ element.tops[0].normal / np.linalg.norm(normal))
    return math.acos(min(1.0, cosine))
