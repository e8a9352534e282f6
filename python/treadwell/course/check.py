"""Whether a course can be started on: nothing in the robot, ground under it, joints that exist."""

from typing import Final

import mujoco
import numpy as np

from treadwell.course.course import Course
from treadwell.course.geometry import GROUND
from treadwell.course.outlines import signed_distance
from treadwell.errors import InputError
from treadwell.robot.load import Robot
from treadwell.scenario.events import EncoderOffset
from treadwell.scenario.faults import Fault
from treadwell.scenario.messages import nearest
from treadwell.scenario.model import Scenario

DEEPEST_CONTACT: Final = 0.003
"""Metres that a part of a robot of scale 1 may lie inside something at the start."""
FLUSH: Final = 0.01
"""Metres that something may be higher than the ground and no obstacle, on a course of scale 1."""
UNEVEN: Final = 0.015
"""Metres by which the surface may differ under the corners of the soles of such a robot."""


def check_start(scenario: Scenario, robot: Robot, course: Course) -> None:
    """Refuse a scenario in which the robot cannot stand at its start.

    Raises:
        InputError: with the element that is in the way, or the void, or the unknown joint.
    """
    where = str(scenario.path or scenario.name)
    data = mujoco.MjData(course.model)
    data.qpos[:] = course.qpos
    mujoco.mj_forward(course.model, data)
    in_the_way = _inside(course, robot) or _touching(course, data, DEEPEST_CONTACT * robot.scale)
    if in_the_way:
        raise InputError(
            f"{where}: start.position: found {list(scenario.start.position)}; the robot "
            f"would start inside the obstacle '{in_the_way}'"
        )
    _check_ground(course, robot, data, where)
    for i, event in enumerate(scenario.event):
        allowed: tuple[str, ...] = robot.joints
        if isinstance(event, Fault) and event.part == "motors":
            allowed = ("all", *robot.joints)
        if not isinstance(event, EncoderOffset | Fault) or event.joint in (None, *allowed):
            continue
        raise InputError(
            f"{where}: event.{i}.joint: found '{event.joint}'; must be one of "
            f"{', '.join(allowed)}{nearest(str(event.joint), allowed)}"
        )


def _inside(course: Course, robot: Robot) -> str:
    """Return the element whose outline the soles' middle lies in, nothing if there is none."""
    point = np.array([course.start.position])
    floor = course.start.height + FLUSH * course.scale
    head = course.start.height + robot.file.body.height
    for element in course.elements:
        if not element.present:
            continue
        for piece in element.pieces:
            low, high = piece.vertices[:, 2].min(), piece.top_at(point)[0]
            if low < head and high > floor and signed_distance(piece.outline, point)[0] < 0.0:
                return element.name
    return ""


def _touching(course: Course, data: mujoco.MjData, deepest: float) -> str:
    """Return the element that a part of the standing robot lies in by more than this, m; or ""."""
    for contact in data.contact:
        indices = course.geom_element[contact.geom]
        if contact.dist < -deepest and indices.max() >= 0:
            return course.elements[int(indices.max())].name
        names = {course.model.geom(int(geom)).name for geom in contact.geom}
        if contact.dist < -deepest and GROUND in names:
            return GROUND
    return ""


def _check_ground(course: Course, robot: Robot, data: mujoco.MjData, where: str) -> None:
    """Refuse a start at which a corner of a sole hangs over something lower."""
    corners = []
    for leg in (robot.file.legs.left, robot.file.legs.right):
        sole = leg.sole
        body = data.body(sole.link)
        for x in (-sole.length / 2, sole.length / 2):
            for y in (-sole.width / 2, sole.width / 2):
                local = np.array(sole.position) + np.array([x, y, 0.0])
                corners.append((body.xpos + body.xmat.reshape(3, 3) @ local)[:2])
    for x, y in corners:
        below = min((abs(h - course.start.height) for h in course.levels_at(x, y)), default=np.inf)
        if below > UNEVEN * robot.scale:
            raise InputError(
                f"{where}: start.position: found {list(course.start.position)}; a sole's "
                f"corner at [{x:.3f}, {y:.3f}] would be over a void"
            )
