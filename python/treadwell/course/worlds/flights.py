"""Flights that draw themselves: up to the goal, or down from the start."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from treadwell.course.outlines import Floats, heading
from treadwell.course.worlds.doorways import AJAR, LINTELS, LOW, NARROW, WIDTHS
from treadwell.course.worlds.drawing import LAYOUTS, STOP, Budget, Drawn, World, away, is_closed
from treadwell.course.worlds.flight_shapes import Level, shape, with_heights
from treadwell.course.worlds.raised_floor import HIGH
from treadwell.errors import InputError
from treadwell.random_streams import stream
from treadwell.scenario.drawn_elements import Flights

ON_TOP: Final = 0.3
"""Metres from a top's front edge to the door across it."""
ON_LANDING: Final = 0.12
"""The same of a landing."""
DOORS: Final = 0.4
"""Share of the flights that may, which have an open door on a landing or on the top."""
JAMB: Final = 0.03
"""Metres of wall beside a door, at least."""
FAR_EDGE: Final = 0.35
"""Metres from start or goal on a top to its far edge and to its sides, at least."""
WALL_HEIGHT: Final = 0.95
"""Metres above the top of the wall that a door is in."""
WALL: Final = 0.05
CHEEKS: Final = (0.25, 0.45)
"""Metres: how high a cheek is above the end of its steps."""
RAIL_HEIGHT: Final = 0.36
"""Metres from a tread to the underside of the rail beside it."""
RAIL: Final = 0.025
POST: Final = 0.02


@dataclass(frozen=True, slots=True)
class FlightDoor:
    """A door across a flight.

    Attributes:
        on: the level that it stands on.
        how: open, ajar; shut, low or narrow where it closes the way.
    """

    on: Literal["landing", "top"]
    how: str


def drawn_flights(flights: Flights, name: str, *, seed: int, stops: Sequence[Floats]) -> Drawn:
    """Return what flights consist of, named `<name>.<thing> <number>`.

    Args:
        flights: the element.
        name: its name.
        seed: the episode's seed.
        stops: start, points to pass and goal in this order, world x, y.

    Raises:
        InputError: no layout leaves the stop that is not on the top on the ground.
    """
    generator = stream(seed, f"course.{name}")
    closed = is_closed(name, seed=seed, share=flights.closed)
    down = bool(generator.random() < flights.down)
    above, ground = (stops[0], stops[1:]) if down else (stops[-1], stops[:-1])
    for _ in range(LAYOUTS):
        world = World(flights, name, generator, Budget())
        if _layout(world, flights, above, np.array(ground), closed=closed):
            return world.drawn()
    raise InputError(
        f"course.{name}: found start, points to pass and goal at "
        f"{[stop.tolist() for stop in stops]}; there is no place for flights between them; "
        f"allowed: a goal farther from the start"
    )


def _layout(world: World, flights: Flights, above: Floats, ground: Floats, *, closed: bool) -> bool:
    """Draw flights to the stop above (2,); return whether those on the ground (n, 2) are free."""
    kind = str(world.one_of(*flights.shapes))
    door = _door(world, flights, kind, closed=closed)
    levels, turn = shape(world, flights, kind, door.on if door else "")
    rises = _rises(world, flights, len(levels), high=closed and door is None)
    levels = _placed(world, with_heights(levels, rises), above)
    if closed and door and levels[-1].height < HIGH[0]:
        return False  # one could get around the door
    if away([level.outline for level in levels], ground) < STOP:
        return False
    _build(world, levels, rises, turn)
    if door:
        _draw_door(world, levels, door)
    guards = [thing for thing in ("cheek", "rail") if thing in flights.things]
    if guards and not turn:
        _guard(world, levels, str(world.one_of("", *guards)))
    return True


def _door(world: World, flights: Flights, kind: str, *, closed: bool) -> FlightDoor | None:
    """Return the door that a flight has: an open one, one that closes the way, or none."""
    if "door" not in flights.things:
        return None
    if closed:
        how = world.one_of("", "", "shut", "low", "narrow")
        return FlightDoor("top", how) if how else None
    if not world.happens(DOORS):
        return None
    on = world.one_of("landing", "top") if kind in {"l", "u"} else "top"
    return FlightDoor("landing" if on == "landing" else "top", world.one_of("open", "ajar"))


