"""The heights to stand on at a point of a course, several where one lies above another."""

from collections.abc import Sequence

import numpy as np

from treadwell.course.outlines import Floats, signed_distance
from treadwell.course.pieces import Piece, Top


def surface_height(tops: Sequence[Top], points: Floats) -> Floats:
    """Return the height of the highest of the tops, or the ground, at points (n, 2), metres."""
    height = np.zeros(len(points))
    for top in tops:
        over = top.contains(points)
        height[over] = np.maximum(height[over], top.height_at(points[over]))
    return height


def levels(tops: Sequence[Top], solids: Sequence[Piece], x: float, y: float) -> list[float]:
    """Return the heights of the surfaces at a point, lowest first; what is built over is none.

    Args:
        tops: the walkable surfaces.
        solids: the pieces under them.
        x: metres, world.
        y: metres, world.
    """
    point = np.array([[x, y]])
    above = [top for top in tops if top.contains(point)[0]]
    heights = sorted({0.0, *(round(float(top.height_at(point)[0]), 6) for top in above)})
    spans = [
        (piece.vertices[:, 2].min(), piece.top_at(point)[0])
        for piece in solids
        if piece.is_filled and signed_distance(piece.outline, point)[0] < 0.0
    ]
    return [h for h in heights if not any(low <= h + 1e-3 and h < top - 5e-3 for low, top in spans)]
