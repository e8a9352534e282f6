"""A yard that draws itself: fences, what lies across it, and what lies about."""

from collections.abc import Sequence

import numpy as np

from treadwell.course.outlines import Floats
from treadwell.course.worlds.border import check_inside, enclose
from treadwell.course.worlds.clutter import lay_about
from treadwell.course.worlds.crossings import (
    cross,
    crossing_kinds,
    drawn_crossing,
    shut_off,
    shutting_kinds,
)
from treadwell.course.worlds.drawing import (
    LAYOUTS,
    PASSAGE,
    SPARE,
    STOP,
    Budget,
    Drawn,
    World,
    away,
    disc,
    is_closed,
)
from treadwell.errors import InputError
from treadwell.random_streams import stream
from treadwell.scenario.drawn_elements import Yard

FENCE = 0.05
"""Metres: the thickness of a fence."""
FENCE_HEIGHT = 0.5
ROOM = 0.5
"""Metres from start, points to pass and goal to what lies across the yard."""
GAP = 0.35
"""Metres between two things that lie across the yard."""


def drawn_yard(yard: Yard, name: str, *, seed: int, stops: Sequence[Floats], width: float) -> Drawn:
    """Return what a yard consists of, named `<name>.<thing> <number>`.

    Args:
        yard: the element.
        name: its name.
        seed: the episode's seed.
        stops: start, points to pass and goal in this order, world x, y.
        width: of the robot, metres.

    Raises:
        InputError: no layout has room for what it is to hold.
    """
    places = np.array(stops)
    check_inside(name, yard.area, places, border="fences")
    generator = stream(seed, f"course.{name}")
    closed = is_closed(name, seed=seed, share=yard.closed)
    budget = Budget()
    for _ in range(LAYOUTS):
        world = World(yard, name, generator, budget)
        if _layout(world, yard, places, max(PASSAGE, width + SPARE), closed=closed):
            return world.drawn()
        if budget.is_spent:
            break
    raise InputError(
        f"course.{name}.area: found {[list(corner) for corner in yard.area]}; there is no place "
        f"for clutter of {yard.clutter} that leaves a way; allowed: less clutter, or a larger area"
    )


def _layout(world: World, yard: Yard, stops: Floats, passage: float, *, closed: bool) -> bool:
    """Draw one yard; return whether it is one."""
    world.kept += [disc(stop, STOP) for stop in stops]
    enclose(world, yard.area, "fence", height=FENCE_HEIGHT, thickness=FENCE)
    if not _lay_across(world, yard, stops, closed=closed):
        return False
    if not lay_about(world, yard):
        return False
    if away(world.solid, stops) < STOP - 0.1:
        return False
    return world.has_way(stops, yard.area, passage)


def _lay_across(world: World, yard: Yard, stops: Floats, *, closed: bool) -> bool:
    """Draw what one has to cross between start and goal; return whether there was room."""
    low, high = np.array(yard.area)
    first, last = float(stops[0, 0]), float(stops[-1, 0])
    begin, end = min(first, last) + ROOM, max(first, last) - ROOM
    kinds = crossing_kinds(yard.things)
    # Other points to pass may lie anywhere: what lies across the yard keeps away from them.
    between = [float(stop[0]) for stop in stops[1:-1]]
    wide = float(high[1] - low[1])
    across = [
        drawn_crossing(world, str(world.one_of(*kinds)), wide)
        for _ in range(int(world.one_of(1, 1, 2)) if kinds else 0)
    ]
    if closed:
        kind = str(world.one_of(*shutting_kinds(yard.things)))
        across[-1:] = [shut_off(world, kind, wide)]
    world.generator.shuffle(across)
    spare = end - begin - sum(each.extent for each in across) - GAP * (len(across) - 1)
    if spare < 0.0:
        return False
    shares = np.sort(world.generator.uniform(0.0, spare, len(across)))
    at, before = begin, 0.0
    for crossing, share in zip(across, shares, strict=True):
        at += float(share) - before
        before = float(share)
        if any(at - STOP < place < at + crossing.extent + STOP for place in between):
            return False
        middle = np.array([at + crossing.extent / 2, (low[1] + high[1]) / 2])
        cross(world, crossing, middle, wide, forward=last > first)
        at += crossing.extent + GAP
    return True
