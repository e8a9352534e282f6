"""Doors: a wall with an opening and a lintel, and a leaf that turns about a hinge."""

from dataclasses import replace
from typing import Final

import mujoco
import numpy as np

from treadwell.course.course import QUARTER, CourseElement
from treadwell.course.outlines import Floats, heading, left_of, rectangle
from treadwell.course.pieces import Piece, block
from treadwell.scenario.elements import Door

LEAF: Final = ".leaf"
"""Behind a door's name: the name of its leaf, which is an element of its own."""
LEAF_THICKNESS: Final = 0.02
"""Metres."""
PLAY: Final = 0.005
"""Metres between the leaf and the frame, and between the leaf and the floor."""


def frame_pieces(door: Door) -> list[Piece]:
    """Return the wall to the left and to the right of the opening, and the lintel above it."""
    to_left, to_right, top = door.wall
    half, along = door.width / 2, (-door.thickness / 2, door.thickness / 2)
    pieces = []
    for name, side, extent in (("left", 1.0, to_left), ("right", -1.0, to_right)):
        if extent > PLAY:
            middle = np.array(door.position) + side * (half + extent / 2) * left_of(door.yaw)
            outline = rectangle(middle, door.yaw, along, extent)
            pieces.append(block(name, outline, door.yaw, 0.0, top))
    if top > door.height + PLAY:
        outline = rectangle(door.position, door.yaw, along, door.width)
        pieces.append(block("lintel", outline, door.yaw, door.height, top))
    return pieces


def hinge_of(door: Door) -> Floats:
    """Return the foot of the axis that the leaf turns about: left, on the far face; world, (3,)."""
    sideways = door.width / 2 * left_of(door.yaw)
    corner = np.array(door.position) + sideways + door.thickness / 2 * heading(door.yaw)
    return np.array([*corner, 0.0])


def leaf_piece(door: Door) -> Piece:
    """Return the leaf as far open as the door says."""
    yaw = door.yaw - QUARTER + QUARTER * door.open
    begin = hinge_of(door)[:2] - LEAF_THICKNESS / 2 * left_of(yaw)
    outline = rectangle(begin, yaw, (PLAY, max(door.width - PLAY, 2 * PLAY)), LEAF_THICKNESS)
    return block("leaf", outline, yaw, PLAY, max(door.height - PLAY, 2 * PLAY))


def with_leaf(element: CourseElement, opened: float) -> CourseElement:
    """Return an element as it is with its door so far open; itself where it is no leaf."""
    if element.hinge is None or opened == element.hinge.open:
        return element
    turn = element.hinge.turn(opened)
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, turn)
    matrix = rotation.reshape(3, 3)
    pieces = []
    for piece in element.pieces:
        quaternion = np.zeros(4)
        mujoco.mju_mulQuat(quaternion, turn, piece.quaternion)
        around = element.origin
        pieces.append(
            replace(
                piece,
                vertices=around + (piece.vertices - around) @ matrix.T,
                center=around + matrix @ (piece.center - around),
                quaternion=quaternion,
            )
        )
    hinge = replace(element.hinge, open=opened)
    return replace(element, pieces=tuple(pieces), hinge=hinge)
