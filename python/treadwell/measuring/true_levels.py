"""On which of the levels that lie above each other a map's cell is: the truth knows them all."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.course.course import CourseElement
from treadwell.course.outlines import near, signed_distance

Floats = NDArray[np.float64]
Placed = Sequence[tuple[CourseElement, Floats]]
"""Elements, and how far each stands from where the course has it, (3,) m."""

BARELY_M: Final = 1e-3
BURIED_M: Final = 5e-3
"""Metres: what something solid reaches above by this is no level there."""


def told_levels(elements: Placed, points: Floats, highest: Floats, told: Floats) -> Floats:
    """Return the level of each point that a told height is nearest to, m.

    Args:
        elements: what is there.
        points: (n, 2) world.
        highest: (n,) of the levels there, m.
        told: (n,) m, as a map has it; NaN where it has no floor: there it is the highest.
    """
    level = highest.copy()
    off = np.abs(told - level)
    # Below the highest, by a map's own word, is what few cells are: the rest costs nothing.
    lower = np.flatnonzero(told < highest - BURIED_M)
    _take(elements, points, lower, np.zeros(len(lower)), None, (level, off, told))
    for element, offset in elements:
        for top in element.tops:
            close = lower[near(top.polygon[:, :2], points[lower] - offset[:2], 0.0)]
            there = points[close] - offset[:2]
            over = top.contains(there)
            values = top.height_at(there[over]) + offset[2]
            _take(elements, points, close[over], values, element, (level, off, told))
    return level


def _take(
    elements: Placed,
    points: Floats,
    at: NDArray[np.intp],
    values: Floats,
    whose: CourseElement | None,
    known: tuple[Floats, Floats, Floats],
) -> None:
    """Take a surface where it is nearer to what is told than what is known, in place.

    Args:
        elements: what is there.
        points: (n, 2) world.
        at: which of them lie on the surface.
        values: its heights there, m.
        whose: its element; None: the ground.
        known: level, how far off it is, and what is told, (n,) each.
    """
    level, off, told = known
    nearer = np.abs(told[at] - values) < off[at]
    at, values = at[nearer], values[nearer]
    if not len(at):
        return
    free = np.ones(len(at), dtype=bool)
    for element, offset in elements:
        for piece in element.pieces if element.walkable else ():
            if element is whose and not piece.is_filled:
                continue  # a slope lies in the box around it
            there = points[at] - offset[:2]
            close = near(piece.outline, there, 0.0)
            inside = close[signed_distance(piece.outline, there[close]) < 0.0]
            low = piece.vertices[:, 2].min() + offset[2]
            high = piece.top_at(there[inside]) + offset[2]
            buried = (low <= values[inside] + BARELY_M) & (values[inside] < high - BURIED_M)
            free[inside[buried]] = False
    level[at[free]] = values[free]
    off[at[free]] = np.abs(told[at[free]] - values[free])
