"""What flights look like: steps, landings and a top as level rectangles, from the foot up.

They are laid out as they lead up along x from the origin, and moved to their place afterwards.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np

from treadwell.course.outlines import Floats, heading, left_of, rectangle
from treadwell.course.worlds.drawing import World
from treadwell.scenario.drawn_elements import Flights

STRAIGHT: Final = (2, 5)
"""Least and largest number of steps below the top of a straight flight."""
BEFORE_TURN: Final = (1, 3)
AFTER_TURN: Final = (1, 3)
WINDING: Final = (3, 6)
WIDTHS: Final = (0.6, 0.9)
"""Metres: least and largest width of a flight."""
WINDING_WIDTHS: Final = (0.75, 1.0)
TURNS: Final = (0.12, 0.3)
"""Radians by which each winding step is turned against the one below."""
USED: Final = 0.2
"""Metres from its outer side to where a winding flight is walked on."""
STANDING: Final = 0.19
"""Metres: a winding tread is so deep there that one can stand on it, and turn."""
SHORTEST: Final = 0.02
"""Metres: depth of a winding tread in its middle, at least."""
GAPS: Final = (0.15, 0.3)
"""Metres between two flights side by side, their cheeks and tops included."""
TOPS: Final = (0.8, 1.1)
"""Metres: depth of a top without a door."""
DOOR_TOP: Final = 1.75
"""Metres: depth of a top with one, whose leaf swings over it."""
DOOR_WIDTH: Final = 1.0
"""Metres: width of such a top, at least."""
DOORWAY_WIDTH: Final = 0.7
"""Metres: width of a flight with a door on its landing, at least."""
BEFORE_DOORWAY_TURN: Final = 0.2
"""Metres by which such a landing is deeper."""


@dataclass(frozen=True, slots=True)
class Measures:
    """What is drawn for a flight, metres.

    Attributes:
        tread: depth of its steps.
        width: of its steps.
        top: depth of its top.
        top_width: width of its top.
        before_turn: depth of a landing before the part on which one turns.
    """

    tread: float
    width: float
    top: float
    top_width: float
    before_turn: float


@dataclass(frozen=True, slots=True)
class Level:
    """A level rectangle of a flight.

    Attributes:
        what: step, landing or top.
        front: (2,) middle of the edge over which one comes up to it.
        yaw: the way up over that edge, rad.
        depth: along that way, metres.
        width: across.
        height: above the ground; 0 until the rises are drawn.
    """

    what: Literal["step", "landing", "top"]
    front: Floats
    yaw: float
    depth: float
    width: float
    height: float = 0.0

    @property
    def back(self) -> Floats:
        """Middle of its far edge, (2,)."""
        return self.at(self.depth)

    @property
    def outline(self) -> Floats:
        """Its corners, (4, 2)."""
        return rectangle(self.front, self.yaw, (0.0, self.depth), self.width)

    def at(self, along: float, left: float = 0.0) -> Floats:
        """Return a place by its distance from the front edge and from the middle, (2,)."""
        place: Floats = self.front + along * heading(self.yaw) + left * left_of(self.yaw)
        return place

    def moved(self, origin: Floats, yaw: float) -> "Level":
        """Return it in the frame in which its own has this origin and heading."""
        x, y = self.front
        front = origin + x * heading(yaw) + y * left_of(yaw)
        return replace(self, front=front, yaw=self.yaw + yaw)


def shape(
    world: World, flights: Flights, kind: str, door: Literal["", "landing", "top"] = ""
) -> tuple[list[Level], float]:
    """Draw a flight: its levels from the lowest to the top, and by how much each step is turned.

    Args:
        world: what is drawn.
        flights: within which bounds.
        kind: one of its shapes.
        door: which level has room for one; only where one turns on a landing there is one.
    """
    tread = world.uniform(*flights.tread)
    width = world.uniform(*(WINDING_WIDTHS if kind == "winder" else WIDTHS))
    top, top_width = world.uniform(*TOPS), width
    if door == "top":
        top, top_width = DOOR_TOP, max(width, DOOR_WIDTH)
    before_turn = 0.0
    if door == "landing":
        width = top_width = max(width, DOORWAY_WIDTH)
        before_turn = BEFORE_DOORWAY_TURN
    measures = Measures(tread, width, top, top_width, before_turn)
    if kind == "winder":
        return _winder(world, flights, measures)
    # A leaf is hinged left: it stands aside where one turns to the right.
    side = -1.0 if door == "landing" else world.one_of(1.0, -1.0)
    if kind == "l":
        return _quarter_turn(world, measures, side), 0.0
    if kind == "u":
        return _half_turn(world, measures, side), 0.0
    return _straight(world, measures), 0.0


def _straight(world: World, measures: Measures) -> list[Level]:
    steps = _steps(measures, np.zeros(2), 0.0, _count(world, STRAIGHT))
    return [*steps, _top(measures, steps[-1].back, 0.0)]


def _quarter_turn(world: World, measures: Measures, side: float) -> list[Level]:
    """Turn on a square landing to the left (1) or to the right (-1)."""
    width, before = measures.width, measures.before_turn
    below = _steps(measures, np.zeros(2), 0.0, _count(world, BEFORE_TURN))
    landing = Level("landing", below[-1].back, 0.0, before + width, width)
    yaw = side * math.pi / 2
    above = _steps(
        measures, landing.at(before + width / 2, side * width / 2), yaw, _count(world, AFTER_TURN)
    )
    return [*below, landing, *above, _top(measures, above[-1].back, yaw)]


def _half_turn(world: World, measures: Measures, side: float) -> list[Level]:
    """Turn on a landing as wide as both flights to the left (1) or to the right (-1)."""
    width = measures.width
    apart = width + world.uniform(*GAPS) + (measures.top_width - width) / 2
    below = _steps(measures, np.zeros(2), 0.0, _count(world, BEFORE_TURN))
    first = below[-1].back
    across = side * apart * left_of(0.0)
    landing = Level("landing", first + across / 2, 0.0, measures.before_turn + width, width + apart)
    above = _steps(measures, first + across, math.pi, _count(world, AFTER_TURN))
    return [*below, landing, *above, _top(measures, above[-1].back, math.pi)]


def _winder(world: World, flights: Flights, measures: Measures) -> tuple[list[Level], float]:
    """Turn with every step; the tread that is drawn lies where the flight is walked on."""
    turn = world.uniform(*TURNS)
    used = max(measures.tread, min(STANDING, flights.tread[1]))
    tread = max(used - turn * (measures.width / 2 - USED), SHORTEST)
    turn *= world.one_of(1.0, -1.0)
    levels = [Level("step", np.zeros(2), 0.0, tread, measures.width)]
    for _ in range(_count(world, WINDING) - 1):
        last = levels[-1]
        levels.append(Level("step", last.back, last.yaw + turn, tread, measures.width))
    last = levels[-1]
    top = Level("top", last.back, last.yaw + turn, measures.top, measures.width)
    return [*levels, top], turn


def _steps(measures: Measures, front: Floats, yaw: float, count: int) -> list[Level]:
    ahead = measures.tread * heading(yaw)
    return [
        Level("step", front + i * ahead, yaw, measures.tread, measures.width) for i in range(count)
    ]


def _top(measures: Measures, front: Floats, yaw: float) -> Level:
    return Level("top", front, yaw, measures.top, measures.top_width)


def _count(world: World, bounds: tuple[int, int]) -> int:
    return int(world.generator.integers(bounds[0], bounds[1] + 1))


def with_heights(levels: Sequence[Level], rises: Sequence[float]) -> list[Level]:
    """Return levels that are each higher by a rise than the one below."""
    heights = np.cumsum(rises).tolist()
    return [replace(level, height=height) for level, height in zip(levels, heights, strict=True)]
