"""The window of a map in square pieces: which of them differ from what was recorded of them last.

Most of a map stays as it is from one frame to the next: a map that was told does but for what is
seen of it, one that is made but for where the robot looks.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell.map_memory import UNKNOWN

SIDE: Final = 32
"""Cells. Twice as many give three times the bytes, half as many twice the pieces."""

Floats = NDArray[np.floating]
_Corner = tuple[int, int]


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """The cells of a kind in some tiles, one tile after the other.

    Attributes:
        tiles: their names; a name belongs to a place on the map.
        ends: index behind the last cell of each tile, after a 0.
        x: (n,) m, of the cells' middles.
        y: (n,) m.
        height: (n,) m.
    """

    tiles: list[str]
    ends: list[int]
    x: Floats
    y: Floats
    height: NDArray[np.float32]

    def split(self, *values: NDArray[Any]) -> Iterator[tuple[str, list[NDArray[Any]]]]:
        """Yield each tile's name with its part of values (n, ...) of the cells."""
        for name, (begin, end) in zip(self.tiles, pairwise(self.ends), strict=True):
            yield name, [value[begin:end] for value in values]


class Tiles:
    """Holds a map's window against that before it. Tiles are fixed to the map, not to the robot."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self._origin, self._cell = (0.0, 0.0), 1.0
        self._corner: _Corner = (0, 0)
        self._kind = np.zeros((0, 0), np.uint8)
        self._height = np.zeros((0, 0), np.float32)
        # Both as they are now and as they were before, in one array of whole tiles.
        self._low: _Corner = (0, 0)
        self._kinds = (self._kind, self._kind)
        self._heights = (self._height, self._height)
        self._differ = np.zeros((0, 0), np.bool_)

    def update(
        self,
        origin: tuple[float, float],
        cell: float,
        kind: NDArray[np.uint8],
        height: NDArray[np.float32],
    ) -> bool:
        """Take in the window as it is now; say whether it is another one than before.

        Args:
            origin: (x, y) m, lower-left corner of the window in the map frame.
            cell: m, side of a cell; windows differ by whole cells.
            kind: (rows, cols) uint8: 0 unknown, 1 floor, 2 obstacle; rows along +y.
            height: (rows, cols) float32, m.
        """
        if cell != self._cell or not self._kind.size:
            # Another lattice. Its first window takes the place of the one before.
            self._origin, self._cell = origin, cell
        col = round((origin[0] - self._origin[0]) / cell)
        row = round((origin[1] - self._origin[1]) / cell)
        known = np.where(kind == UNKNOWN, np.float32(0.0), height)
        before = self._corner, self._kind, self._height
        self._corner, self._kind, self._height = (row, col), kind, known
        spans = [_span(self._corner, kind.shape)]
        if before[1].size:
            spans.append(_span(before[0], before[1].shape))
        rows, cols = ([span[axis] for span in spans] for axis in (0, 1))
        self._low = low = min(s.start for s in rows), min(s.start for s in cols)
        shape = max(s.stop for s in rows) - low[0], max(s.stop for s in cols) - low[1]
        self._kinds, self._heights = (
            (_placed(now, self._corner, low, shape), _placed(old, before[0], low, shape))
            for now, old in ((kind, before[1]), (known, before[2]))
        )
        # Bit by bit: NaN is as it was, too.
        heights = [values.view(np.uint32) for values in self._heights]
        self._differ = (self._kinds[0] != self._kinds[1]) | (heights[0] != heights[1])
        return bool(self._differ.any())

    def changed(self, kind: int, *, every: bool = False) -> Cells:
        """Return the cells of a kind in the tiles in which one of them came, went or moved.

        Args:
            kind: 1 floor, 2 obstacle.
            every: in all tiles that have any.
        """
        now, before = (kinds == kind for kinds in self._kinds)
        tiles = _by_tile(self._differ & (now | before))
        if every:
            tiles |= _by_tile(now)
        count = tiles.shape[1]
        here = np.flatnonzero(tiles)
        row, col = np.nonzero(now & tiles.repeat(SIDE, axis=0).repeat(SIDE, axis=1))
        tile = row // SIDE * count + col // SIDE
        order = np.argsort(tile, kind="stable")
        row, col = row[order], col[order]
        ends = np.searchsorted(tile[order], here, side="right")
        first = self._low[0] // SIDE, self._low[1] // SIDE
        return Cells(
            [f"{first[1] + i % count}_{first[0] + i // count}" for i in here.tolist()],
            [0, *ends.tolist()],
            self._origin[0] + (self._low[1] + col + 0.5) * self._cell,
            self._origin[1] + (self._low[0] + row + 0.5) * self._cell,
            self._heights[0][row, col],
        )


def _span(corner: _Corner, shape: tuple[int, ...]) -> tuple[slice, slice]:
    """Return which rows and columns of the lattice the tiles under a window have."""
    rows, cols = (
        slice(first // SIDE * SIDE, -(-(first + count) // SIDE) * SIDE)
        for first, count in zip(corner, shape, strict=True)
    )
    return rows, cols


def _placed(
    window: NDArray[Any], corner: _Corner, low: _Corner, shape: tuple[int, int]
) -> NDArray[Any]:
    """Return a window amid nothing, in an array that begins at `low`."""
    placed = np.zeros(shape, window.dtype)
    row, col = corner[0] - low[0], corner[1] - low[1]
    if window.size:
        placed[row : row + window.shape[0], col : col + window.shape[1]] = window
    return placed


def _by_tile(cells: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Say for each tile whether a cell of it is marked."""
    rows, cols = cells.shape
    tiles = cells.reshape(rows // SIDE, SIDE, cols // SIDE, SIDE)
    return np.asarray(tiles.any((1, 3)))
