"""Scans of a laser that sweeps a plane, shown as points: no model of the ground."""

import numpy as np
from numpy.typing import NDArray

from treadwell.map_memory import OBSTACLE, UNKNOWN, RememberedMap

_MOST_CELLS = 2**26


class PointsMap:
    """Counts the points in each cell of the plane."""

    def __init__(self, cell: float) -> None:
        """Begin with nothing.

        Args:
            cell: m, side of a cell.
        """
        self._cell = cell
        self._hits: dict[tuple[int, int], int] = {}

    def insert(self, points: NDArray[np.float64]) -> bool:
        """Take in points (n, 3) m of the map frame; whether there were any."""
        cells = np.floor(points[np.isfinite(points).all(axis=1), :2] / self._cell).astype(np.int64)
        for col, row in np.unique(cells, axis=0).tolist():
            key = (row, col)
            self._hits[key] = self._hits.get(key, 0) + 1
        return bool(len(cells))

    def map(self) -> RememberedMap:
        """Return the cells: an obstacle where a scan had a point, else unknown."""
        if not self._hits:
            empty = np.zeros((0, 0))
            return RememberedMap(
                (0.0, 0.0),
                self._cell,
                empty.astype(np.uint8),
                empty.astype(np.float32),
                empty.astype(np.uint16),
            )
        cells = np.array(list(self._hits), dtype=np.int64)
        low = cells.min(axis=0)
        rows, cols = (cells.max(axis=0) - low + 1).tolist()
        if rows * cols > _MOST_CELLS:
            raise ValueError(f"{rows} x {cols} cells are too many")
        kind = np.full((rows, cols), UNKNOWN, np.uint8)
        at = tuple((cells - low).T)
        kind[at] = OBSTACLE
        height = np.full((rows, cols), np.nan, np.float32)
        height[at] = 0.0
        sightings = np.zeros((rows, cols), np.uint16)
        sightings[at] = np.minimum(list(self._hits.values()), np.iinfo(np.uint16).max)
        origin = (float(low[1] * self._cell), float(low[0] * self._cell))
        return RememberedMap(origin, self._cell, kind, height, sightings)
