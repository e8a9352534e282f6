"""Outlines seen from above: directions, rectangles, convex polygons and distances from them."""

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def heading(yaw: float) -> Floats:
    """Return the unit vector (x, y) of a yaw."""
    return np.array([math.cos(yaw), math.sin(yaw)])


def left_of(yaw: float) -> Floats:
    """Return the unit vector (x, y) to the left of a yaw."""
    return np.array([-math.sin(yaw), math.cos(yaw)])


def rectangle(
    position: Sequence[float] | Floats, yaw: float, along: tuple[float, float], width: float
) -> Floats:
    """Return the corners (4, 2) of a rectangle, counter-clockwise.

    Args:
        position: its reference point, world x, y.
        yaw: direction of its length.
        along: where it begins and ends along that direction, from the reference point.
        width: across, half to either side.
    """
    ahead, left = heading(yaw), left_of(yaw)
    corners = [(along[0], -1), (along[1], -1), (along[1], 1), (along[0], 1)]
    return np.array(
        [np.asarray(position) + a * ahead + side * width / 2 * left for a, side in corners]
    )


def convex_outline(points: Floats) -> Floats:
    """Return the convex hull of points (n, 2), counter-clockwise (Andrew's monotone chain)."""
    ordered = sorted({(float(x), float(y)) for x, y in points})
    if len(ordered) < 3:
        return np.array(ordered)

    def chain(sequence: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
        hull: list[tuple[float, float]] = []
        for p in sequence:
            while (
                len(hull) > 1
                and (
                    (hull[-1][0] - hull[-2][0]) * (p[1] - hull[-2][1])
                    - (hull[-1][1] - hull[-2][1]) * (p[0] - hull[-2][0])
                )
                <= 0.0
            ):
                hull.pop()
            hull.append(p)
        return hull[:-1]

    return np.array(chain(ordered) + chain(ordered[::-1]))


def signed_distance(polygon: Floats, points: Floats) -> Floats:
    """Return the distance of points (n, 2) from a convex polygon (m, 2), negative inside, metres.

    The polygon's corners are counter-clockwise.
    """
    begin = polygon[None, :, :]
    edge = np.roll(polygon, -1, axis=0)[None, :, :] - begin
    offset = points[:, None, :] - begin
    length2 = np.maximum((edge**2).sum(-1), 1e-18)
    share = np.clip((offset * edge).sum(-1) / length2, 0.0, 1.0)
    distance = np.linalg.norm(offset - share[..., None] * edge, axis=-1).min(axis=1)
    side = edge[..., 0] * offset[..., 1] - edge[..., 1] * offset[..., 0]
    inside = (side >= 0.0).all(axis=1)
    signed: Floats = np.where(inside, -distance, distance)
    return signed


def near(outline: Floats, points: Floats, margin: float) -> npt.NDArray[np.intp]:
    """Return the indices (k,) of the points (n, 2) in the box around an outline and a margin, m.

    What is asked of an outline is asked of these alone: a map has a hundred times as many cells.
    """
    (left, bottom), (right, top) = outline.min(axis=0) - margin, outline.max(axis=0) + margin
    x, y = points[:, 0], points[:, 1]
    return np.flatnonzero((x >= left) & (x <= right) & (y >= bottom) & (y <= top))


def clipped(polygon: Floats, point: Floats, normal: Floats) -> Floats:
    """Return the part of a convex polygon (n, 2) behind a line (Sutherland and Hodgman).

    Args:
        polygon: its corners in order.
        point: any point of the line, (2,).
        normal: (2,) points to the side that is cut off.
    """
    kept: list[Floats] = []
    side = (polygon - point) @ normal
    for i, corner in enumerate(polygon):
        j = (i + 1) % len(polygon)
        if side[i] <= 0.0:
            kept.append(corner)
        if (side[i] < 0.0 < side[j]) or (side[j] < 0.0 < side[i]):
            kept.append(corner + (polygon[j] - corner) * side[i] / (side[i] - side[j]))
    return np.array(kept).reshape(-1, 2)
