"""Rooms of a house: an area cut again and again, and where doors can lead from one to another."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from treadwell.course.outlines import Floats
from treadwell.course.worlds.drawing import STOP

LEAST: Final = 1.2
"""Metres: no room is narrower."""
JAMB: Final = 0.12
"""Metres of wall between an opening and the next wall, at least."""


@dataclass(frozen=True)
class Room:
    """A room between the middles of its walls: lower and upper corner (2,), world, metres."""

    low: Floats
    high: Floats

    def holds(self, place: Floats) -> bool:
        """Say whether a place lies in it."""
        return bool((place >= self.low).all() and (place <= self.high).all())


@dataclass(frozen=True)
class Cut:
    """A wall between rooms: it lies at `at` along `axis` and reaches from `low` to `high`."""

    axis: int
    at: float
    low: float
    high: float

    def point(self, along: float) -> Floats:
        """Return the place of the wall at a coordinate along it, (2,)."""
        place = np.empty(2)
        place[self.axis], place[1 - self.axis] = self.at, along
        return place


@dataclass(frozen=True)
class Opening:
    """Where one can pass from room to room: a place along a cut."""

    cut: int
    rooms: tuple[int, int]
    along: float
    width: float


def cut_rooms(
    generator: np.random.Generator, area: Sequence[Sequence[float]], count: int, stops: Floats
) -> tuple[list[Room], list[Cut]] | None:
    """Cut an area into rooms; return None where it went wrong.

    Args:
        generator: what is drawn from.
        area: lower and upper corner.
        count: of rooms.
        stops: (n, 2): no wall comes near.
    """
    rooms = [Room(np.array(area[0]), np.array(area[1]))]
    cuts: list[Cut] = []
    while len(rooms) < count:
        sizes = np.array([float(np.prod(room.high - room.low)) for room in rooms])
        number = int(generator.choice(len(rooms), p=sizes**2 / (sizes**2).sum()))
        room = rooms[number]
        extent = room.high - room.low
        axis = int(np.argmax(extent * generator.uniform(0.7, 1.0, 2)))
        low, high = room.low[axis] + LEAST, room.high[axis] - LEAST
        inside = [stop[axis] for stop in stops if room.holds(stop)]
        at = float(generator.uniform(low, max(high, low)))
        if high < low or any(abs(at - stop) < STOP for stop in inside):
            return None
        upper, lower = room.low.copy(), room.high.copy()
        upper[axis] = lower[axis] = at
        rooms[number : number + 1] = [Room(room.low, lower), Room(upper, room.high)]
        cuts.append(Cut(axis, at, float(room.low[1 - axis]), float(room.high[1 - axis])))
    return rooms, cuts


def shared(rooms: Sequence[Room], cuts: Sequence[Cut]) -> list[tuple[int, int, int, float, float]]:
    """Return cut, two rooms that it parts, and from where to where along it."""
    found = []
    for number, cut in enumerate(cuts):
        across = 1 - cut.axis
        before = [i for i, room in enumerate(rooms) if abs(room.high[cut.axis] - cut.at) < 1e-9]
        behind = [i for i, room in enumerate(rooms) if abs(room.low[cut.axis] - cut.at) < 1e-9]
        for i in before:
            for j in behind:
                low = max(rooms[i].low[across], rooms[j].low[across], cut.low)
                high = min(rooms[i].high[across], rooms[j].high[across], cut.high)
                if high > low:
                    found.append((number, i, j, float(low), float(high)))
    return found


def openings(
    generator: np.random.Generator,
    rooms: Sequence[Room],
    cuts: Sequence[Cut],
    widths: tuple[float, float],
) -> list[Opening] | None:
    """Return openings by which all rooms can be reached, and some more; None where it went wrong.

    Args:
        generator: what is drawn from.
        rooms: of the house.
        cuts: the walls between them.
        widths: least and largest width of an opening, metres.
    """
    made: list[Opening] = []
    group = list(range(len(rooms)))
    candidates = shared(rooms, cuts)
    for number in generator.permutation(len(candidates)):
        cut, i, j, low, high = candidates[int(number)]
        width = float(generator.uniform(*widths))
        spare = width / 2 + JAMB
        if high - low < 2 * spare:
            continue
        joins = group[i] != group[j]
        if not joins and generator.random() > 0.5:
            continue
        group = [group[i] if each == group[j] else each for each in group]
        halves = [(low, high)]
        if high - low > 4 * spare and generator.random() < 0.35:
            halves = [(low, (low + high) / 2), ((low + high) / 2, high)]
        for begin, end in halves:
            along = float(generator.uniform(begin + spare, end - spare))
            made.append(Opening(cut, (i, j), along, width))
    return made if len(set(group)) == 1 else None


def hops(count: int, doors: Sequence[Opening], start: int, shut: int | None = None) -> list[int]:
    """Return for each room how many openings lead to it from a room; -1 where none does.

    Args:
        count: of rooms.
        doors: the openings.
        start: the room that is left.
        shut: an opening that one cannot pass.
    """
    found = [-1] * count
    found[start] = 0
    front = [start]
    for room in front:
        for number, door in enumerate(doors):
            for here, there in (door.rooms, door.rooms[::-1]):
                if here == room and found[there] < 0 and number != shut:
                    found[there] = found[room] + 1
                    front.append(there)
    return found
