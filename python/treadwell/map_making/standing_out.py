"""What stands on the ground of a cloud that was seen from above: houses, trees, cars."""

import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from treadwell._core import ground_points
from treadwell.map_memory import FLOOR, OBSTACLE, RememberedMap


class StandingOut:
    """Takes a cloud's points apart, and puts what is no ground back into the map as obstacles."""

    def __init__(self, settings: dict[str, Any]) -> None:
        """Begin with nothing.

        Args:
            settings: key -> value, of the ground filter.
        """
        self._settings = json.dumps(settings)
        self._others = np.zeros((0, 3))

    def ground(self, points: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return which of the points (n, 3) m, map frame, are ground; the others are kept.

        Raises:
            InputError: a setting cannot be used.
        """
        ground = ground_points(points, self._settings)
        self._others = np.concatenate([self._others, points[~ground]])
        return ground

    def over(self, found: RememberedMap) -> RememberedMap:
        """Return the map of the ground with what stands on it as obstacles."""
        rows, cols = found.kind.shape
        at = np.floor((self._others[:, :2] - np.array(found.origin)) / found.cell).astype(np.intp)
        inside = ((at >= 0) & (at < [cols, rows])).all(axis=1)
        place = (at[inside, 1], at[inside, 0])
        tops = np.full((rows, cols), -np.inf, np.float32)
        np.maximum.at(tops, place, self._others[inside, 2].astype(np.float32))
        counts = np.zeros((rows, cols), np.int64)
        np.add.at(counts, place, 1)
        stands = (counts > 0) & ((found.kind != FLOOR) | (found.sightings == 0) | (counts > 1))
        kind, height = found.kind.copy(), found.height.copy()
        kind[stands], height[stands] = OBSTACLE, tops[stands]
        return RememberedMap(found.origin, found.cell, kind, height, found.sightings)
