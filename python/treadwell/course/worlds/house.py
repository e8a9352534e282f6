"""A house that draws itself: rooms, doors between them, and what stands in the rooms."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from treadwell.course.outlines import Floats
from treadwell.course.worlds.border import check_inside, enclose
from treadwell.course.worlds.doorways import WIDTHS, Doorways
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
from treadwell.course.worlds.furniture import furnish
from treadwell.course.worlds.raised_floor import raise_floor
from treadwell.course.worlds.rooms import LEAST, Room, cut_rooms, hops, openings
from treadwell.errors import InputError
from treadwell.random_streams import stream
from treadwell.scenario.drawn_elements import House

WALL_HEIGHT: Final = 0.95
WALL: Final = 0.05
"""Metres: the thickness of a wall."""
RAISED: Final = 0.5
"""Share of the houses that may, in which the goal lies on a raised floor."""
PATIENCE: Final = 0.7
"""Share of the layouts in which it has to, where it shall; few have the room."""


def drawn_house(
    house: House, name: str, *, seed: int, stops: Sequence[Floats], width: float
) -> Drawn:
    """Return what a house consists of, named `<name>.<thing> <number>`.

    Args:
        house: the element.
        name: its name.
        seed: the episode's seed.
        stops: start, points to pass and goal in this order, world x, y.
        width: of the robot, metres.

    Raises:
        InputError: no layout has room for what it is to hold.
    """
    places = np.array(stops)
    check_inside(name, house.area, places, border="outer walls")
    generator = stream(seed, f"course.{name}")
    closed = is_closed(name, seed=seed, share=house.closed)
    passage = max(PASSAGE, width + SPARE)
    ways_up = [thing for thing in ("flight", "ramp") if thing in house.things]
    way_up = str(generator.choice(ways_up)) if ways_up and generator.random() < RAISED else ""
    budget = Budget()
    for number in range(LAYOUTS):
        world = World(house, name, generator, budget)
        wanted = way_up if number < PATIENCE * LAYOUTS else ""
        if _layout(world, house, places, passage, wanted, closed=closed):
            return world.drawn()
        if budget.is_spent:
            break
    raise InputError(
        f"course.{name}.area: found {[list(corner) for corner in house.area]}; there is no place "
        f"for {house.rooms} rooms of {LEAST} m with a way between start and goal, which lie in "
        f"rooms of their own; allowed: fewer rooms, or a larger area"
    )


def _layout(
    world: World, house: House, stops: Floats, passage: float, way_up: str, *, closed: bool
) -> bool:
    """Draw one house; return whether it is one, with a way up where one is asked for."""
    cut = cut_rooms(world.generator, house.area, house.rooms, stops)
    if cut is None:
        return False
    rooms, cuts = cut
    first, last = (_room_of(rooms, stop) for stop in (stops[0], stops[-1]))
    doors = openings(world.generator, rooms, cuts, WIDTHS)
    if first == last or doors is None:
        return False
    world.kept += [disc(stop, STOP) for stop in stops]
    enclose(world, house.area, "wall", height=WALL_HEIGHT, thickness=WALL)
    doorways = Doorways(world, house.things, rooms, cuts, doors, WALL, WALL_HEIGHT)
    goal_doors = [i for i, door in enumerate(doors) if last in door.rooms]
    points = [doorways.point(i) for i in goal_doors]
    if way_up:
        if any(rooms[last].holds(stop) for stop in stops[:-1]):
            return False
        close_it = closed and world.happens(0.6)
        if not raise_floor(world, rooms[last], way_up, points, stops[-1], closed=close_it):
            return False
        closed = closed and not close_it
    doorways.draw(hops(len(rooms), doors, first), goal_doors if closed else ())
    if away(world.solid, stops) < STOP - 0.1:
        return False
    furnish(world, house.things, rooms, stops)
    return world.has_way(stops, house.area, passage)


def _room_of(rooms: Sequence[Room], place: Floats) -> int:
    return next(i for i, room in enumerate(rooms) if room.holds(place))
