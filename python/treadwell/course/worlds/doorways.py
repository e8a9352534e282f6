"""Where one passes from room to room in a house: openings, doors, thresholds."""

import math
from collections.abc import Collection, Sequence
from typing import Final

from treadwell.course.doors import leaf_piece
from treadwell.course.outlines import Floats, heading, left_of, rectangle
from treadwell.course.worlds.drawing import World
from treadwell.course.worlds.rooms import Cut, Opening, Room, hops
from treadwell.scenario.elements import Door

WIDTHS: Final = (0.58, 0.78)
"""Metres: least and largest width of an opening."""
LINTELS: Final = (0.66, 0.85)
"""Metres: least and largest height of an opening that one can pass."""
LOW: Final = (0.40, 0.53)
"""The same of one that one cannot."""
NARROW: Final = (0.14, 0.22)
AJAR: Final = (0.70, 0.90)
"""How far a door is open that stands ajar: 63 to 81 degrees."""
BARELY: Final = (0.08, 0.18)
"""The same of one that one cannot pass: at most 22 cm between leaf and jamb."""
SHUTS: Final = 0.9
"""Metres from a door at which somebody shuts it before the robot."""
BEVELS: Final = (math.radians(5.0), math.radians(9.5))
THRESHOLDS: Final = (0.008, 0.016)
ZONE: Final = 0.45
"""Metres before and behind an opening that stay free."""


