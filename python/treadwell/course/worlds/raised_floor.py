"""A floor that is raised at one end of a room, with a flight or a ramp that leads up to it."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from treadwell.course.outlines import Floats, heading, left_of, rectangle
from treadwell.course.worlds.drawing import STOP, World
from treadwell.course.worlds.rooms import Room

RISES: Final = (0.020, 0.048)
"""Metres: least and largest step that one can take."""
HIGH: Final = (0.062, 0.090)
"""The same of steps that are too high."""
TREADS: Final = (0.115, 0.18)
RAMPS: Final = (0.03, 0.08)
"""Metres: how high a ramp leads."""
SLOPES: Final = (math.radians(3.5), math.radians(9.5))
STEEP: Final = (math.radians(13.5), math.radians(20.0))
"""Radians: slopes that are too steep."""
FLIGHTS: Final = (0.6, 1.0)
"""Metres: least and largest width of a flight or a ramp."""
BEFORE: Final = 0.6
"""Metres before a flight or a ramp that stay free."""
DOOR: Final = 0.35
"""Metres from the foot of a flight to the middle of an opening at its side."""


def raise_floor(
    world: World,
    room: Room,
    kind: str,
    doors: Sequence[Floats],
    goal: Floats,
    *,
    closed: bool,
) -> bool:
    """Raise the floor around the goal; return whether the room had a place for it.

    Args:
        world: what it is drawn into.
        room: in which the goal lies.
        kind: `flight` or `ramp`.
        doors: (2,) each: the room's openings.
        goal: (2,) world.
        closed: whether one cannot get up.
    """
    rises, run = _profile(world, kind, closed=closed)
    width = world.uniform(*FLIGHTS)
    for way in world.generator.permutation(4):
        yaw = int(way) * math.pi / 2
        ahead, across = heading(yaw), left_of(yaw)
        middle = (room.low + room.high) / 2
        half = (room.high - room.low) / 2
        reach, side = float(np.abs(half @ ahead)), float(np.abs(half @ across))
        # Along `ahead`, from the room's middle: where the raised floor begins, and the flight.
        edge = float((goal - middle) @ ahead) - STOP - world.uniform(0.0, 0.15)
        foot = edge - run
        spare = side - width / 2 - 0.1
        # An opening in the wall behind is `BEFORE` away; one at the side needs its half width.
        along = [float((door - middle) @ ahead) for door in doors]
        beside = any(each > foot - DOOR and each > -reach + 0.01 for each in along)
        if foot - BEFORE < -reach or beside or spare < 0.0:
            continue
        at = middle + edge * ahead + world.uniform(-spare, spare) * across
        _draw(world, kind, yaw, at, rises=rises, run=run, width=width)
        depth = reach - edge
        centre = middle + (edge + depth / 2) * ahead
        world.platform(world.called("floor"), centre, yaw, (depth, 2 * side, sum(rises)))
        world.kept.append(rectangle(middle, yaw, (edge - 0.1, reach), 2 * side))
        world.raised.append(rectangle(middle, yaw, (edge, reach), 2 * side))
        if run > 0.0:
            world.raised.append(rectangle(at, yaw, (-run, 0.0), width))
        world.kept.append(rectangle(at, yaw, (-run - BEFORE, 0.0), width + 0.1))
        if sum(rises) > RISES[1]:
            _edges(world, middle + edge * ahead, at, yaw, side=side, run=run, width=width)
        return True
    return False


def _profile(world: World, kind: str, *, closed: bool) -> tuple[list[float], float]:
    """Return the rises, lowest first (of a ramp the one), and the run before the raised floor."""
    if kind == "ramp":
        rise = world.uniform(*RAMPS) if not closed else world.uniform(HIGH[0], RAMPS[1])
        return [rise], rise / math.tan(world.uniform(*(STEEP if closed else SLOPES)))
    count = int(world.one_of(1, 2, 2, 3))
    rises = [world.uniform(*(HIGH if closed else RISES))] * count
    return rises, (count - 1) * world.uniform(*TREADS)


def _draw(
    world: World, kind: str, yaw: float, at: Floats, *, rises: list[float], run: float, width: float
) -> None:
    """Draw the way up; `at` is where it meets the raised floor."""
    foot = at - run * heading(yaw)
    if kind == "ramp":
        name = world.called("ramp")
        world.ramp(name, foot, yaw, length=run, width=width, rise=sum(rises))
    elif len(rises) > 1:
        tread = run / (len(rises) - 1)
        keys = {"steps": len(rises) - 1, "rise": rises[0], "tread": tread, "landing": tread}
        world.stairs(world.called("flight"), foot, yaw, width=width, **keys)


def _edges(
    world: World, middle: Floats, at: Floats, yaw: float, *, side: float, run: float, width: float
) -> None:
    """Take the edges that one cannot climb for obstacles: beside the way up, and its flanks."""
    across = left_of(yaw)
    offset = float((at - middle) @ across)
    for sign in (1.0, -1.0):
        extent = side - sign * offset - width / 2
        beside = at + sign * (width / 2 + extent / 2) * across
        world.solid.append(rectangle(beside, yaw, (0.0, 0.02), extent))
        if run > 0.0:
            flank = at + sign * (width / 2 - 0.01) * across
            world.solid.append(rectangle(flank, yaw, (-run, 0.0), 0.02))
