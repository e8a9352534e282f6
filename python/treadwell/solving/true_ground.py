"""The true course as a grid: where the robot could stand, by its size, on which surface."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from treadwell.course.course import Course
from treadwell.course.outlines import Floats, near, signed_distance
from treadwell.course.pieces import Top, bounds
from treadwell.solving.true_solids import (
    BARELY,
    FOOT_ROOM,
    LEG_ROOM,
    Boxes,
    bury,
    lasting,
    solids_of,
    with_own_surfaces,
)

CELL: Final = 0.03
"""Metres; more on courses that are very large."""
MOST_CELLS: Final = 250
"""Along a side."""
MARGIN: Final = 1.0
"""Metres of ground around all that matters."""
Mask = npt.NDArray[np.bool_]


class TrueGround:
    """The surfaces of a course that stay where they are, and what stands in the way.

    Elements that events add, remove or move are left out: what may not be there keeps nobody from
    a way, and carries nobody. A door is as its last event leaves it.

    Attributes:
        cell: side of a cell, metres.
        origin: (2,) world, the middle of cell [0, 0].
        height: (s, rows, cols) of the ground and of each top, metres; NaN where it is not.
        free: the same shape: the robot's upright cylinder has room there.
        steep: (s,) whether a surface is too steep to stand or walk on.
    """

    def __init__(
        self,
        course: Course,
        stops: Sequence[tuple[float, float]],
        *,
        radius: float,
        tall: float,
        steepest: float,
    ) -> None:
        """Lay the grid.

        Args:
            course: what stands where.
            stops: start, points to pass and goal, world x, y.
            radius: of the cylinder, metres.
            tall: its height, metres.
            steepest: slope of a surface that can be walked on, radians.
        """
        self._elements = lasting(course)
        self._radius, self._tall = radius, tall
        self._solids = [solids_of(element) for element in self._elements]
        self.tops = [top for element in self._elements for top in element.tops]
        self._every = with_own_surfaces(self._elements, self._solids)
        self._top_boxes = Boxes([top.polygon[:, :2] for top in self.tops])
        self._solid_boxes = Boxes([solid.outline for solid, _ in self._every])
        planes = np.array([slope_of(top) for top in self.tops]).reshape(-1, 2)
        self._slopes = np.vstack([np.zeros(2), planes])
        self._climb = math.tan(steepest)
        self.steep = np.hypot(*self._slopes.T) > self._climb + BARELY
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
        for number in self._top_boxes.near(points):
            top = self.tops[number]
            over = np.flatnonzero(top.contains(points))
            found[number + 1, over] = top.height_at(points[over])
        for number in self._solid_boxes.near(points):
            bury(found, points, *self._every[number])
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
        mask[self.steep] = False
        for surface in range(len(mask)):
            rows, columns = _extent(mask[surface])
            level, carried = self.height[surface, rows, columns], mask[surface, rows, columns]
            for r, c in disc:
                rises = self.cell * (self._slopes @ np.array([c, r]))
                there = padded[:, _moved(rows, r + cells), _moved(columns, c + cells)]
                # Either surface goes on beyond the crease between them, up to the other's place.
                one = np.abs(there - level - rises[surface]) <= floor_max
                other = np.abs(there - rises[:, None, None] - level) <= floor_max
                carried &= (one | other).any(axis=0)
            self._carry_on_slopes(surface, (rows, columns), carried, padded, disc)
        return mask

    def _carry_on_slopes(
        self,
        surface: int,
        extent: tuple[slice, slice],
        carried: Mask,
        padded: Floats,
        disc: Sequence[tuple[int, int]],
    ) -> None:
        """Add the places from which slopes alone lead to all of the disc, as over a bevel.

        Args:
            surface: whose places they are.
            extent: its rows and columns.
            carried: (rows, columns) of the extent: where it is one floor, changed in place.
            padded: heights with the disc's reach in cells around them.
            disc: rows and columns from its middle.
        """
        at_row, at_column = np.nonzero(self.free[surface][extent] & ~carried)
        if self.steep[surface] or not len(at_row):
            return
        rows, columns = at_row + extent[0].start, at_column + extent[1].start
        reach = (padded.shape[1] - self.height.shape[1]) // 2
        walkable = np.where(self.steep[:, None, None], np.nan, padded)
        found = {(0, 0): self.height[surface, rows, columns]}
        for r, c in sorted(disc, key=lambda one: math.hypot(*one))[1:]:
            share = 1.0 - 1.0 / max(abs(r), abs(c))
            before = round(share * r), round(share * c)
            apart = self.cell * math.hypot(r - before[0], c - before[1])
            there = walkable[:, rows + r + reach, columns + c + reach]
            away = np.abs(there - found[before])
            best = np.where(np.isnan(away), np.inf, away).argmin(axis=0)
            every = np.arange(len(rows))
            joined = away[best, every] <= self._climb * apart + BARELY
            found[r, c] = np.where(joined, there[best, every], np.nan)
        on = np.isfinite(np.stack(list(found.values()))).all(axis=0)
        carried[at_row[on], at_column[on]] = True

    def barred(self, points: Floats, level: float, beside: float) -> Mask:
        """Say at which points (n, 2) what stands there or hangs leaves no room to climb.

        Args:
            points: world.
            level: of the soles, metres.
            beside: room that is asked for beside the middle of the feet, metres; below what hangs
                the robot's whole radius has to have room.
        """
        found = np.zeros(len(points), dtype=bool)
        for number in self._solid_boxes.near(points, max(beside, self._radius)):
            solid, _ = self._every[number]
            if solid.bars(level, self._tall):
                reach = self._radius if solid.low > level + LEG_ROOM else beside
                close = near(solid.outline, points, reach)
                found[close[signed_distance(solid.outline, points[close]) < reach]] = True
        return found

    def _room(self, points: Floats) -> Mask:
        """Say for each surface and point whether the cylinder stands free there."""
        level = self.heights(points)
        free = np.isfinite(level)
        for element, solids in zip(self._elements, self._solids, strict=True):
            least = LEG_ROOM if element.tops else FOOT_ROOM
            slope = element.tops[0] if len(element.tops) == 1 else None
            for solid in solids:
                close = near(solid.outline, points, self._radius)
                close = close[signed_distance(solid.outline, points[close]) < self._radius]
                there = level[:, close]
                high: Floats | float = solid.high
                if solid.field is not None:
                    high = solid.field.highest(points[close], self._radius)
                elif slope is not None and not solid.upright:
                    # Within the radius it is nowhere higher than this.
                    up = float(np.hypot(*slope_of(slope))) * self._radius
                    high = np.minimum(solid.high, slope.height_at(points[close]) + up)
                free[:, close] &= ~((high > there + least) & (solid.low < there + self._tall))
        return free


def slope_of(top: Top) -> tuple[float, float]:
    """Return the rise of a top along x and y, metres a metre; of a height field 0.

    Its slopes are in its heights, and found there from cell to cell.
    """
    normal = top.normal
    return float(-normal[0] / normal[2]), float(-normal[1] / normal[2])


def _extent(mask: Mask) -> tuple[slice, slice]:
    """Return the rows and columns in which a mask (rows, columns) holds anywhere."""
    found = []
    for axis in (1, 0):
        there = np.flatnonzero(mask.any(axis=axis))
        found.append(slice(int(there[0]), int(there[-1]) + 1) if len(there) else slice(0, 0))
    return found[0], found[1]


def _moved(part: slice, by: int) -> slice:
    return slice(part.start + by, part.stop + by)


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
