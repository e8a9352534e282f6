"""The score: errors of localization and map against the truth."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.course.course import Course, CourseElement
from treadwell.course.outlines import near, signed_distance
from treadwell.course.pieces import Top
from treadwell.judging.result import MapCounts, SurfaceEntry
from treadwell.map_memory import FLOOR, OBSTACLE, RememberedMap
from treadwell.measuring.true_levels import told_levels

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
PlacedTop = tuple[CourseElement, Top, Floats]
"""An element, one of its tops, and how far it stands from where the course has it, (3,) m."""

LEAST_SIGHTINGS = 3
"""Frames that must have seen a cell as floor for it to count as one."""
HEIGHT_TOLERANCE = 0.015
"""Metres by which a floor cell may be off and still be right: less than another level would be."""

_CENTRE: Final = (0, 0)
_CORNERS: Final = (_CENTRE, (-1, -1), (-1, 1), (1, -1), (1, 1))
"""Places of a cell, in half cells from its middle."""


@dataclass(frozen=True, slots=True, eq=False)
class TrueCells:
    """What truly is in each cell of a remembered map; arrays (rows, cols).

    Attributes:
        floor: the whole cell lies on one walkable surface, clear of everything else.
        height: m, of that surface: of several above each other the one that the map is nearest to.
        obstacle: the cell's centre lies in an obstacle that the robot could run into.
        whole: its corners do, too: as a floor cell, it is nothing else.
        lid: m, height of that obstacle's level top, NaN where it has none: a floor at that height
            is what a box's top is to Gutmann 2005 (section III), whoever may stand on it.
    """

    floor: Bools
    height: Floats
    obstacle: Bools
    whole: Bools
    lid: Floats


def true_cells(
    course: Course,
    remembered: RememberedMap,
    headroom: float,
    places: Mapping[str, Floats] | None = None,
) -> TrueCells:
    """Sort the cells of a map by the truth.

    Args:
        course: what stands where.
        remembered: the map, in the world frame.
        headroom: m, height of the robot: what hangs higher above the floor is no obstacle.
        places: name -> (3,) m by which an element stands away from where the course has it, for
            the elements that are there now; None: as at the beginning.
    """
    centres = remembered.centres().reshape(-1, 2)
    half_diagonal = remembered.cell * np.sqrt(0.5)
    height, clear = np.zeros(len(centres)), np.ones(len(centres), dtype=bool)
    elements = _present(course, places)
    for element, offset in elements:
        for top in element.tops:
            points, outline = centres - offset[:2], top.polygon[:, :2]
            close = near(outline, points, half_diagonal)
            distance = signed_distance(outline, points[close])
            clear[close] &= np.abs(distance) >= half_diagonal
            level = np.where(distance <= 0.0, top.height_at(points[close]) + offset[2], 0.0)
            height[close] = np.maximum(level, height[close])
    height = told_levels(elements, centres, height, _told(remembered))
    obstacle = np.zeros((len(_CORNERS), len(centres)), dtype=bool)
    lid = np.full(len(centres), np.nan)
    for element, offset in elements:
        if element.walkable:
            continue
        has_lid = len(element.pieces) == 1 and element.pieces[0].has_level_top
        for piece in element.pieces:
            bottom = float(piece.vertices[:, 2].min() + offset[2])
            top_z = float(piece.vertices[:, 2].max() + offset[2])
            # Cells farther off than one of their own are clear of it.
            close = near(piece.outline, centres - offset[:2], remembered.cell)
            floor = height[close]
            matters = (bottom < floor + headroom) & (top_z > floor + 1e-6)
            for inside, corner in zip(obstacle, _CORNERS, strict=True):
                points = centres[close] + 0.5 * remembered.cell * np.array(corner) - offset[:2]
                distance = signed_distance(piece.outline, points)
                here = matters & (distance <= 0.0)
                inside[close] |= here
                if corner == _CENTRE:
                    if has_lid:
                        lid[close[here]] = np.fmax(lid[close[here]], top_z)
                    clear[close] &= ~matters | (distance >= half_diagonal)
    shape = remembered.kind.shape
    return TrueCells(
        floor=(clear & ~obstacle[0]).reshape(shape),
        height=height.reshape(shape),
        obstacle=obstacle[0].reshape(shape),
        whole=np.all(obstacle, axis=0).reshape(shape),
        lid=lid.reshape(shape),
    )


def map_counts(remembered: RememberedMap, truth: TrueCells) -> MapCounts:
    """Return how much of the map is right.

    The cells that count are true floor seen as floor three times or more, and true floor or
    obstacle that the map now calls an obstacle, or an obstacle that it calls floor.
    """
    kind, seen = remembered.kind, remembered.sightings >= LEAST_SIGHTINGS
    floor = truth.floor & (seen | (kind == OBSTACLE))
    obstacle = truth.obstacle & ((kind == OBSTACLE) | ((kind == FLOOR) & seen))
    off = np.abs(np.nan_to_num(remembered.height, nan=np.inf) - truth.height)
    right = floor & (kind == FLOOR) & (off <= HEIGHT_TOLERANCE)
    with np.errstate(invalid="ignore"):
        on_lid = (kind == FLOOR) & (np.abs(remembered.height - truth.lid) <= HEIGHT_TOLERANCE)
    called_floor = obstacle & (kind == FLOOR) & ~on_lid
    whole = obstacle & truth.whole
    return MapCounts(
        floor_cells=int(floor.sum()),
        floor_cells_right=_share(right, floor),
        obstacle_cells=int(obstacle.sum()),
        obstacle_cells_right=_share(obstacle & ~called_floor, obstacle),
        floor_called_obstacle=_share(floor & (kind == OBSTACLE), floor),
        obstacle_called_floor=_share(called_floor, obstacle),
        whole_obstacle_cells=int(whole.sum()),
        whole_obstacle_called_floor=_share(called_floor & whole, whole),
    )


def surfaces(
    course: Course,
    remembered: RememberedMap,
    passed: Floats,
    places: Mapping[str, Floats] | None = None,
) -> list[SurfaceEntry]:
    """Return every walkable top with the mean height of its interior cells.

    A top without a cell is listed only when the robot has passed over it.

    Args:
        course: what stands where.
        remembered: the map, in the world frame.
        passed: (n, 2) m, where the robot has truly been.
        places: as for `true_cells`.
    """
    centres = remembered.centres().reshape(-1, 2)
    usable = ((remembered.kind == FLOOR) & (remembered.sightings >= LEAST_SIGHTINGS)).ravel()
    heights, told = remembered.height.ravel(), _told(remembered)
    elements = _present(course, places)
    tops = [(e, top, offset) for e, offset in elements for top in e.tops]
    entries = []
    for element, top, offset in tops:
        # What another top covers is not walked on.
        close = near(top.polygon[:, :2], centres - offset[:2], 0.0)
        free = usable.copy()
        free[close] &= ~_covered(centres[close], top, offset, tops)
        # Nor is it this top where the map has the way below it.
        here = top.height_at(centres[close] - offset[:2]) + offset[2]
        free[close] &= told_levels(elements, centres[close], here, told[close]) == here
        cells = _interior(top, centres - offset[:2], remembered.cell, free)
        if not cells.any() and not _is_passed(passed, top, offset, tops):
            continue
        truth = top.height + offset[2]
        if cells.any():
            # On a slope the truth is that of the same cells.
            truth = float(top.height_at(centres[cells] - offset[:2]).mean() + offset[2])
        entries.append(
            SurfaceEntry(
                element=element.name,
                part=top.part,
                truth=round(float(truth), 9),
                estimate=float(heights[cells].astype(np.float64).mean()) if cells.any() else None,
                cells=int(cells.sum()),
            )
        )
    return entries


def _told(remembered: RememberedMap) -> Floats:
    """Return the heights of the map's floors, (n,) m, row by row; NaN elsewhere."""
    floor = remembered.kind.ravel() == FLOOR
    return np.where(floor, remembered.height.ravel().astype(np.float64), np.nan)


