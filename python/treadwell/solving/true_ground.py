"""The true course as a grid: where the robot could stand, by its size, on which surface."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from treadwell.course.course import Course, CourseElement
from treadwell.course.outlines import Floats, near, signed_distance
from treadwell.course.pieces import Top, bounds

CELL: Final = 0.03
"""Metres; more on courses that are very large."""
MOST_CELLS: Final = 250
"""Along a side."""
MARGIN: Final = 1.0
"""Metres of ground around all that matters."""
LEG_ROOM: Final = 0.15
"""Metres: what can be walked on stands in the body's way only where it is higher than this."""
BARELY: Final = 1e-3

Mask = npt.NDArray[np.bool_]


class TrueGround:
    """The surfaces of a course that stay where they are, and what stands in the way.

    Elements that events add, remove or move are left out: what may not be there keeps nobody from
    a way, and carries nobody.

    Attributes:
        cell: side of a cell, metres.
        origin: (2,) world, the middle of cell [0, 0].
        height: (s, rows, cols) of the ground and of each top, metres; NaN where it is not.
        free: the same shape: the robot's upright cylinder has room there.
    """

    def __init__(
        self, course: Course, stops: Sequence[tuple[float, float]], *, radius: float, tall: float
    ) -> None:
        """Lay the grid.

        Args:
            course: what stands where.
            stops: start, points to pass and goal, world x, y.
            radius: of the cylinder, metres.
            tall: its height, metres.
        """
        self._elements = [e for e in course.elements if e.present and e.mocap_id is None]
        self._radius, self._tall = radius, tall
        self._solids = [_solids(element) for element in self._elements]
        self.tops = [top for element in self._elements for top in element.tops]
        pieces = (piece for element in self._elements for piece in element.pieces)
        low, high = bounds(pieces, np.array(stops))
        low, high = low - MARGIN, high + MARGIN
        self.cell = max(CELL, float((high - low).max()) / MOST_CELLS)
        self.origin = low
        x = np.arange(low[0], high[0], self.cell)
        y = np.arange(low[1], high[1], self.cell)
        grid = np.meshgrid(x, y)
        points = np.column_stack([axis.ravel() for axis in grid])
        shape = (len(self.tops) + 1, *grid[0].shape)
        self.height = self.heights(points).reshape(shape)
        self.free = self._room(points).reshape(shape) & np.isfinite(self.height)

    def heights(self, points: Floats) -> Floats:
        """Return the height of the ground and of each top at points (n, 2); NaN where it is not.

        What something solid lies on is no surface.
        """
        found = np.full((len(self.tops) + 1, len(points)), np.nan)
        found[0] = 0.0
        for number, top in enumerate(self.tops, start=1):
            over = np.flatnonzero(top.contains(points))
            found[number, over] = top.height_at(points[over])
        first = 1
        for element, solids in zip(self._elements, self._solids, strict=True):
            own = range(first, first + len(element.tops))
            first += len(element.tops)
            for solid in solids:
                _bury(found, points, solid, own)
        return found

    def index(self, x: float, y: float) -> tuple[int, int]:
        """Return the cell of a world point, (row, column)."""
        return (
            round((y - float(self.origin[1])) / self.cell),
            round((x - float(self.origin[0])) / self.cell),
        )

    def centre(self, row: int, column: int) -> tuple[float, float]:
        """Return the middle of a cell, world x, y."""
        return (
            float(self.origin[0]) + column * self.cell,
            float(self.origin[1]) + row * self.cell,
        )

    def standing(self, reach: float, floor_max: float) -> Mask:
        """Say where the robot can stand: room, and one floor under a disc around it.

        Args:
            reach: radius of the disc, metres.
            floor_max: difference of heights that is still one floor, metres.
        """
        cells = math.floor(reach / self.cell)
        around = range(-cells, cells + 1)
        disc = [(r, c) for r in around for c in around if math.hypot(r, c) * self.cell <= reach]
        padded = np.pad(
            self.height, ((0, 0), (cells, cells), (cells, cells)), constant_values=np.nan
        )
        mask = self.free.copy()
        for surface in range(len(mask)):
            rows, columns = _extent(mask[surface])
            level, carried = self.height[surface, rows, columns], mask[surface, rows, columns]
            slope_x, slope_y = self._slope(surface)
            for r, c in disc:
                expected = level + self.cell * (slope_x * c + slope_y * r)
                there = padded[:, _moved(rows, r + cells), _moved(columns, c + cells)]
                carried &= (np.abs(there - expected) <= floor_max).any(axis=0)
        return mask

    def _slope(self, surface: int) -> tuple[float, float]:
        """Return the rise of a surface along x and y, metres a metre."""
        if surface == 0:
            return 0.0, 0.0
        normal = self.tops[surface - 1].normal
        return float(-normal[0] / normal[2]), float(-normal[1] / normal[2])

    def _room(self, points: Floats) -> Mask:
        """Say for each surface and point whether the cylinder stands free there."""
        level = self.heights(points)
        free = np.isfinite(level)
        for element, solids in zip(self._elements, self._solids, strict=True):
            least = LEG_ROOM if element.tops else 0.01
            for solid in solids:
                close = near(solid.outline, points, self._radius)
                close = close[signed_distance(solid.outline, points[close]) < self._radius]
                there = level[:, close]
                free[:, close] &= ~((solid.high > there + least) & (solid.low < there + self._tall))
        return free


def _extent(mask: Mask) -> tuple[slice, slice]:
    """Return the rows and columns in which a mask (rows, columns) holds anywhere."""
    found = []
    for axis in (1, 0):
        there = np.flatnonzero(mask.any(axis=axis))
        found.append(slice(int(there[0]), int(there[-1]) + 1) if len(there) else slice(0, 0))
    return found[0], found[1]


def _moved(part: slice, by: int) -> slice:
    return slice(part.start + by, part.stop + by)


@dataclass(frozen=True, slots=True)
class _Solid:
    """A piece: its outline from above, and from where to where it reaches, metres."""

    outline: Floats
    low: float
    high: float
    upright: bool


def _solids(element: CourseElement) -> list[_Solid]:
    return [
        _Solid(
            piece.outline,
            float(piece.vertices[:, 2].min()),
            float(piece.vertices[:, 2].max()),
            piece.is_upright,
        )
        for piece in element.pieces
    ]


def _bury(found: Floats, points: Floats, solid: _Solid, own: range) -> None:
    """Take away the surfaces that a solid lies on, in place; `own` are its element's."""
    close = near(solid.outline, points, 0.0)
    inside = close[signed_distance(solid.outline, points[close]) < 0.0]
    levels = found[:, inside]
    buried = (solid.low <= levels + BARELY) & (levels < solid.high - 5 * BARELY)
    if not solid.upright:
        buried[own.start : own.stop] = False  # a slope lies in the box around it
    found[:, inside] = np.where(buried, np.nan, levels)


def edges_of(top: Top) -> list[tuple[Floats, Floats, Floats]]:
    """Return the sides of a top as seen from above: both ends, and the unit normal outwards."""
    corners = top.polygon[:, :2]
    sides = []
    for begin, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along = end - begin
        length = float(np.linalg.norm(along))
        if length > 0.0:
            sides.append((begin, end, np.array([along[1], -along[0]]) / length))
    return sides
