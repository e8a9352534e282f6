"""What a world that draws itself is made with: named things, and room kept free around them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final, TypeVar

import numpy as np

from treadwell.course.outlines import Floats, convex_outline, rectangle, signed_distance
from treadwell.course.scatter import Ground, overlap
from treadwell.random_streams import stream
from treadwell.scenario.element_table import ElementTable
from treadwell.scenario.elements import Box, Cylinder, Door, Platform, Ramp, Stairs, Wall
from treadwell.scenario.events import Event, Move, SetDoor

LAYOUTS: Final = 120
"""Worlds that are tried before the element is refused."""
TRIES: Final = 2500
"""Places for things that are tried in all: a hopeless element is refused within seconds."""
WAYS: Final = 40
"""Whole layouts in all for which a way is looked for."""
PASSAGE: Final = 0.5
"""Metres: so wide a way stays free, or the robot's width and `SPARE` where that is more."""
SPARE: Final = 0.16
STOP: Final = 0.4
"""Metres around start, points to pass and goal in which nothing stands."""
CORNERS: Final = 16
Choice = TypeVar("Choice")


def is_closed(name: str, *, seed: int, share: float) -> bool:
    """Say whether a world leaves no way: in this share of seeds, whatever else is drawn.

    Args:
        name: the element's.
        seed: the episode's.
        share: 0 to 1.
    """
    return bool(stream(seed, f"course.{name}.closed").random() < share)


@dataclass(frozen=True)
class Drawn:
    """What an element that draws itself consists of.

    Attributes:
        elements: each with a name that no element of a file can have.
        events: what happens on the way.
    """

    elements: list[ElementTable]
    events: list[Event]


@dataclass
class Budget:
    """What is left of the tries that an element has."""

    places: int = TRIES
    ways: int = WAYS

    @property
    def is_spent(self) -> bool:
        """Whether nothing more may be tried."""
        return self.places <= 0 or self.ways <= 0


