"""What lies about in a yard: posts, slabs, low bars."""

import math
from typing import Final

import numpy as np

from treadwell.course.outlines import heading, rectangle
from treadwell.course.worlds.drawing import World, disc
from treadwell.scenario.drawn_elements import Yard

DRAWS: Final = 30
"""Places tried for one thing before the yard is given up."""
GAP: Final = 0.04
"""Metres between things, at least."""
KINDS: Final = ("post", "post", "slab", "bar")
"""What is drawn, the one twice that is smallest."""


def lay_about(world: World, yard: Yard) -> bool:
    """Put the clutter into a yard; return whether there was a place for all of it."""
    kinds = [kind for kind in KINDS if kind in yard.things]
    draw = {"post": _post, "slab": _slab, "bar": _bar}
    for _ in range(yard.clutter if kinds else 0):
        kind = str(world.one_of(*kinds))
        if not any(draw[kind](world, yard) for _ in range(DRAWS)):
            return False
    return True


def _post(world: World, yard: Yard) -> bool:
    at, radius = world.generator.uniform(*np.array(yard.area)), world.uniform(0.02, 0.07)
    if not world.is_free(disc(at, radius), clear=GAP):
        return False
    world.solid.append(disc(at, radius))
    world.cylinder(world.called("post"), at, radius, world.uniform(0.25, 0.7))
    return True


def _slab(world: World, yard: Yard) -> bool:
    """Lay a slab that one can step on, or go around."""
    at, yaw = world.generator.uniform(*np.array(yard.area)), world.uniform(0.0, math.pi)
    length, width = world.uniform(0.25, 0.55), world.uniform(0.2, 0.4)
    outline = rectangle(at, yaw, (-length / 2, length / 2), width)
    if not world.is_free(outline, clear=GAP):
        return False
    world.solid.append(outline)
    size = (length, width, world.uniform(0.012, 0.045))
    world.platform(world.called("slab"), at, yaw, size)
    return True


def _bar(world: World, yard: Yard) -> bool:
    """Lay a bar on the ground, or low above it between two posts."""
    at, yaw = world.generator.uniform(*np.array(yard.area)), world.uniform(0.0, math.pi)
    length, thick = world.uniform(0.4, 1.0), world.uniform(0.01, 0.03)
    outline = rectangle(at, yaw, (-length / 2, length / 2), thick)
    if not world.is_free(outline, clear=GAP):
        return False
    world.solid.append(outline)
    name = world.called("bar")
    if world.happens(0.5):
        world.box(name, at, yaw, (length, thick, world.uniform(0.01, 0.03)))
        return True
    base = world.uniform(0.06, 0.25)
    world.box(name, at, yaw, (length, thick, thick), base=base)
    for number, side in enumerate((-1.0, 1.0), start=1):
        end = at + side * (length - thick) / 2 * heading(yaw)
        world.box(f"{name} post {number}", end, yaw, (thick, thick, base))
    return True
