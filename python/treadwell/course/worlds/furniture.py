"""What stands, lies and walks about in the rooms of a house."""

import math
from collections.abc import Collection, Sequence
from typing import Final

import numpy as np

from treadwell.course.outlines import Floats, heading, left_of, rectangle
from treadwell.course.worlds.drawing import STOP, World, away
from treadwell.course.worlds.rooms import Room

DRAWS: Final = 12
"""Places tried for one thing before it is left out."""
GAP: Final = 0.04
"""Metres between things, at least."""
TOP: Final = 0.02
"""Thickness of a desk's top and of a board, metres."""
LEG: Final = 0.03
PERSON: Final = (0.08, 0.10)
"""Metres: least and largest radius of who walks."""
WALKS: Final = (0.8, 1.7)
"""Metres: how far somebody walks before turning."""


def furnish(world: World, things: Collection[str], rooms: Sequence[Room], stops: Floats) -> None:
    """Put things into the rooms of a house, wherever there is a place for them.

    Args:
        world: what they are drawn into; what stands there keeps its place.
        things: what the house may hold.
        rooms: of the house.
        stops: (n, 2): who walks keeps away from them.
    """
    for room in rooms:
        for thing, share, draw in (
            ("shelf", 0.7, _shelf),
            ("desk", 0.5, _desk),
            ("shelf", 0.4, _shelf),
            ("cable", 0.4, _cable),
        ):
            if thing in things and world.happens(share):
                any(draw(world, room) for _ in range(DRAWS))
    if "person" in things and world.happens(0.6):
        any(_person(world, rooms, stops) for _ in range(4 * DRAWS))


def _shelf(world: World, room: Room) -> bool:
    """Put a cupboard, or a board that hangs, at a wall of a room."""
    length, depth = world.uniform(0.3, 0.8), world.uniform(0.12, 0.20)
    yaw = int(world.generator.integers(4)) * math.pi / 2
    ahead, across = heading(yaw), left_of(yaw)
    half = (room.high - room.low) / 2
    reach, side = float(np.abs(half @ ahead)), float(np.abs(half @ across))
    spare = side - length / 2 - 0.05
    if spare < 0.0:
        return False
    wall = (room.low + room.high) / 2 + (reach - 0.03) * ahead
    at = wall + world.uniform(-spare, spare) * across - depth / 2 * ahead
    outline = rectangle(at, yaw, (-depth / 2, depth / 2), length)
    if not world.is_free(outline):
        return False
    world.solid.append(outline)
    name = world.called("shelf")
    if world.happens(0.3):
        size, base = (depth, length, TOP), world.uniform(0.25, 0.5)
        world.box(name, at, yaw, size, base=base)
    else:
        world.box(name, at, yaw, (depth, length, world.uniform(0.3, 0.8)))
    return True


def _desk(world: World, room: Room) -> bool:
    """Put a desk on four legs into a room, its top lower than a head."""
    length, depth = world.uniform(0.45, 0.8), world.uniform(0.3, 0.45)
    at = world.generator.uniform(room.low + 0.2, room.high - 0.2)
    yaw = int(world.generator.integers(4)) * math.pi / 2 + world.uniform(-0.15, 0.15)
    outline = rectangle(at, yaw, (-length / 2, length / 2), depth)
    if not world.is_free(outline, clear=GAP):
        return False
    world.solid.append(outline)
    name, base = world.called("desk"), world.uniform(0.30, 0.52)
    world.box(name, at, yaw, (length, depth, TOP), base=base)
    for number, (x, y) in enumerate(((-1, -1), (-1, 1), (1, -1), (1, 1)), start=1):
        inward = np.array([length, depth]) / 2 - LEG
        leg = at + x * inward[0] * heading(yaw) + y * inward[1] * left_of(yaw)
        world.box(f"{name} leg {number}", leg, yaw, (LEG, LEG, base))
    return True


def _cable(world: World, room: Room) -> bool:
    """Lay a cable on the floor of a room."""
    length, thick = world.uniform(0.4, 1.1), world.uniform(0.008, 0.015)
    at = world.generator.uniform(room.low, room.high)
    yaw = world.uniform(0.0, math.pi)
    outline = rectangle(at, yaw, (-length / 2, length / 2), thick)
    if not world.is_free(outline):
        return False
    world.solid.append(outline)
    world.box(world.called("cable"), at, yaw, (length, thick, thick))
    return True


def _person(world: World, rooms: Sequence[Room], stops: Floats) -> bool:
    """Let somebody walk to and fro in a room."""
    room: Room = world.one_of(*rooms)
    radius = world.uniform(*PERSON)
    begin = world.generator.uniform(room.low, room.high)
    end = begin + world.uniform(*WALKS) * heading(world.uniform(-math.pi, math.pi))
    way = begin + np.linspace(0.0, 1.0, 25)[:, None] * (end - begin)
    clear = away([*world.solid, *world.raised], way) > radius + GAP
    apart = np.linalg.norm(way[:, None] - stops[None], axis=-1).min() > STOP + radius + 0.1
    if not (room.holds(begin) and room.holds(end) and clear and apart):
        return False
    name = world.called("person")
    world.cylinder(name, begin, radius, world.uniform(0.45, 0.75))
    world.walks(name, (begin, end), at=world.uniform(0.0, 4.0), speed=world.uniform(0.08, 0.25))
    return True
