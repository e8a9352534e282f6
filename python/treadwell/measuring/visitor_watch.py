"""How soon the path leads around what was put in its way (Maier 2012, Fig. 6)."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from treadwell.course.course import CourseElement
from treadwell.course.outlines import signed_distance
from treadwell.episode import Episode
from treadwell.trace import Trace

Floats = NDArray[np.float64]

SEEN_POINTS = 20
"""Points of a frame on an element from which on it counts as seen."""
_MARGIN_M = 0.03
"""Points this near to an element count for it: the depth is noisy."""
_FLOOR_M = 0.05
"""Points lower than this may be the floor's."""
_SPACING_M = 0.02
"""Between the places at which a path is looked at."""


@dataclass(frozen=True, slots=True)
class Avoidance:
    """What happened after an element was put in the way.

    Attributes:
        blocked: s, when the path led through it first; None where it never did.
        seen: s, when the first picture was taken that has it; None without one.
        replanned: s, when a way was planned anew first, after both; None where none was.
        around: s, when the path led around all of it first, after both; None where it never did.
    """

    blocked: float | None
    seen: float | None
    replanned: float | None
    around: float | None

    def delay(self) -> float | None:
        """Return the time from when it was seen in the way to the first new way, s."""
        return self._since(self.replanned)

    def delay_around(self) -> float | None:
        """Return the time from then until the path led around all of it, s."""
        return self._since(self.around)

    def _since(self, time: float | None) -> float | None:
        if self.blocked is None or self.seen is None or time is None:
            return None
        return time - max(self.blocked, self.seen)


class VisitorWatch:
    """Looks at the path and at what is in the picture once an element was added."""

    def __init__(self, episode: Episode) -> None:
        """Watch this episode."""
        self._episode = episode
        absent = [element for element in episode.course.elements if not element.present]
        self._visitor = absent[0] if absent else None
        self._half_width = 0.5 * sum(
            leg.sole.width for leg in (episode.robot.file.legs.left, episode.robot.file.legs.right)
        )
        self._before: Floats = np.empty((0, 2))
        self._came = False
        self._blocked: float | None = None
        self._seen: float | None = None
        self._replans = 0
        self._replanned: float | None = None
        self._around: float | None = None

    def frame(self, trace: Trace) -> None:
        """Take in a camera frame."""
        visitor = self._visitor
        if visitor is None:
            return
        if visitor.name not in self._episode.events.present:
            self._before, self._replans = trace.path, self._episode.pilot.replans
            return
        offset = self._episode.events.place(visitor, self._episode.simulation.data)[:2]
        now = 1e-9 * trace.time_ns
        if not self._came and self._leads_through(self._before, trace, visitor, offset):
            self._blocked = now
        self._came = True
        if self._seen is None and _points_on(visitor, trace, offset) >= SEEN_POINTS:
            self._seen = 1e-9 * self._episode.pilot.planes().exposure_ns
        through = self._leads_through(trace.path, trace, visitor, offset)
        if self._blocked is None and through:
            self._blocked = now
        if self._seen is None or self._blocked is None:
            self._replans = self._episode.pilot.replans
            return
        if self._replanned is None and self._episode.pilot.replans > self._replans:
            self._replanned = now
        if self._around is None and len(trace.path) and not through:
            self._around = now

    def findings(self) -> Avoidance:
        """Return what was seen so far."""
        return Avoidance(self._blocked, self._seen, self._replanned, self._around)

    def _leads_through(
        self, path: Floats, trace: Trace, visitor: CourseElement, offset: Floats
    ) -> bool:
        """Say whether a robot as narrow as its feet would touch the element on a path, as it is."""
        if not len(path):
            return False
        return _distance(visitor, _in_world(_dense(path), trace) - offset) < self._half_width


def _points_on(visitor: CourseElement, trace: Trace, offset: Floats) -> int:
    """Count a frame's points on an element, by where the camera truly was."""
    points_in_map = trace.points()
    if points_in_map is None:
        return 0
    points = points_in_map[np.isfinite(points_in_map[:, 0])].astype(np.float64)
    places = _in_world(points, trace)
    high = points[:, 2] - trace.map_from_robot[2, 3] > _FLOOR_M
    inside = np.zeros(len(points), dtype=bool)
    for piece in visitor.pieces:
        inside |= signed_distance(piece.outline, places[:, :2] - offset) <= _MARGIN_M
    return int((inside & high).sum())


def _in_world(points: Floats, trace: Trace) -> Floats:
    """Return the true places (n, 2) of points (n, 2 or 3) that the robot has in its map."""
    turn = trace.truth_from_robot @ np.linalg.inv(trace.map_from_robot)
    moved: Floats = points[:, :2] @ turn[:2, :2].T + turn[:2, 3]
    return moved


def _dense(path: Floats) -> Floats:
    """Return a path with places no further apart than a spacing, (m, 2)."""
    places = [path[:1]]
    for begin, end in pairwise(path):
        count = max(1, math.ceil(math.dist(begin, end) / _SPACING_M))
        shares = np.arange(1, count + 1)[:, None] / count
        places.append(begin + shares * (end - begin))
    return np.vstack(places)


def _distance(visitor: CourseElement, places: Floats) -> float:
    """Return the least distance of places (n, 2) from an element, m; negative inside."""
    return min(float(signed_distance(piece.outline, places).min()) for piece in visitor.pieces)
