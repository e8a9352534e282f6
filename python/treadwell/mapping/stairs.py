"""Stairs in a map of one's own."""

import json
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell._core import FloorView, Stair, Ways
from treadwell.core_settings import over
from treadwell.errors import InputError
from treadwell.mapping.map import Map

Point = tuple[float, float, float]
Edge = tuple[Point, Point]

_BEFORE_CELLS: Final = 3
"""Cells before an edge within which the ground in front of it is looked for; the first may have
seen both levels."""


@dataclass(frozen=True, slots=True)
class FoundStair:
    """One surface to step on; the world's frame, metres.

    Attributes:
        front: left and right end of the edge that is crossed onto it.
        back: left and right end of the edge that is crossed off it, or where the view of it ended.
        height: of the surface.
        rise: change of height onto it, from the ground or the stair before it; NaN where that was
            not seen.
        tread: from the front to the back edge.
        width: room along the front edge.
        edge_sigma: standard deviation of the front edge's place, across it; None where no step
            was fitted to it, and it is only as exact as the map's cells.
        reason: why the robot does not step on it, `word: sentence`; None where it does.
    """

    front: Edge
    back: Edge
    height: float
    rise: float
    tread: float
    width: float
    edge_sigma: float | None
    reason: str | None


def find_stairs(world: Map) -> tuple[FoundStair, ...]:
    """Return the stairs that a map's pictures showed, the nearest to the last camera first.

    They are as the recognizer has them (Gutmann, Fukuchi and Fujita 2004): level surfaces with a
    step before them, merged over the pictures, their edges fitted to the depths.

    Args:
        world: a map that was told its robot, whose limits the reasons have.

    Raises:
        InputError: the map has no robot or no camera, or no picture was taken in yet.
    """
    # Late: MuJoCo reads the robot, and a map without one does without it.
    from treadwell.robot.load import load_robot

    if world.robot is None or world.camera is None:
        raise InputError('find_stairs: the map needs a camera and a robot: Map(..., robot="qrio")')
    found = world.core.staircase()
    robot = load_robot(world.robot)
    tables = over(robot.file.navigation, {})
    ways = Ways("a_star", json.dumps(robot.description()), json.dumps(tables))
    stairs = () if found is None else tuple(found.stairs)
    view = world.core.view()
    rises = [_rise(stair, stairs, view) for stair in stairs]
    return tuple(
        _found(stair, rise, _reason(ways, stair, rise, _behind(stair, stairs, view.cell)), world)
        for stair, rise in zip(stairs, rises, strict=True)
    )


def _found(stair: Stair, rise: float, reason: str | None, world: Map) -> FoundStair:
    """Return a stair in the world's frame."""
    x, y, z = world.offset.tolist()

    def moved(edge: Edge) -> Edge:
        (ax, ay, az), (bx, by, bz) = edge
        return (ax + x, ay + y, az + z), (bx + x, by + y, bz + z)

    return FoundStair(
        front=moved(stair.front),
        back=moved(stair.back),
        height=stair.height + z,
        rise=rise,
        tread=stair.depth,
        width=_width(stair),
        edge_sigma=None if stair.front_fit is None else stair.front_fit[1],
        reason=reason,
    )


def _reason(ways: Ways, stair: Stair, rise: float, behind: Stair | None) -> str | None:
    """Return why no foot is put on a stair, None where feet fit."""
    if not np.isfinite(rise):
        return "unseen: the ground before it was not seen"
    edge = None if behind is None else (stair.depth, behind.height - stair.height)
    return ways.unfit(rise, _width(stair), edge)


def _width(stair: Stair) -> float:
    return float(np.linalg.norm(np.subtract(*stair.front))) + sum(stair.margins)


def _middle(edge: Edge) -> NDArray[np.float64]:
    left, right = np.array(edge)
    return np.asarray(0.5 * (left + right), np.float64)


def _behind(stair: Stair, stairs: tuple[Stair, ...], cell: float) -> Stair | None:
    """Return the stair whose front edge is this one's back edge."""
    return next(
        (one for one in stairs if one is not stair and _joined(stair.back, one.front, cell)), None
    )


def _joined(back: Edge, front: Edge, within: float) -> bool:
    """Whether two edges are one, seen from above, as near as a cell of the map tells, m."""
    return float(np.hypot(*(_middle(back) - _middle(front))[:2])) < within


def _rise(stair: Stair, stairs: tuple[Stair, ...], view: FloorView) -> float:
    """Return the change of height onto a stair, m; NaN where what lies before it was not seen."""
    before = next(
        (one for one in stairs if one is not stair and _joined(one.back, stair.front, view.cell)),
        None,
    )
    if before is not None:
        return stair.height - before.height
    middle = _middle(stair.front)[:2]
    onward = np.asarray(stair.reference)[:2] - middle
    onward = onward / max(float(np.hypot(*onward)), 1e-9)
    heights, floor = view.height, view.kind == 1
    for cells in range(2, 2 + _BEFORE_CELLS):
        at = middle - cells * view.cell * onward
        col, row = np.floor((at - view.origin) / view.cell).astype(int)
        inside = 0 <= row < heights.shape[0] and 0 <= col < heights.shape[1]
        if inside and floor[row, col]:
            return stair.height - float(heights[row, col])
    return float("nan")
