"""A height field of a course: the ground that a file draws, with its true height everywhere."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final, Self

import mujoco
import numpy as np

from treadwell.course.outlines import Floats
from treadwell.course.pieces import Piece, Top

FINENESS: Final = 6
"""What is the highest within a radius is looked for in blocks of this part of it, or of a cell."""


@dataclass(frozen=True, eq=False)
class HeightField:
    """A height field that stands upright.

    Between its heights it is made of the triangles that MuJoCo makes: each cell is cut from its
    first corner to the one opposite.

    Attributes:
        heights: (rows, columns) of the surface, world z, m; rows along its y, columns along its x.
        middle: (2,) world x, y, m.
        turn: (2, 2) world from field, as seen from above.
        half: (2,) m, half its extent along x and y.
        bottom: world z down to which it is solid, m.
    """

    heights: Floats
    middle: Floats
    turn: Floats
    half: Floats
    bottom: float

    @property
    def corners(self) -> Floats:
        """Its outline as seen from above, (4, 2) world, counter-clockwise, m."""
        signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
        corners: Floats = self.middle + (signs * self.half) @ self.turn.T
        return corners

    @cached_property
    def spacing(self) -> Floats:
        """Metres between two heights along x and y, (2,)."""
        rows, columns = self.heights.shape
        spacing: Floats = 2.0 * self.half / [columns - 1, rows - 1]
        return spacing

    def surface(self, points: Floats) -> Floats:
        """Return the height at world points (n, 2), m; beyond its edges that of the edge."""
        along, across = self._in_cells(points).T
        rows, columns = self.heights.shape
        column = np.clip(along.astype(np.intp), 0, columns - 2)
        row = np.clip(across.astype(np.intp), 0, rows - 2)
        along, across = along - column, across - row
        first, last = self.heights[row, column], self.heights[row + 1, column + 1]
        corner = np.where(
            across >= along, self.heights[row + 1, column], self.heights[row, column + 1]
        )
        most, least = np.maximum(along, across), np.minimum(along, across)
        found: Floats = first + most * (corner - first) + least * (last - corner)
        return found

    def upward(self, points: Floats) -> Floats:
        """Return the upward part of the surface's unit normal at world points (n, 2)."""
        along, across = self._in_cells(points).T
        rows, columns = self.heights.shape
        column = np.clip(along.astype(np.intp), 0, columns - 2)
        row = np.clip(across.astype(np.intp), 0, rows - 2)
        low, right = self.heights[row, column], self.heights[row, column + 1]
        left, high = self.heights[row + 1, column], self.heights[row + 1, column + 1]
        first = across - row >= along - column
        rise_x = np.where(first, high - left, right - low) / self.spacing[0]
        rise_y = np.where(first, left - low, high - right) / self.spacing[1]
        upward: Floats = 1.0 / np.sqrt(1.0 + rise_x**2 + rise_y**2)
        return upward

    def highest(self, points: Floats, radius: float) -> Floats:
        """Return the greatest height within a radius of world points (n, 2), m.

        To within a block, which is a sixth of the radius, or a cell where that is more.
        """
        side = max(radius / FINENESS, *self.spacing)
        rows, columns = self.heights.shape
        at_column = (np.arange(columns) * self.spacing[0] / side).astype(np.intp)
        at_row = (np.arange(rows) * self.spacing[1] / side).astype(np.intp)
        reach = math.ceil(radius / side)
        most = np.full((at_row[-1] + 1 + 2 * reach, at_column[-1] + 1 + 2 * reach), -np.inf)
        np.maximum.at(most, (at_row[:, None] + reach, at_column[None, :] + reach), self.heights)
        column, row = (self._in_cells(points) * self.spacing / side).astype(np.intp).T
        found = np.full(len(points), -np.inf)
        for i in range(2 * reach + 1):
            for j in range(2 * reach + 1):
                if math.hypot(i - reach, j - reach) * side <= radius:
                    found = np.maximum(found, most[row + i, column + j])
        return found

    def multiplied(self, factor: float) -> "HeightField":
        """Return the field with all its lengths multiplied, its distance from the origin, too."""
        return replace(
            self,
            heights=factor * self.heights,
            middle=factor * self.middle,
            half=factor * self.half,
            bottom=factor * self.bottom,
        )

    def _in_cells(self, points: Floats) -> Floats:
        """Return where points (n, 2) lie, in columns and rows from the first height, (n, 2)."""
        last = np.array(self.heights.shape)[::-1] - 1.0
        cells: Floats = ((points - self.middle) @ self.turn + self.half) / self.spacing
        return np.clip(cells, 0.0, last)


@dataclass(frozen=True)
class FieldTop(Top):
    """The surface of a height field: it is walkable, and no plane.

    Its `polygon` is the outline at the mean height.
    """

    field: HeightField

    def height_at(self, points: Floats) -> Floats:
        """Return the height of the surface at the points (n, 2), m."""
        return self.field.surface(points)

    def multiplied(self, factor: float) -> Self:
        """Return the surface with all its lengths multiplied."""
        return replace(super().multiplied(factor), field=self.field.multiplied(factor))


@dataclass(frozen=True)
class FieldPiece(Piece):
    """The solid of a height field, from its bottom to its surface; `vertices` are its box's."""

    field: HeightField

    @property
    def is_filled(self) -> bool:
        """It is, by what it is."""
        return True

    def top_at(self, points: Floats) -> Floats:
        """Return the height of the surface at points (n, 2), m."""
        return self.field.surface(points)

    def multiplied(self, factor: float) -> Self:
        """Return the solid with all its lengths multiplied."""
        return replace(super().multiplied(factor), field=self.field.multiplied(factor))


def height_field(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> HeightField:
    """Return the height field that a geom is, where it stands.

    Args:
        model: compiled.
        data: after `mj_kinematics`.
        geom: the id of an upright geom of this type.
    """
    number = int(model.geom_dataid[geom])
    rows, columns = int(model.hfield_nrow[number]), int(model.hfield_ncol[number])
    begin = int(model.hfield_adr[number])
    shares = model.hfield_data[begin : begin + rows * columns].reshape(rows, columns)
    *half, top, bottom = model.hfield_size[number]
    x, y, z = data.geom_xpos[geom]
    return HeightField(
        heights=z + top * shares.astype(np.float64),
        middle=np.array([x, y]),
        turn=data.geom_xmat[geom].reshape(3, 3)[:2, :2].copy(),
        half=np.array(half),
        bottom=float(z - bottom),
    )
