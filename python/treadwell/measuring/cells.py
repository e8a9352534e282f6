"""The cells of a frame's map: where they lie, and what stands there."""

import numpy as np
from numpy.typing import NDArray

from treadwell.course.course import CourseElement
from treadwell.course.outlines import signed_distance
from treadwell.trace import Trace

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


def lattice(trace: Trace) -> tuple[Floats, list[tuple[int, int]]]:
    """Return the cells' centres, (n, 2) m, and their places in the map, row by row."""
    rows, cols = trace.view_kind.shape
    cell, (x, y) = trace.view_cell, trace.view_origin
    first_row, first_col = round(y / cell), round(x / cell)
    indices = np.indices((rows, cols)).reshape(2, -1).T
    centres = (indices[:, ::-1] + 0.5) * cell + np.array([x, y])
    places = indices + np.array([first_row, first_col])
    return centres, [(int(row), int(col)) for row, col in places]


def covered_by(element: CourseElement, points: Floats) -> Bools:
    """Say for each point (n, 2) whether a piece of the element lies over or under it."""
    inside = np.zeros(len(points), dtype=bool)
    for piece in element.pieces:
        inside |= signed_distance(piece.outline, points) <= 0.0
    return inside
