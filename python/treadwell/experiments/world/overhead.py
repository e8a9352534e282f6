"""Things above the head, their height drawn: desks, lamps, lintels and ceilings, over steps too."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from treadwell.experiments.world.claim import GOAL
from treadwell.experiments.world.parts import Part, box, corridor, desk, flight, scenario
from treadwell.robot.load import load_robot

LEAST, MOST = 0.45, 0.75
"""Metres of room below what hangs."""
SPARE: Final = 0.04
"""Metres: with so much more than its height a robot has to pass."""
_STREAM: Final = 31
_ACROSS: Final = 1.0
"""Metres: from wall to wall of the corridor, and into them."""
_RISE: Final = 0.03
_STEPS: Final = 3


@dataclass(frozen=True, slots=True)
class Overhead:
    """What is drawn for a seed.

    Attributes:
        kind: `desk`, `lamp`: there is a way around; `lintel`, `ceiling`, `landing`: there is none.
        room: below it, m.
        depth: along the way, m.
    """

    kind: str
    room: float
    depth: float

    def ends(self, height: float) -> frozenset[str]:
        """Return the right ends for a robot of this height, m."""
        if self.kind in {"desk", "lamp"} or self.room >= height + SPARE:
            return frozenset({GOAL})
        return frozenset({"too_low"} if self.room < height else {GOAL, "too_low"})


KINDS: Final = ("desk", "lamp", "lintel", "ceiling", "landing")


def drawn(seed: int) -> Overhead:
    """Return what hangs where for a seed: the kinds in turn."""
    generator = np.random.default_rng([_STREAM, seed])
    kind = KINDS[seed % len(KINDS)]
    room = round(float(generator.uniform(LEAST, MOST)), 3)
    deepest = {"desk": 0.9, "lamp": 0.2, "lintel": 0.15, "ceiling": 1.0, "landing": 1.0}[kind]
    depth = round(float(generator.uniform(0.4 * deepest, deepest)), 3)
    return Overhead(kind, room, depth)


def overhead(seed: int) -> Part:
    """Return the course of a seed."""
    one = drawn(seed)
    if one.kind == "desk":
        course = desk((1.4, 0.0), (one.depth, 1.2), one.room)
    elif one.kind == "lamp":
        course = [box("lamp", (1.3, 0.0), (one.depth, one.depth, 0.25), one.room)]
    elif one.kind == "landing":
        top = _RISE * _STEPS
        ceiling = box(
            "ceiling", (1.35 + one.depth / 2, 0.0), (one.depth, _ACROSS, 0.05), top + one.room
        )
        course = [*corridor(2.9), flight(_STEPS, _RISE, 0.12, 0.9, 2.0), ceiling]
        return scenario("overhead", {"position": [2.5, 0.0], "height": top}, course)
    else:
        across = box(one.kind, (1.6, 0.0), (one.depth, _ACROSS, 0.05), one.room)
        course = [*corridor(3.0), across]
    return scenario("overhead", {"position": [2.6, 0.0]}, course)


def overhead_ends(robot: str, seed: int) -> frozenset[str]:
    """Return the right ends of a robot on the course of a seed."""
    return drawn(seed).ends(load_robot(robot).file.body.height)
