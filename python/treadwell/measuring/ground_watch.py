"""How true a map's ground is in the end: on planes, at edges, and where something has been."""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell.episode import Episode
from treadwell.map_memory import FLOOR, MapMemory, RememberedMap
from treadwell.measuring.map_watch import MapFrame, MapWatch
from treadwell.measuring.score import LEAST_SIGHTINGS, true_cells
from treadwell.trace import Trace

Floats = NDArray[np.float64]

EDGE_M: Final = 0.015
"""Levels of neighbouring cells that differ by this are an edge: two cells of a slope do not."""
NEAR_M: Final = 0.010
"""A height within this of a level is that level's."""


@dataclass(frozen=True, slots=True)
class GroundErrors:
    """The floor cells of a map that were seen three times or more, against the truth.

    Attributes:
        planes: cells that lie on one surface as a whole.
        plane_median: m, median of how far they are off, up or down; NaN without any.
        plane_rms: m, root of the mean square of the same.
        edges: cells at an edge between two levels, two either side.
        within: those of them that have the height of one of their true neighbours.
        between: those that have none of these, but one between them.
    """

    planes: int
    plane_median: float
    plane_rms: float
    edges: int
    within: int
    between: int


@dataclass(frozen=True, slots=True)
class GroundFindings:
    """What a run's map had.

    Attributes:
        errors: in the end, of all that the robot ever had in its map.
        frames: of what moves, comes or goes, frame by frame; nothing where nothing does.
    """

    errors: GroundErrors
    frames: tuple[MapFrame, ...]


class GroundWatch:
    """Keeps the map of a run, and watches what moves, comes or goes."""

    def __init__(self, episode: Episode) -> None:
        """Watch this episode."""
        self._episode = episode
        self._memory = MapMemory()
        moves = any(element.mocap_id is not None for element in episode.course.elements)
        self._moving = MapWatch(episode) if moves else None

    def frame(self, trace: Trace) -> None:
        """Take in a camera frame."""
        arrays = (trace.view_kind, trace.view_height, trace.sightings)
        self._memory.update(
            trace.view_origin, trace.view_cell, *arrays, forgotten=trace.maps_forgotten
        )
        if self._moving is not None:
            self._moving.frame(trace)

    def findings(self) -> GroundFindings:
        """Return what was seen so far."""
        frames = () if self._moving is None else self._moving.findings().frames
        return GroundFindings(ground_errors(self._episode, self._memory.map()), frames)


def ground_errors(episode: Episode, found: RememberedMap) -> GroundErrors:
    """Hold a map, in the world frame, against what stands there now."""
    if not found.kind.size:
        return GroundErrors(0, np.nan, np.nan, 0, 0, 0)
    events, data = episode.events, episode.simulation.data
    places = {
        element.name: events.place(element, data)
        for element in episode.course.elements
        if element.name in events.present
    }
    headroom = episode.robot.file.body.height
    truth = true_cells(events.course_now(), found, headroom, places)
    known = (found.kind == FLOOR) & (found.sightings >= LEAST_SIGHTINGS) & ~truth.obstacle
    plane = known & truth.floor
    off = np.abs(found.height[plane].astype(np.float64) - truth.height[plane])
    edge, within, between = at_edges(found.height.astype(np.float64), truth.height)
    return GroundErrors(
        planes=int(plane.sum()),
        plane_median=float(np.median(off)) if off.size else np.nan,
        plane_rms=float(np.sqrt(np.mean(off**2))) if off.size else np.nan,
        edges=int((known & edge).sum()),
        within=int((known & edge & within).sum()),
        between=int((known & edge & between).sum()),
    )


def at_edges(height: Floats, truth: Floats) -> tuple[NDArray[np.bool_], ...]:
    """Say of each cell whether it lies at an edge, at a neighbour's level, or between levels.

    Args:
        height: (rows, cols) m, of the map.
        truth: (rows, cols) m.
    """
    touching, beyond = _around(truth, 1), _around(truth, 2)
    steps = touching.max(axis=0) - touching.min(axis=0) >= EDGE_M
    edge: NDArray[np.bool_] = np.any(_around(steps, 1), axis=0)
    with np.errstate(invalid="ignore"):
        near: NDArray[np.bool_] = np.any(np.abs(height - touching) <= NEAR_M, axis=0)
        some_level = np.any(np.abs(height - beyond) <= NEAR_M, axis=0)
        inside = (height > beyond.min(axis=0)) & (height < beyond.max(axis=0))
    return edge, near, inside & ~some_level


def _around(values: NDArray[Any], reach: int) -> NDArray[Any]:
    """Return what the cells within a reach of each have, (n, rows, cols)."""
    rows, cols = values.shape
    padded = np.pad(values, reach, mode="edge")
    side = range(2 * reach + 1)
    return np.stack([padded[r : r + rows, c : c + cols] for r in side for c in side])