class Doorways:
    """Draws the walls between rooms with all that is in their openings."""

    def __init__(
        self,
        world: World,
        things: Collection[str],
        rooms: Sequence[Room],
        cuts: Sequence[Cut],
        doors: Sequence[Opening],
        thickness: float,
        height: float,
    ) -> None:
        """Draw nothing yet.

        Args:
            world: what it is drawn into.
            things: what the house may hold.
            rooms: of the house.
            cuts: the walls between them.
            doors: the openings.
            thickness: of the walls, metres.
            height: of the walls, metres.
        """
        self._world, self._things = world, things
        self._rooms, self._cuts, self._doors = rooms, cuts, doors
        self._thickness, self._height = thickness, height

    def point(self, number: int) -> Floats:
        """Return the middle of an opening, (2,)."""
        door = self._doors[number]
        return self._cuts[door.cut].point(door.along)

    def _span(self, number: int) -> tuple[float, float]:
        door = self._doors[number]
        return door.along - door.width / 2, door.along + door.width / 2

    def draw(self, away: Sequence[int], closed: Collection[int]) -> None:
        """Draw all walls.

        Args:
            away: for each room how many openings lie between it and the start's.
            closed: openings that one cannot pass.
        """
        how = self._closing() if closed else ""
        shut = None if closed else self._one_that_shuts(away)
        for number, cut in enumerate(self._cuts):
            inside = [i for i, door in enumerate(self._doors) if door.cut == number]
            inside.sort(key=lambda i: self._doors[i].along)
            begin = cut.low
            for i, following in zip(inside, [*inside[1:], None], strict=False):
                end = cut.high
                if following is not None:
                    end = (self._doors[i].along + self._doors[following].along) / 2
                what = how if i in closed else ("shuts" if i == shut else self._ordinary())
                self._draw(i, begin, end, self._yaw(i, away), what)
                if i == shut:
                    outline = _strip(cut, *self._span(i), self._thickness)
                    self._world.solid.append(outline)
                begin = end
            if not inside:
                low, high = cut.point(cut.low), cut.point(cut.high)
                name = self._world.called("wall")
                self._world.wall(name, low, high, self._height, self._thickness)

    def _closing(self) -> str:
        """Return how all ways are closed."""
        ways = ["low", "narrow"]
        if "door" in self._things:
            ways += ["shut", "barely", "shuts"]
        return str(self._world.one_of(*ways))

    def _ordinary(self) -> str:
        """Return what is in an opening that one can pass."""
        ways = ["plain"]
        if "door" in self._things:
            ways += ["open", "open", "ajar"]
        if "bevel" in self._things:
            ways += ["bevel"]
        return str(self._world.one_of(*ways))

    def _one_that_shuts(self, away: Sequence[int]) -> int | None:
        """Return a door that may be shut on the way, since another way leads everywhere."""
        if "door" not in self._things or self._world.happens(0.4):
            return None
        count, start = len(self._rooms), away.index(0)
        spare = [
            i for i in range(len(self._doors)) if min(hops(count, self._doors, start, shut=i)) >= 0
        ]
        return int(self._world.one_of(*spare)) if spare else None

    def _yaw(self, number: int, away: Sequence[int]) -> float:
        """Return the way through an opening as the robot comes: from the start's room on."""
        door = self._doors[number]
        before, behind = (away[room] for room in door.rooms)
        ahead = before < behind or (before == behind and self._world.happens(0.5))
        yaw = 0.0 if self._cuts[door.cut].axis == 0 else math.pi / 2
        return yaw if ahead else yaw - math.pi

    def _draw(self, number: int, begin: float, end: float, yaw: float, what: str) -> None:
        """Draw an opening and the wall around it, from one coordinate along the wall to another."""
        world, door = self._world, self._doors[number]
        cut, middle, width = self._cuts[door.cut], self.point(number), door.width
        lintel = world.uniform(*(LOW if what == "low" else LINTELS))
        # Where another wall begins, this one ends at that one's middle.
        low, high = self._span(number)
        sides = [low - begin, end - high]
        for part in ((begin, low), (high, end)):
            world.solid.append(_strip(cut, *part, self._thickness))
        left, right = sides if left_of(yaw)[1 - cut.axis] < 0.0 else sides[::-1]
        if what == "narrow":
            less = (width - world.uniform(*NARROW)) / 2
            left, right, width = left + less, right + less, width - 2 * less
        world.kept.append(rectangle(middle, yaw, (-ZONE, ZONE), door.width))
        if what in {"plain", "bevel", "low", "narrow"}:
            self._opening(middle, yaw, (left, width, right), lintel)
            if what == "bevel":
                self._bevel(middle, yaw, width)
            return
        opened = {
            "open": world.uniform(0.95, 1.0),
            "ajar": world.uniform(*AJAR),
            "shut": 0.0,
            "barely": world.uniform(*BARELY),
            "shuts": 1.0,
        }[what]
        name = world.called("door")
        keys = {
            "width": width,
            "height": lintel,
            "wall": (left, right, self._height),
            "thickness": self._thickness,
            "open": opened,
        }
        world.door(name, middle, yaw, **keys)
        if what in {"open", "ajar", "shuts"}:
            leaf = Door.model_construct(None, position=tuple(middle.tolist()), yaw=yaw, **keys)
            world.solid.append(leaf_piece(leaf).outline)
        if what == "shuts":
            world.shuts(name, middle, SHUTS)

    def _opening(
        self, middle: Floats, yaw: float, sides: tuple[float, float, float], lintel: float
    ) -> None:
        """Draw an opening without a leaf: wall to the left and to the right, and the lintel."""
        world = self._world
        to_left, width, to_right = sides
        across = left_of(yaw)
        for sign, extent in ((1.0, to_left), (-1.0, to_right)):
            near = middle + sign * width / 2 * across
            far = near + sign * extent * across
            world.wall(world.called("wall"), near, far, self._height, self._thickness)
        over = (self._thickness, width, self._height - lintel)
        world.box(world.called("lintel"), middle, yaw, over, base=lintel)

    def _bevel(self, middle: Floats, yaw: float, width: float) -> None:
        """Draw a threshold with a bevel before and behind it."""
        world = self._world
        rise = world.uniform(*THRESHOLDS)
        length = rise / math.tan(world.uniform(*BEVELS))
        half = self._thickness / 2
        inside = width - 0.01
        world.platform(world.called("threshold"), middle, yaw, (2 * half, inside, rise))
        world.raised.append(rectangle(middle, yaw, (-half - length, half + length), inside))
        for turned in (yaw, yaw + math.pi):
            foot = middle - (half + length) * heading(turned)
            keys = {"length": length, "width": inside, "rise": rise}
            world.ramp(world.called("bevel"), foot, turned, **keys)


def _strip(cut: Cut, low: float, high: float, thickness: float) -> Floats:
    """Return the outline of a part of a wall, (4, 2)."""
    middle = cut.point((low + high) / 2)
    yaw = 0.0 if cut.axis == 0 else math.pi / 2
    return rectangle(middle, yaw, (-thickness / 2, thickness / 2), max(high - low, 0.01))
