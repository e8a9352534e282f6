"""Slopes and bevels, drawn: up, down and across, to be walked on up to 10 degrees."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from treadwell.experiments.world.claim import GOAL
from treadwell.experiments.world.parts import Part, corridor, platform, ramp, scenario

WALKED: Final = (0.0, 10.0)
EITHER: Final = (10.0, 12.0)
REFUSED: Final = (12.0, 20.0)
"""Degrees: walked on; walked on or refused; refused."""
BEVEL_M: Final = 0.1
"""Length of a bevel."""
_STREAM: Final = 37
_WIDTH: Final = 0.9
_TOP: Final = 0.9
"""Metres: depth of the platform on top."""
WAYS: Final = ("up", "down", "across", "bevel")


@dataclass(frozen=True, slots=True)
class Incline:
    """What is drawn for a seed.

    Attributes:
        way: `up`, `down`; `across`: the slope leads to the left, the way up and along it; `bevel`:
            up and down over 10 cm each.
        degrees: against the ground.
        length: along the ground, m.
    """

    way: str
    degrees: float
    length: float

    @property
    def rise(self) -> float:
        """Metres between its edges."""
        return round(self.length * math.tan(math.radians(self.degrees)), 4)


def drawn(band: tuple[float, float], seed: int) -> Incline:
    """Return the slope of a seed, its angle within a band of degrees; the ways in turn.

    Bevels are within what is walked on: a steeper one is a step to one robot, a slope to another.
    """
    generator = np.random.default_rng([_STREAM, int(10 * band[1]), seed])
    degrees = float(generator.uniform(*band))
    ways = WAYS if band == WALKED else WAYS[:3]
    way = ways[seed % len(ways)]
    length = round(float(generator.uniform(0.5, 1.2)), 3)
    return Incline(way, degrees, BEVEL_M if way == "bevel" else length)


def incline(band: tuple[float, float], seed: int) -> Part:
    """Return the course of a seed."""
    one = drawn(band, seed)
    foot, top, rise = 0.7, 0.7 + one.length, max(one.rise, 1e-3)
    if one.way == "across":
        # The slope leads up to the left; the goal is on top and further on.
        course = [
            ramp("slope", (0.4, 0.35), one.length, 2.4, rise, yaw=math.pi / 2),
            platform("top", (0.4, 0.35 + one.length + _TOP / 2), (2.4, _TOP, rise)),
        ]
        goal = {"position": [1.0, 0.35 + one.length + _TOP / 2], "height": rise}
        return scenario("incline", goal, course)
    if one.way == "bevel":
        back = foot + 2 * one.length + 0.3
        course = [
            *corridor(back + 1.0),
            ramp("up", (foot, 0.0), one.length, _WIDTH, rise),
            platform("flat", (top + 0.15, 0.0), (0.3, _WIDTH, rise)),
            ramp("down", (back, 0.0), one.length, _WIDTH, rise, yaw=math.pi),
        ]
        return scenario("incline", {"position": [back + 0.5, 0.0]}, course)
    course = [
        *corridor(top + _TOP),
        ramp("slope", (foot, 0.0), one.length, _WIDTH, rise),
        platform("top", (top + _TOP / 2, 0.0), (_TOP, _WIDTH, rise)),
    ]
    upper = {"position": [top + _TOP / 2, 0.0], "height": rise}
    if one.way == "up":
        return scenario("incline", upper, course)
    start = {**upper, "yaw": math.pi}
    vary = {"start.yaw": {"uniform": [math.pi - 0.2, math.pi + 0.2]}}
    return scenario("incline", {"position": [0.1, 0.0]}, course, start=start, vary=vary)


def incline_ends(band: tuple[float, float]) -> frozenset[str]:
    """Return the right ends for a band of degrees."""
    return {
        WALKED: frozenset({GOAL}),
        EITHER: frozenset({GOAL, "too_steep"}),
        REFUSED: frozenset({"too_steep"}),
    }[band]
