"""Room that the robot had on its way: the sweep of its shape past the course."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from treadwell._core import swept_clearance
from treadwell.course.course import LEVEL_TOLERANCE, Course
from treadwell.robot.load import Robot


def least_clearance(
    course: Course, robot: Robot, ways: Iterable[NDArray[np.float64]]
) -> float | None:
    """Return the least room between the robot's upright cylinder and an obstacle, m.

    Obstacles are the solids that stand still from beginning to end, are not walked on, and reach
    between the ground under the robot and its height. Negative where the cylinder would touch: the
    robot itself is slimmer than its cylinder.

    Args:
        course: what stands where.
        robot: for radius and height.
        ways: (n, 3) m each, where the robot truly was on the ground; from the end of one to the
            beginning of the next it was carried.

    Returns:
        None where it came past no such obstacle.
    """
    body, found = robot.file.body, []
    solids = [
        piece
        for element in course.elements
        if element.mocap_id is None and not element.walkable
        for piece in element.pieces
    ]
    ground = LEVEL_TOLERANCE * course.scale
    for way in ways:
        for solid in solids:
            low, high = solid.vertices[:, 2].min(), solid.vertices[:, 2].max()
            # What is flush with the ground, or stands on the floor below it, is not in the way.
            beside = (low < way[:, 2] + body.height) & (high > way[:, 2] + ground)
            outline = np.ascontiguousarray(solid.outline)
            for part in _runs(beside):
                places = np.ascontiguousarray(way[part, :2], np.float64)
                found.append(swept_clearance(places, outline, body.radius))
    return min(found, default=None)


def _runs(there: NDArray[np.bool_]) -> list[slice]:
    """Return the stretches of rows at which something is so."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], there, [False]]).astype(np.int8)))
    return [slice(begin, end) for begin, end in edges.reshape(-1, 2).tolist()]