@dataclass
class World:
    """A world while it is drawn.

    Attributes:
        of: the element that draws itself: its things are seen and mapped as it says.
        name: its name, before each thing's.
        generator: of all that is random in it.
        budget: what the element may still try, over all its layouts.
        elements: what it has so far.
        events: what will happen.
        solid: (n, 2) outlines of what stands in the way at any height.
        kept: (n, 2) outlines of where nothing more may stand.
        raised: (n, 2) outlines of what is no level floor, though one can walk on it.
    """

    of: ElementTable
    name: str
    generator: np.random.Generator
    budget: Budget
    elements: list[ElementTable] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    solid: list[Floats] = field(default_factory=list)
    kept: list[Floats] = field(default_factory=list)
    raised: list[Floats] = field(default_factory=list)
    _counts: dict[str, int] = field(default_factory=dict)

    def uniform(self, low: float, high: float) -> float:
        """Return a number between two."""
        return float(self.generator.uniform(low, high))

    def happens(self, share: float) -> bool:
        """Say yes in a share of cases, 0 to 1."""
        return bool(self.generator.random() < share)

    def one_of(self, *choices: Choice) -> Choice:
        """Return one of the choices."""
        return choices[int(self.generator.integers(len(choices)))]

    def called(self, thing: str) -> str:
        """Return the next name of a kind of thing."""
        self._counts[thing] = self._counts.get(thing, 0) + 1
        return f"{self.name}.{thing} {self._counts[thing]}"

    def box(
        self, name: str, position: Floats, yaw: float, size: Sequence[float], base: float = 0.0
    ) -> None:
        """Add an obstacle; where it hangs, its underside is `base` above the ground."""
        self._add(Box, "box", name, position, yaw=yaw, size=tuple(size), base=base)

    def cylinder(self, name: str, position: Floats, radius: float, height: float) -> None:
        """Add an upright round obstacle."""
        self._add(Cylinder, "cylinder", name, position, radius=radius, height=height)

    def platform(self, name: str, position: Floats, yaw: float, size: Sequence[float]) -> None:
        """Add a block with a walkable top."""
        self._add(Platform, "platform", name, position, yaw=yaw, size=tuple(size))

    def ramp(
        self, name: str, position: Floats, yaw: float, *, length: float, width: float, rise: float
    ) -> None:
        """Add an inclined plane; position: middle of the low edge."""
        self._add(Ramp, "ramp", name, position, yaw=yaw, length=length, width=width, rise=rise)

    def stairs(self, name: str, position: Floats, yaw: float, **keys: object) -> None:
        """Add a flight; position: middle of the first riser's foot."""
        self._add(Stairs, "stairs", name, position, yaw=yaw, **keys)

    def door(self, name: str, position: Floats, yaw: float, **keys: object) -> None:
        """Add a door with a leaf; position: middle of the opening."""
        self._add(Door, "door", name, position, yaw=yaw, **keys)

    def wall(self, name: str, begin: Floats, end: Floats, height: float, thickness: float) -> None:
        """Add a wall from one place to another, and what it takes to `solid`."""
        if math.dist(begin, end) < thickness:
            return
        points = {"from_": _point(begin), "to": _point(end)}
        self._add(Wall, "wall", name, None, height=height, thickness=thickness, **points)
        self.solid.append(strip(begin, end, thickness))

    def walks(self, name: str, path: Sequence[Floats], at: float, speed: float) -> None:
        """Let a thing walk to and fro along a path from a time on, s."""
        self.events.append(
            Move.model_construct(
                do="move",
                at=at,
                name=name,
                path=tuple(_point(place) for place in path),
                loop=True,
                speed=speed,
                gives_way=True,
            )
        )

    def shuts(self, name: str, near: Floats, within: float) -> None:
        """Let a door be shut when the robot comes near a place."""
        self.events.append(
            SetDoor.model_construct(
                do="set_door", near=_point(near), within=within, name=name, open=0.0
            )
        )

    def is_free(self, outline: Floats, *, clear: float = 0.0) -> bool:
        """Say whether nothing stands within an outline (n, 2), and nothing is kept free there.

        Args:
            outline: convex.
            clear: how far it has to be from what stands there, metres.
        """
        self.budget.places -= 1
        if self.budget.is_spent or any(
            overlap(outline, other) for other in (*self.solid, *self.kept)
        ):
            return False
        if clear == 0.0:
            return True
        grown = convex_outline(np.vstack([disc(corner, clear) for corner in outline]))
        return not any(overlap(grown, other) for other in self.solid)

    def has_way(self, stops: Floats, area: Sequence[Sequence[float]], passage: float) -> bool:
        """Say whether a way of some width leads over all stops (n, 2), on the level, metres."""
        self.budget.ways -= 1
        return Ground(list(stops), self.solid, area, passage).is_connected([])

    def drawn(self) -> Drawn:
        """Return what was drawn."""
        return Drawn(self.elements, self.events)

    def _add(
        self,
        model: type[ElementTable],
        kind: str,
        name: str,
        position: Floats | None,
        **keys: object,
    ) -> None:
        # The name has a dot, which no name in a file can have: so it is never taken. Every number
        # is within the element's own checked limits, so that nothing is left to check.
        if position is not None:
            keys["position"] = _point(position)
        keys |= {"texture": self.of.texture, "mapped": self.of.mapped}
        self.elements.append(model.model_construct(None, kind=kind, name=name, **keys))


def _point(place: Floats) -> tuple[float, float]:
    return float(place[0]), float(place[1])


def disc(middle: Floats, radius: float) -> Floats:
    """Return an outline (n, 2) around a disc."""
    angles = np.arange(CORNERS) * 2 * np.pi / CORNERS
    around = radius / math.cos(math.pi / CORNERS)
    circle: Floats = middle + around * np.column_stack([np.cos(angles), np.sin(angles)])
    return circle


def strip(begin: Floats, end: Floats, width: float) -> Floats:
    """Return the outline (4, 2) of a line of some width."""
    yaw = math.atan2(end[1] - begin[1], end[0] - begin[0])
    return rectangle(begin, yaw, (0.0, math.dist(begin, end)), width)


def away(outlines: Sequence[Floats], places: Floats) -> float:
    """Return the least distance of places (n, 2) from outlines, negative inside, metres."""
    return min((float(signed_distance(each, places).min()) for each in outlines), default=math.inf)
