"""Room that the robot had on its way: the sweep of its shape past the course."""

import numpy as np
from numpy.typing import NDArray

from treadwell._core import swept_clearance
from treadwell.course.course import Course
from treadwell.robot.load import Robot


def least_clearance(course: Course, robot: Robot, path: NDArray[np.float64]) -> float | None:
    """Return the least room between the robot's upright cylinder and an obstacle, m.

    Obstacles are the solids that stand still from beginning to end, are not walked on, and reach
    between the ground and the robot's height. Negative where the cylinder would touch: the robot
    itself is slimmer than its cylinder.

    Args:
        course: what stands where.
        robot: for radius and height.
        path: (n, 2) m, where the robot truly was.

    Returns:
        None where there is no such obstacle, or no path.
    """
    body = robot.file.body
    outlines = [
        piece.outline
        for element in course.elements
        if element.mocap_id is None and not element.walkable
        for piece in element.pieces
        if piece.vertices[:, 2].min() < body.height and piece.vertices[:, 2].max() > 0.0
    ]
    if not outlines or not len(path):
        return None
    places = np.ascontiguousarray(path[:, :2], np.float64)
    return min(
        swept_clearance(places, np.ascontiguousarray(outline), body.radius) for outline in outlines
    )
