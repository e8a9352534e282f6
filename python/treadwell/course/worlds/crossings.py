"""What lies across a whole yard: kerbs askew and ramps that one crosses, and what shuts it off."""

import math
from collections.abc import Collection
from dataclasses import dataclass
from typing import Final

import numpy as np

from treadwell.course.outlines import Floats, heading, left_of, rectangle
from treadwell.course.worlds.drawing import World

KERBS: Final = (0.018, 0.048)
"""Metres: least and largest height of a kerb that one can step on."""
HIGH: Final = (0.065, 0.120)
"""The same of one that is too high."""
RAMPS: Final = (0.03, 0.07)
"""Metres: how high a ramp leads."""
SLOPES: Final = (math.radians(3.5), math.radians(9.5))
STEEP: Final = (math.radians(13.5), math.radians(22.0))
"""Radians: slopes that are too steep."""
STEEP_RISES: Final = (0.065, 0.110)
DEPTHS: Final = (0.35, 0.8)
"""Metres: how deep the top of a kerb or between two ramps is."""
ASKEW: Final = 0.25
"""Radians: a kerb is turned by at most so much; a ramp by a third of it."""
LOW: Final = (0.38, 0.52)
"""Metres: the underside of a bar that shuts the yard off."""
NARROW: Final = 0.2
"""Metres between the posts of a row that shuts it off, at most."""


@dataclass(frozen=True)
class Crossing:
    """Something that lies across a yard.

    Attributes:
        kind: `kerb`, `ramp`, `bar`, `post` or `fence`.
        yaw: by how much it is turned, rad.
        depth: of its level top, metres.
        rise: height of the top; of a bar, its underside.
        run: length of the ramps before and behind the top.
        extent: how much of the yard's length it takes.
    """

    kind: str
    yaw: float
    depth: float
    rise: float
    run: float
    extent: float


def crossing_kinds(things: Collection[str]) -> list[str]:
    """Return what can lie across a yard that holds such things."""
    return [kind for kind in ("kerb", "ramp") if kind in things]


def shutting_kinds(things: Collection[str]) -> list[str]:
    """Return what can shut off a yard that holds such things."""
    return [kind for kind in ("kerb", "ramp", "bar", "post") if kind in things] or ["fence"]


def drawn_crossing(world: World, kind: str, wide: float) -> Crossing:
    """Draw the measures of something that one can cross.

    Args:
        world: what is drawn.
        kind: `kerb` or `ramp`.
        wide: width of the yard, metres.
    """
    depth = world.uniform(*DEPTHS)
    if kind == "kerb":
        return _crossing(
            kind, world.uniform(-ASKEW, ASKEW), depth, world.uniform(*KERBS), 0.0, wide
        )
    rise = world.uniform(*RAMPS)
    run = rise / math.tan(world.uniform(*SLOPES))
    return _crossing(kind, world.uniform(-ASKEW, ASKEW) / 3, depth, rise, run, wide)


def shut_off(world: World, kind: str, wide: float) -> Crossing:
    """Draw the measures of something that one cannot cross."""
    yaw = world.uniform(-ASKEW, ASKEW)
    if kind == "kerb":
        depth, rise = world.uniform(*DEPTHS), world.uniform(*HIGH)
        return _crossing(kind, yaw, depth, rise, 0.0, wide)
    if kind == "ramp":
        rise = world.uniform(*STEEP_RISES)
        run = rise / math.tan(world.uniform(*STEEP))
        return _crossing(kind, yaw / 3, world.uniform(*DEPTHS), rise, run, wide)
    low = world.uniform(*LOW) if kind == "bar" else 0.0
    return _crossing(kind, yaw, 0.05, low, 0.0, wide)


def _crossing(
    kind: str, yaw: float, depth: float, rise: float, run: float, wide: float
) -> Crossing:
    extent = (depth + 2 * run) * math.cos(yaw) + wide * math.tan(abs(yaw))
    return Crossing(kind, yaw, depth, rise, run, extent)


def cross(world: World, crossing: Crossing, middle: Floats, wide: float, *, forward: bool) -> None:
    """Draw something across a yard.

    Args:
        world: what it is drawn into.
        crossing: its measures.
        middle: (2,) of the yard there.
        wide: width of the yard, metres.
        forward: whether the robot comes along x.
    """
    yaw = crossing.yaw + (0.0 if forward else math.pi)
    # Up to the fences' middles on both sides, and a little more on one of them.
    reach = wide / math.cos(crossing.yaw) + (crossing.depth + 2 * crossing.run) * abs(
        math.tan(crossing.yaw)
    )
    half = crossing.depth / 2 + crossing.run
    world.kept.append(rectangle(middle, yaw, (-half - 0.1, half + 0.1), reach))
    if crossing.kind in {"kerb", "ramp"}:
        size = (crossing.depth, reach, crossing.rise)
        world.platform(world.called("kerb" if crossing.run == 0.0 else "top"), middle, yaw, size)
        for turned in (yaw, yaw + math.pi) if crossing.run > 0.0 else ():
            foot = middle - half * heading(turned)
            keys = {"length": crossing.run, "width": reach, "rise": crossing.rise}
            world.ramp(world.called("ramp"), foot, turned, **keys)
    elif crossing.kind == "post":
        radius = world.uniform(0.02, 0.04)
        count = math.ceil(reach / (NARROW + 2 * radius))
        for share in np.linspace(-0.5, 0.5, count + 1):
            at = middle + share * reach * left_of(yaw)
            world.cylinder(world.called("post"), at, radius, 0.5)
    else:
        size = (crossing.depth, reach, 0.05 if crossing.kind == "bar" else 0.5)
        world.box(world.called(crossing.kind), middle, yaw, size, base=crossing.rise)
