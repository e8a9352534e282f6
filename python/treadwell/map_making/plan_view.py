"""Scans of a laser that sweeps a plane, as a map of that plane: occupancy, or lines."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from treadwell._core import OccupancyMap, find_lines
from treadwell.map_making.plan_topology import Topology
from treadwell.map_making.points_map import PointsMap
from treadwell.map_memory import FLOOR, OBSTACLE, UNKNOWN, RememberedMap
from treadwell.map_result import MappedLine, MappedLines

OCCUPANCY: Final = "occupancy_2d"
LINES: Final = "lines"
TOPOLOGY: Final = "topology"
POINTS: Final = "points"
ALIGNMENT: Final = "alignment"
SCAN_MODELS: Final = (OCCUPANCY, LINES, TOPOLOGY, POINTS)
"""World models of scans; the first where none is named."""
HELD: Final = 0.9
"""Share of the points that lines hold where nobody says how much: furniture is no line."""
_FREE: Final = 0.45
"""A cell is free that is less probably occupied."""


@dataclass(frozen=True)
class Seen:
    """What a picture shows beside the cells.

    Attributes:
        probability: (rows, cols) how probably each cell is occupied, where the model says so.
        lines: where the model has them.
        topology: places and ways, where the model has them.
    """

    probability: NDArray[np.float32] | None
    lines: MappedLines | None
    topology: Topology | None


class PlanView(Protocol):
    """What keeps a map of scans."""

    def insert(self, points: NDArray[np.float64], eye: NDArray[np.float64]) -> bool:
        """Take in a scan; whether it said anything.

        Args:
            points: (n, 3) m of the map frame, NaN for nothing seen.
            eye: (3,) m, where the laser was.
        """
        ...

    def map(self) -> RememberedMap:
        """Return the cells."""
        ...

    def probability(self) -> NDArray[np.float32] | None:
        """Return how probably each cell of `map` is occupied, (rows, cols); NaN where unknown."""
        ...

    def lines(self) -> MappedLines | None:
        """Return the lines where the model has them."""
        ...


class ScanPoints:
    """Where the points are: no model."""

    def __init__(self, cell: float) -> None:
        """Begin with nothing.

        Args:
            cell: m, side of a cell.
        """
        self._points = PointsMap(cell)

    def insert(self, points: NDArray[np.float64], eye: NDArray[np.float64]) -> bool:  # noqa: ARG002
        """Take in a scan; whether it said anything."""
        return self._points.insert(points)

    def map(self) -> RememberedMap:
        """Return the cells: an obstacle where a scan had a point, else unknown."""
        return self._points.map()

    def probability(self) -> None:
        """Return None: nothing is known of where no point is."""
        return

    def lines(self) -> MappedLines | None:
        """Return None: points are no lines."""
        return None


class ScanOccupancy:
    """Which cells are occupied, free or unknown (handbook, section 36.2.1)."""

    def __init__(self, settings: Mapping[str, Any]) -> None:
        """Begin with nothing.

        Args:
            settings: key -> value of `[navigation.occupancy_2d]`.

        Raises:
            InputError: one of them cannot be used.
        """
        self._core = OccupancyMap(json.dumps(dict(settings)))
        self._obstacle = float(settings.get("obstacle", 0.6))

    def insert(self, points: NDArray[np.float64], eye: NDArray[np.float64]) -> bool:
        """Take in a scan; whether it said anything."""
        flat = np.ascontiguousarray(points[:, :2], np.float64)
        return self._core.insert(flat, (float(eye[0]), float(eye[1]))) > 0

    def map(self) -> RememberedMap:
        """Return the cells as far as anything was seen, floor where they are free."""
        origin, cell, probability, looks = self._seen()
        kind = np.full(probability.shape, UNKNOWN, np.uint8)
        kind[probability < _FREE] = FLOOR
        kind[probability > self._obstacle] = OBSTACLE
        height = np.where(kind == UNKNOWN, np.nan, 0.0).astype(np.float32)
        return RememberedMap(origin, cell, kind, height, np.where(kind == FLOOR, looks, 0))

    def probability(self) -> NDArray[np.float32]:
        """Return how probably each cell is occupied; NaN where nothing was seen."""
        return self._seen()[2]

    def lines(self) -> MappedLines | None:
        """Return None: a grid has no lines."""
        return None

    def _seen(
        self,
    ) -> tuple[tuple[float, float], float, NDArray[np.float32], NDArray[np.uint16]]:
        (x, y), cell, probability, looks = self._core.cells()
        known = looks > 0
        if not known.any():
            return (x, y), cell, probability[:0, :0], looks[:0, :0]
        rows, cols = (np.flatnonzero(known.any(axis=axis)) for axis in (1, 0))
        here = (slice(rows[0], rows[-1] + 1), slice(cols[0], cols[-1] + 1))
        origin = (x + float(cols[0]) * cell, y + float(rows[0]) * cell)
        return origin, cell, probability[here], looks[here]


class ScanLines(ScanPoints):
    """The lines that the points lie on (handbook, section 36.2.2), found when asked for."""

    def __init__(
        self, cell: float, settings: Mapping[str, Any], alignment: Mapping[str, Any]
    ) -> None:
        """Begin with nothing.

        Args:
            cell: m, side of the cells in which the points are shown.
            settings: key -> value of `[plan_view.lines]`.
            alignment: key -> value of `[plan_view.alignment]`; where nothing is set, the scans stay
                where they are.

        Raises:
            InputError: one of them cannot be used.
        """
        super().__init__(cell)
        self._settings = json.dumps(dict(settings))
        self._alignment = json.dumps(dict(alignment)) if alignment else None
        self._find(np.zeros((0, 2)), [], np.zeros((0, 2)))
        self._scans: list[NDArray[np.float64]] = []
        self._eyes: list[NDArray[np.float64]] = []
        self._found: MappedLines | None = None

    def insert(self, points: NDArray[np.float64], eye: NDArray[np.float64]) -> bool:
        """Take in a scan; whether it said anything."""
        seen = points[np.isfinite(points).all(axis=1), :2]
        self._scans.append(seen)
        self._eyes.append(eye[:2])
        self._found = None
        return super().insert(points, eye)

    def lines(self) -> MappedLines:
        """Return the lines of all scans."""
        if self._found is None:
            points = np.concatenate(self._scans) if self._scans else np.zeros((0, 2))
            of = [at for at, scan in enumerate(self._scans) for _ in scan]
            eyes = np.array(self._eyes, np.float64).reshape(-1, 2)
            found = self._find(np.ascontiguousarray(points), of, eyes)
            line, ends = found["line"], found["ends"]
            each = [
                MappedLine(
                    normal=float(found["normal"][at]),
                    distance=float(found["distance"][at]),
                    share=float(found["share"][at]),
                    stretches=[tuple(row) for row in ends[line == at].tolist()],
                )
                for at in range(len(found["normal"]))
            ]
            self._found = MappedLines(count=len(each), held=float(found["held"]), each=each)
        return self._found

    def _find(
        self, points: NDArray[np.float64], scan: list[int], eyes: NDArray[np.float64]
    ) -> dict[str, Any]:
        if self._alignment is None:
            return find_lines(points, self._settings)
        return find_lines(points, self._settings, scan=scan, eyes=eyes, alignment=self._alignment)


def plan_view(world_model: str, cell: float, settings: Mapping[str, Mapping[str, Any]]) -> PlanView:
    """Return what keeps the map of scans.

    Args:
        world_model: one of `SCAN_MODELS`.
        cell: m, side of a cell.
        settings: table -> key -> value: `occupancy_2d`, `lines` and `alignment`.

    Raises:
        InputError: a setting cannot be used.
    """
    if world_model == OCCUPANCY:
        return ScanOccupancy({"cell": cell, **settings.get(OCCUPANCY, {})})
    if world_model == TOPOLOGY:
        return ScanOccupancy({"cell": cell, **settings.get(OCCUPANCY, {})})
    if world_model == LINES:
        lines = {"held": HELD, **settings.get(LINES, {})}
        return ScanLines(cell, lines, settings.get(ALIGNMENT, {}))
    return ScanPoints(cell)


def plan_arrays(
    probability: NDArray[np.float32] | None, lines: MappedLines | None
) -> dict[str, NDArray[np.float32] | NDArray[np.float64]]:
    """Return what `map.npz` has beside the cells: probabilities, or the ends of the lines."""
    if probability is not None:
        return {"probability": probability}
    if lines is not None:
        ends = [stretch for line in lines.each for stretch in line.stretches]
        return {"lines": np.array(ends, np.float64).reshape(-1, 4)}
    return {}


def placed_lines(found: MappedLines | None, offset: NDArray[np.float64]) -> MappedLines | None:
    """Return lines moved by an offset (3,) m."""
    if found is None:
        return None
    x, y, _ = offset.tolist()
    each = [
        MappedLine(
            normal=line.normal,
            distance=line.distance
            + x * float(np.cos(line.normal))
            + y * float(np.sin(line.normal)),
            share=line.share,
            stretches=[(a + x, b + y, c + x, d + y) for a, b, c, d in line.stretches],
        )
        for line in found.each
    ]
    return MappedLines(count=found.count, held=found.held, each=each)
