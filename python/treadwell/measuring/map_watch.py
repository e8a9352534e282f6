"""How soon the map follows a world that changes: each frame's cells against the truth of then.

The claims of Gutmann, Fukuchi and Fujita 2005, section V: what was removed vanishes from the map,
and while a box moves no cell is of a height between its top and the floor.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from treadwell.course.course import CourseElement
from treadwell.course.levels import surface_height
from treadwell.episode import Episode
from treadwell.map_memory import FLOOR, OBSTACLE, RememberedMap
from treadwell.measuring.cells import covered_by, lattice
from treadwell.trace import Trace

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

BETWEEN_M = 0.010
"""A height that is further than this from a box's top and from the floor is that of neither."""


@dataclass(frozen=True, slots=True)
class MapFrame:
    """What the map has, at one frame, where something that can move is or was.

    Attributes:
        time: s.
        covered: cells that something that can move covers now.
        found: those of them that the map has as floor at its height, within `BETWEEN_M`.
        left: cells that such a thing has left.
        stale: those of them that are an obstacle to the map, or a floor that is no longer there.
        floors: cells of either kind that the map has as floor.
        between: those of them with a height between what stands there or stood there and the floor.
    """

    time: float
    covered: int
    found: int
    left: int
    stale: int
    floors: int
    between: int


@dataclass(frozen=True, slots=True)
class MapHistory:
    """What the map had frame by frame, and the whole map now and then.

    Attributes:
        frames: an entry a camera frame.
        pictures: the map as it was before each event that happened, and in the end.
        outlines: for each of those the true outlines of what stood there then, (n, 2) m each.
    """

    frames: tuple[MapFrame, ...]
    pictures: tuple[RememberedMap, ...]
    outlines: tuple[tuple[Floats, ...], ...] = ()


class MapWatch:
    """Watches the cells that movable elements cover or have covered."""

    def __init__(self, episode: Episode) -> None:
        """Watch this episode."""
        self._episode = episode
        elements = episode.course.elements
        self._movable = [element for element in elements if element.mocap_id is not None]
        self._fixed = [top for e in elements if e.mocap_id is None for top in e.tops]
        self._visited: dict[tuple[int, int], float] = {}
        self._frames: list[MapFrame] = []
        self._fired = 0
        self._pictures: list[tuple[RememberedMap, tuple[Floats, ...]]] = []
        self._last: tuple[RememberedMap, tuple[Floats, ...]] | None = None

    def frame(self, trace: Trace) -> None:
        """Take in a camera frame."""
        fired = len(self._episode.events.fired)
        if fired > self._fired and self._last is not None:
            self._pictures.append(self._last)
        self._fired = fired
        self._last = (_picture(trace), self._outlines())
        centres, cells = lattice(trace)
        top_now = np.full(len(centres), -np.inf)
        for element in self._movable:
            if element.name in self._episode.events.present:
                place = self._episode.events.place(element, self._episode.simulation.data)
                inside = covered_by(element, centres - place[:2])
                top_now[inside] = np.maximum(top_now[inside], _top(element) + place[2])
        covered = np.isfinite(top_now)
        for index in np.flatnonzero(covered):
            key = cells[index]
            self._visited[key] = max(self._visited.get(key, -np.inf), float(top_now[index]))
        highest = np.array([self._visited.get(key, -np.inf) for key in cells])
        left = np.isfinite(highest) & ~covered
        floor = surface_height(self._fixed, centres)
        self._frames.append(_sorted(trace, covered, top_now, left, floor, highest))

    def findings(self) -> MapHistory:
        """Return what was seen so far."""
        shown = [*self._pictures, *([] if self._last is None else [self._last])]
        maps, outlines = tuple(one for one, _ in shown), tuple(some for _, some in shown)
        return MapHistory(tuple(self._frames), maps, outlines)

    def _outlines(self) -> tuple[Floats, ...]:
        """Return the outlines of all that stands there now, (n, 2) m each."""
        events, data = self._episode.events, self._episode.simulation.data
        return tuple(
            piece.outline + events.place(element, data)[:2]
            for element in self._episode.course.elements
            if element.mocap_id is None or element.name in events.present
            for piece in element.pieces
        )


def _picture(trace: Trace) -> RememberedMap:
    """Return the window of one frame."""
    arrays = (trace.view_kind, trace.view_height, trace.sightings)
    return RememberedMap(trace.view_origin, trace.view_cell, *arrays)


def _sorted(
    trace: Trace, covered: Bools, top_now: Floats, left: Bools, floor: Floats, highest: Floats
) -> MapFrame:
    """Count the cells of one frame; all arrays are (n,), row by row."""
    kind = trace.view_kind.ravel()
    height = trace.view_height.ravel().astype(np.float64)
    known = (kind == FLOOR) & (covered | left)
    with np.errstate(invalid="ignore"):
        found = known & covered & (np.abs(height - top_now) <= BETWEEN_M)
        wrong = (kind == FLOOR) & (height > floor + BETWEEN_M)
        between = known & (height > floor + BETWEEN_M) & (height < highest - BETWEEN_M)
    stale = left & (wrong | (kind == OBSTACLE))
    counts = (covered, found, left, stale, known, between)
    return MapFrame(1e-9 * trace.time_ns, *(int(cells.sum()) for cells in counts))


def _top(element: CourseElement) -> float:
    """Return the height of its highest point where the course puts it, m."""
    return max(float(piece.vertices[:, 2].max()) for piece in element.pieces)