def _rises(world: World, flights: Flights, count: int, *, high: bool) -> list[float]:
    """Return the rises, lowest first: all alike, or each its own; one too high if asked for."""
    rises = [world.uniform(*flights.rise) for _ in range(count)]
    if world.happens(0.5):
        rises = [rises[0]] * count
    if high:
        rises[int(world.generator.integers(count))] = world.uniform(*HIGH)
    return rises


def _placed(world: World, levels: Sequence[Level], above: Floats) -> list[Level]:
    """Return the levels turned in any direction, with a stop (2,) near the far end of the top."""
    top = levels[-1]
    aside = max(0.0, top.width / 2 - FAR_EDGE)
    stop = top.at(top.depth - FAR_EDGE, world.uniform(-aside, aside))
    yaw = world.uniform(-math.pi, math.pi)
    cosine, sine = math.cos(yaw), math.sin(yaw)
    turn = np.array([[cosine, -sine], [sine, cosine]])
    return [level.moved(above - turn @ stop, yaw) for level in levels]


def _build(world: World, levels: Sequence[Level], rises: Sequence[float], turn: float) -> None:
    if turn:
        first, top = levels[0], levels[-1]
        keys = {"steps": len(levels), "rise": tuple(rises), "tread": first.depth, "turn": turn}
        name = world.called("winder")
        world.stairs(name, first.front, first.yaw, width=first.width, landing=top.depth, **keys)
        return
    for level in levels:
        size = (level.depth, level.width, level.height)
        world.platform(world.called(level.what), level.at(level.depth / 2), level.yaw, size)


def _draw_door(world: World, levels: Sequence[Level], door: FlightDoor) -> None:
    """Draw a door across the way, in a wall as wide as that; it opens away from the steps."""
    number = next(i for i, level in enumerate(levels) if level.what == door.on)
    level, below = levels[number], levels[number - 1]
    wide, along = level.width, ON_TOP
    if door.on == "landing":
        wide, along = below.width, ON_LANDING
    width = min(world.uniform(*WIDTHS), wide - 2 * JAMB)
    if door.how == "narrow":
        width = world.uniform(*NARROW)
    beside = (wide - width) / 2
    keys = {
        "width": width,
        "height": level.height + world.uniform(*(LOW if door.how == "low" else LINTELS)),
        "wall": (beside, beside, level.height + WALL_HEIGHT),
        "thickness": WALL,
        "open": {"shut": 0.0, "ajar": world.uniform(*AJAR)}.get(door.how, world.uniform(0.95, 1.0)),
    }
    # The way comes over the back of the step below: a landing may be wider to one side.
    at = below.back + along * heading(level.yaw)
    world.door(world.called("door"), at, level.yaw, **keys)


def _guard(world: World, levels: Sequence[Level], kind: str) -> None:
    """Put cheeks or rails at one side or both sides of each run of steps."""
    sides = world.one_of((1.0, -1.0), (1.0,), (-1.0,))
    for run in _runs(levels):
        for side in sides if kind else ():
            (_cheek if kind == "cheek" else _rail)(world, run, side)


def _runs(levels: Sequence[Level]) -> list[list[Level]]:
    """Return the steps between the ground, landings and the top."""
    runs: list[list[Level]] = [[]]
    for level in levels:
        if level.what == "step":
            runs[-1].append(level)
        else:
            runs.append([])
    return [run for run in runs if run]


def _cheek(world: World, run: Sequence[Level], side: float) -> None:
    beside = side * (run[0].width + WALL) / 2
    begin, end = run[0].at(0.0, beside), run[-1].at(run[-1].depth, beside)
    height = run[-1].height + world.uniform(*CHEEKS)
    world.wall(world.called("cheek"), begin, end, height, WALL)


def _rail(world: World, run: Sequence[Level], side: float) -> None:
    """Draw a post at the front of each step, and a piece of rail above the tread."""
    for step in run:
        beside = side * (step.width + RAIL) / 2
        name, base = world.called("rail"), step.height + RAIL_HEIGHT
        size = (step.depth, RAIL, RAIL)
        world.box(name, step.at(step.depth / 2, beside), step.yaw, size, base=base)
        post = step.at(POST / 2, beside)
        world.box(f"{name} post", post, step.yaw, (POST, POST, base + RAIL))