def _interior(top: Top, centres: Floats, cell: float, usable: Bools) -> Bools:
    """Say for each square cell, by its centre (n, 2), whether it counts as inside a top.

    Those do whose circumscribed circle lies on the top, or, on a top too narrow for that as a sill
    may be, those that lie on it whole: a cell at an edge may have the next surface's height.
    """
    polygon = top.polygon[:, :2]
    inside: Bools = np.zeros(len(centres), dtype=bool)
    close = near(polygon, centres, 0.0)
    close = close[usable[close]]
    inside[close] = -signed_distance(polygon, centres[close]) >= cell * np.sqrt(0.5)
    if inside.any():
        return inside
    edges = np.roll(polygon, -1, axis=0) - polygon
    inward = np.column_stack([-edges[:, 1], edges[:, 0]]) / np.linalg.norm(edges, axis=1)[:, None]
    # A square reaches so far from its centre towards each edge.
    reach = cell / 2 * np.abs(inward).sum(axis=1)
    depth = ((centres[close][:, None, :] - polygon[None]) * inward[None]).sum(axis=-1)
    inside[close] = (depth >= reach - 1e-9).all(axis=1)
    return inside


def _covered(points: Floats, top: Top, offset: Floats, tops: Sequence[PlacedTop]) -> Bools:
    """Say for each point (n, 2) whether another top lies above this one there."""
    height = top.height_at(points - offset[:2]) + offset[2]
    covered = np.zeros(len(points), dtype=bool)
    for _, other, shift in tops:
        there = points - shift[:2]
        covered |= other.contains(there) & (other.height_at(there) + shift[2] > height + 1e-6)
    return covered


def _is_passed(passed: Floats, top: Top, offset: Floats, tops: Sequence[PlacedTop]) -> bool:
    """Say whether one of the points (n, 2) lies on a top, uncovered."""
    if not len(passed):
        return False
    on_it = top.contains(passed - offset[:2]) & ~_covered(passed, top, offset, tops)
    return bool(on_it.any())


def _present(
    course: Course, places: Mapping[str, Floats] | None
) -> list[tuple[CourseElement, Floats]]:
    if places is None:
        return [(element, np.zeros(3)) for element in course.elements if element.present]
    return [(e, places[e.name]) for e in course.elements if e.name in places]


def _share(part: Bools, whole: Bools) -> float:
    count = int(whole.sum())
    return float(part.sum()) / count if count else 0.0
