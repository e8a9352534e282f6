"""What the map last said of every cell, also of those that a robot-centred window left behind."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

UNKNOWN, FLOOR, OBSTACLE = 0, 1, 2
"""Values of a cell's kind."""
_SPARE = 32
"""Cells by which the memory grows beyond what is needed."""


@dataclass(frozen=True, slots=True, eq=False)
class RememberedMap:
    """Cells of the map frame; arrays are [row, col], rows along +y, columns along +x.

    Attributes:
        origin: (x, y) m, lower-left corner of cell (0, 0).
        cell: m, side of a cell.
        kind: (rows, cols) uint8: 0 unknown, 1 floor, 2 obstacle.
        height: (rows, cols) float32, m; NaN where unknown.
        sightings: (rows, cols) uint16: in how many frames the cell was seen as floor.
    """

    origin: tuple[float, float]
    cell: float
    kind: NDArray[np.uint8]
    height: NDArray[np.float32]
    sightings: NDArray[np.uint16]

    def centres(self) -> NDArray[np.float64]:
        """Return the cells' centres, (rows, cols, 2) m."""
        rows, cols = self.kind.shape
        x = self.origin[0] + (np.arange(cols) + 0.5) * self.cell
        y = self.origin[1] + (np.arange(rows) + 0.5) * self.cell
        return np.stack(np.meshgrid(x, y), axis=-1)


class MapMemory:
    """Keeps each cell's last value. A cell that comes back into the window unseen keeps it, too.

    What the core forgets since it lies in the wrong place is forgotten here, too.
    """

    def __init__(self) -> None:
        """Begin with nothing."""
        self._forgotten = 0
        self._forget()

    def _forget(self) -> None:
        self._cell = 0.0
        self._origin = (0.0, 0.0)
        self._corner = (0, 0)
        self._kind = np.zeros((0, 0), dtype=np.uint8)
        self._height = np.zeros((0, 0), dtype=np.float32)
        self._sightings = np.zeros((0, 0), dtype=np.uint16)
        # Cells whose value is older than the window's present stay there.
        self._kept = np.zeros((0, 0), dtype=bool)
        self._window: tuple[int, int, int, int] | None = None
        # Where nothing older stays, a window in its place is but the newest one.
        self._newest: tuple[NDArray[np.uint8], NDArray[np.float32], NDArray[np.uint16]] | None = (
            None
        )

    def update(
        self,
        origin: tuple[float, float],
        cell: float,
        kind: NDArray[np.uint8],
        height: NDArray[np.float32],
        sightings: NDArray[np.uint16],
        *,
        forgotten: int = 0,
    ) -> None:
        """Take in the window as it is now; its arrays may not change afterwards.

        Args:
            origin: (x, y) m, lower-left corner of the window in the map frame.
            cell: m, side of a cell; windows differ by whole cells.
            kind: (rows, cols) uint8.
            height: (rows, cols) float32, m.
            sightings: (rows, cols) uint16.
            forgotten: how often the core has forgotten its map (`Pilot.maps_forgotten`). Once more
                than at the last update: what lay in that one's window is unknown.
        """
        if forgotten != self._forgotten:
            self._forgotten = forgotten
            self._forget_window()
        if self._cell != cell:
            self._forget()  # another lattice: nothing carries over
            self._cell, self._origin = cell, origin
        col = round((origin[0] - self._origin[0]) / cell)
        row = round((origin[1] - self._origin[1]) / cell)
        rows, cols = kind.shape
        if self._newest is not None:
            if self._window == (row, col, row + rows, col + cols):
                self._newest = (kind, height, sightings)
                return
            self._write_newest()
        self._make_room(row, col, row + rows, col + cols)
        self._mark_entering(row, col, row + rows, col + cols)
        r, c = row - self._corner[0], col - self._corner[1]
        here = np.s_[r : r + rows, c : c + cols]
        if not self._kept[here].any():
            self._newest = (kind, height, sightings)
            return
        fresh = (kind != UNKNOWN) | ~self._kept[here]
        np.copyto(self._kind[here], kind, where=fresh)
        np.copyto(self._height[here], height, where=fresh)
        np.copyto(self._sightings[here], sightings, where=~self._kept[here])
        back = fresh & self._kept[here]
        self._sightings[here][back] = np.maximum(self._sightings[here][back], sightings[back])
        self._kept[here] &= ~fresh

    def map(self) -> RememberedMap:
        """Return all cells that were ever in the window; arrays are views."""
        self._write_newest()
        x = self._origin[0] + self._corner[1] * self._cell
        y = self._origin[1] + self._corner[0] * self._cell
        return RememberedMap((x, y), self._cell, self._kind, self._height, self._sightings)

    def _forget_window(self) -> None:
        """Forget what lay in the last window; what had left it before stays."""
        if self._window is None:
            return
        row, col, end_row, end_col = self._window
        top, left = self._corner
        here = np.s_[row - top : end_row - top, col - left : end_col - left]
        self._kind[here], self._height[here], self._sightings[here] = UNKNOWN, np.nan, 0
        self._kept[here] = False
        self._newest = None

    def _write_newest(self) -> None:
        """Write down the window that is but the newest one."""
        if self._newest is None or self._window is None:
            return
        row, col, end_row, end_col = self._window
        top, left = self._corner
        here = np.s_[row - top : end_row - top, col - left : end_col - left]
        self._kind[here], self._height[here], self._sightings[here] = self._newest
        self._newest = None

    def _mark_entering(self, row: int, col: int, end_row: int, end_col: int) -> None:
        """Keep what is remembered of the cells that were outside the window before."""
        window, self._window = self._window, (row, col, end_row, end_col)
        if window == self._window:
            return
        entering = np.ones((end_row - row, end_col - col), dtype=bool)
        if window is not None:
            top, left = max(window[0], row) - row, max(window[1], col) - col
            bottom, right = min(window[2], end_row) - row, min(window[3], end_col) - col
            if bottom > top and right > left:
                entering[top:bottom, left:right] = False
        r, c = row - self._corner[0], col - self._corner[1]
        here = np.s_[r : r + end_row - row, c : c + end_col - col]
        self._kept[here] |= entering & (self._kind[here] != UNKNOWN)

    def _make_room(self, row: int, col: int, end_row: int, end_col: int) -> None:
        """Grow the arrays where the window reaches beyond them."""
        have_rows, have_cols = self._kind.shape
        if not have_rows:
            self._corner = (row, col)
        below, left = self._corner[0] - row, self._corner[1] - col
        above = end_row - (self._corner[0] + have_rows)
        right = end_col - (self._corner[1] + have_cols)
        if max(below, left, above, right) <= 0:
            return
        pads = [side + _SPARE if side > 0 else 0 for side in (below, above, left, right)]
        widths = ((pads[0], pads[1]), (pads[2], pads[3]))
        self._kind = np.pad(self._kind, widths)
        self._height = np.pad(self._height, widths, constant_values=np.nan)
        self._sightings = np.pad(self._sightings, widths)
        self._kept = np.pad(self._kept, widths)
        self._corner = (self._corner[0] - pads[0], self._corner[1] - pads[2])
