"""A straight way over edges of the true course, and whether a robot can climb along it."""

from typing import Final

import numpy as np

from treadwell.course.outlines import Floats
from treadwell.solving.robot_limits import Limits
from treadwell.solving.true_ground import Mask, TrueGround

PROBE: Final = 0.005
"""Metres between two looks at the ground along a line over an edge."""
LONGEST_FLIGHT: Final = 6.0
"""Metres of treads in a row, on none of which the robot can stand as on a floor."""
MOST_EDGES: Final = 40
PART: Final = 40
"""Probes that are made at a time."""
FLAT: Final = 0.01
"""Metres by which a tread may differ from side to side."""

Node = tuple[int, int, int]
"""Surface, row and column."""


class ClimbLine:
    """A straight way over an edge: the ground along it, looked at as far as it is asked for."""

    def __init__(
        self, ground: TrueGround, stand: Mask, limits: Limits, foot: Floats, ahead: Floats
    ) -> None:
        """Look at nothing yet.

        Args:
            ground: the course.
            stand: where the robot can stand.
            limits: the robot's.
            foot: a point of the edge.
            ahead: unit vector, the way of walking.
        """
        self._ground, self._stand, self._limits = ground, stand, limits
        self._foot, self._ahead = foot, ahead
        self._side = limits.half_width * np.array([-ahead[1], ahead[0]])
        self._known: dict[int, Floats] = {}
        self._barred: dict[tuple[int, float], Mask] = {}

    def climb(self) -> tuple[Node, Node] | None:
        """Return from where to where it leads; None where the robot cannot go."""
        for surface in np.flatnonzero(np.isfinite(self._heights(-1))):
            level = float(self._heights(-1)[surface])
            behind = self._follow(level, -1)
            ahead = None if behind is None else self._follow(level, 1)
            if behind is None or ahead is None or not ahead[1]:
                continue
            edges = [(at, -rise) for at, rise in reversed(behind[1])] + ahead[1]
            if self._fits(edges):
                return behind[0], ahead[0]
        return None

    def _follow(self, level: float, way: int) -> tuple[Node, list[tuple[float, float]]] | None:
        """Go along the line until the robot could stand; return where, and the edges between."""
        edges: list[tuple[float, float]] = []
        for i in range(-1, way * int(LONGEST_FLIGHT / PROBE), way):
            heights = self._heights(i)
            if not np.isfinite(heights).any():
                return None
            surface = int(np.nanargmin(np.abs(heights - level)))
            rise = float(heights[surface]) - level
            if abs(rise) > self._limits.floor_max:
                edges.append(((i + 0.5) * PROBE - way * PROBE / 2, rise))
            level = float(heights[surface])
            if self._is_barred(i, level):
                return None
            x, y = self._point((i + 0.5) * PROBE)
            row, column = self._ground.index(x, y)
            inside = 0 <= row < self._stand.shape[1] and 0 <= column < self._stand.shape[2]
            if not inside or len(edges) > MOST_EDGES:
                return None
            # Ahead there has to be the edge that the line is about, or one stands still.
            if self._stand[surface, row, column] and (edges or way < 0):
                return (surface, row, column), edges
        return None

    def _fits(self, edges: list[tuple[float, float]]) -> bool:
        limits = self._limits
        for number, (at, rise) in enumerate(edges):
            own = limits.for_(rise)
            if abs(rise) > own.highest + limits.tolerance:
                return False
            beyond = 0.05
            if number + 1 < len(edges):
                depth = edges[number + 1][0] - at
                following = limits.for_(edges[number + 1][1])
                needed = own.front_x_limit + limits.sole - following.back_x_limit
                if depth < needed - PROBE:
                    return False
                beyond = depth / 2
            if not self._wide(at + beyond):
                return False
        return True

    def _wide(self, at: float) -> bool:
        """Say whether both feet have the same floor at a place of the line."""
        middle = self._foot + at * self._ahead
        three = self._ground.heights(np.stack([middle, middle - self._side, middle + self._side]))
        return all(
            bool((np.abs(three[:, side][:, None] - three[:, 0][None, :]) <= FLAT).any())
            for side in (1, 2)
        )

    def _point(self, at: float) -> tuple[float, float]:
        x, y = (self._foot + at * self._ahead).tolist()
        return x, y

    def _heights(self, i: int) -> Floats:
        """Return the surfaces' heights at the i-th place from the edge; never on the edge.

        What is too steep is no surface to climb over.
        """
        part, place = divmod(i, PART)
        if part not in self._known:
            heights = self._ground.heights(self._places(part))
            heights[self._ground.steep] = np.nan
            self._known[part] = heights
        found: Floats = self._known[part][:, place]
        return found

    def _is_barred(self, i: int, level: float) -> bool:
        """Say whether something stands or hangs in the way at the i-th place."""
        part, place = divmod(i, PART)
        key = part, round(level, 3)
        if key not in self._barred:
            beside = self._limits.half_width
            self._barred[key] = self._ground.barred(self._places(part), level, beside)
        return bool(self._barred[key][place])

    def _places(self, part: int) -> Floats:
        at = PROBE * (np.arange(part * PART, (part + 1) * PART) + 0.5)
        places: Floats = self._foot + at[:, None] * self._ahead
        return places
