"""The border of a world that draws itself: what must lie inside, and the walls around it."""

import math
from collections.abc import Sequence

import numpy as np

from treadwell.course.outlines import Floats
from treadwell.course.worlds.drawing import STOP, World
from treadwell.errors import InputError


def check_inside(name: str, area: Sequence[Sequence[float]], stops: Floats, *, border: str) -> None:
    """Refuse a world in which the robot would start, pass or arrive too near to its border.

    Args:
        name: of the element.
        area: its corners with the least and the greatest coordinates, world x, y.
        stops: (n, 2) start, points to pass and goal, world x, y.
        border: what the border consists of, in the plural.

    Raises:
        InputError: one of them lies outside, or too near to the border.
    """
    low, high = np.array(area)
    if not ((stops >= low + STOP) & (stops <= high - STOP)).all():
        raise InputError(
            f"course.{name}.area: found {[list(corner) for corner in area]}; start, goal and "
            f"the points to pass must lie inside, {STOP} m from the {border}"
        )


def enclose(
    world: World, area: Sequence[Sequence[float]], thing: str, *, height: float, thickness: float
) -> None:
    """Draw walls around an area, each named by the kind of thing that it is; metres."""
    (x0, y0), (x1, y1) = area
    corners = np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
    for begin, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along = (end - begin) / math.dist(begin, end) * thickness / 2
        world.wall(world.called(thing), begin - along, end + along, height, thickness)
