"""Scans of a laser as places and the ways between them: the Voronoi graph of the free cells."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from treadwell._core import VoronoiGraph
from treadwell.map_memory import FLOOR, RememberedMap
from treadwell.map_result import MappedDoorway, MappedPlace, MappedPlaces, MappedWay


@dataclass(frozen=True)
class Topology:
    """The graph of a map, and its rooms (handbook, section 36.2.3).

    Attributes:
        graph: of the free cells.
        room_of: (rows, cols) number of each cell's room, 0 for none.
        offset: (2,) m from the frame of the graph to that of the world.
    """

    graph: VoronoiGraph
    room_of: NDArray[np.uint32]
    offset: NDArray[np.float64]

    @staticmethod
    def of(
        found: RememberedMap, settings: Mapping[str, Any], offset: NDArray[np.float64]
    ) -> "Topology":
        """Return that of a map's floor.

        Args:
            found: the map, in the frame of the graph.
            settings: key -> value of `[plan_view.topology]`.
            offset: (2,) m from that frame to the world's.

        Raises:
            InputError: a setting cannot be used.
        """
        free = np.ascontiguousarray(found.kind == FLOOR)
        graph = VoronoiGraph(free, found.cell, found.origin, json.dumps(dict(settings)))
        return Topology(graph, graph.rooms()[0], offset)

    @cached_property
    def paths(self) -> list[NDArray[np.float64]]:
        """Points of each way, (k, 2) m of the world."""
        return [path + self.offset for _, _, path in self.graph.ways()]

    def places(self) -> MappedPlaces:
        """Return places, ways and doorways, as the result has them."""
        positions, clearances, degrees = self.graph.places()
        middles, widths, joined = self.graph.rooms()[1:]
        each = [
            MappedPlace(position=_point(position + self.offset), clearance=clearance, ways=degree)
            for position, clearance, degree in zip(
                positions, clearances.tolist(), degrees.tolist(), strict=True
            )
        ]
        ways = [
            MappedWay(
                places=places,
                length=float(np.hypot(*np.diff(path, axis=0).T).sum()),
                clearance=clearance,
            )
            for places, clearance, path in self.graph.ways()
        ]
        doorways = [
            MappedDoorway(position=_point(middle + self.offset), width=width, rooms=_pair(rooms))
            for middle, width, rooms in zip(middles, widths.tolist(), joined, strict=True)
        ]
        return MappedPlaces(
            count=len(each),
            each=each,
            ways=ways,
            rooms=int(self.room_of.max(initial=0)),
            doorways=doorways,
        )

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Return what `map.npz` has of it: rooms, and the points of the ways with their numbers."""
        numbered = [
            np.column_stack([np.full(len(path), number), path])
            for number, path in enumerate(self.paths)
        ]
        ways = np.concatenate(numbered) if numbered else np.zeros((0, 3))
        return {"room": self.room_of, "ways": ways}


def _point(xy: NDArray[np.float64]) -> tuple[float, float]:
    return float(xy[0]), float(xy[1])


def _pair(numbers: NDArray[np.uint32]) -> tuple[int, int]:
    return int(numbers[0]), int(numbers[1])
