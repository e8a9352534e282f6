"""Draws courses with stairs: the same seed gives the same staircase, start and friction."""

import math
from collections.abc import Iterable, Sequence
from typing import Any, Final

import numpy as np

Course = dict[str, Any]

RISES: Final = (0.010, 0.015, 0.020, 0.030, 0.040, 0.050, 0.055)
"""Metres: rises of the single step, from floor to more than the limit."""
HIGHEST: Final = 0.050
"""Metres: the limit of a step (IROS 2004, Table I)."""
_CORRIDOR: Final = 1.0
_STREAM: Final = 7
"""Keeps these draws apart from those of the same seed elsewhere."""


def ordinary(seed: int) -> Course:
    """Two to five steps of 20 to 50 mm, 11 to 20 cm deep, 33 cm wide or wider, up or down."""
    return _staircase(np.random.default_rng([_STREAM, seed]), "stairs_random", 0.020, HIGHEST)


def low(seed: int) -> Course:
    """The same with steps of 15 to 20 mm."""
    return _staircase(np.random.default_rng([_STREAM, seed]), "stairs_random_low", 0.015, 0.020)


def single(seed: int) -> Course:
    """One step across a corridor, a long platform behind it; its rise is one of `RISES` in turn."""
    generator = np.random.default_rng([_STREAM, seed])
    rise = RISES[seed % len(RISES)]
    start, physics = _pose(generator)
    course: list[Course] = [
        {"kind": "platform", "name": "step", "position": [0.6, 0.0], "size": [1.2, 1.0, rise]},
        *_corridor(-1.2, 1.2),
    ]
    refused = rise > HIGHEST
    goal = {"position": [0.6, 0.0]}
    return _scenario("step_random", start, goal, course, physics, refused=refused)


def _staircase(generator: np.random.Generator, name: str, lowest: float, highest: float) -> Course:
    """A staircase that stands free, all steps alike or each of its own height and depth."""
    count = int(generator.integers(2, 6))
    alike = bool(generator.integers(2))
    rises = generator.uniform(lowest, highest, count)
    treads = generator.uniform(0.11, 0.20, count)
    if alike:
        rises[:], treads[:] = rises[0], treads[0]
    width, down = float(generator.uniform(0.33, 0.9)), bool(generator.integers(2))
    start, physics = _pose(generator)
    top, depth = float(rises.sum()), float(treads[:-1].sum())
    goal: Course
    if not down:
        stairs = _stairs((0.0, 0.0), 0.0, rises, treads, width, landing=0.40)
        goal = {"position": [depth + 0.2, 0.0], "height": top, "radius": 0.1}
        return _scenario(name, start, goal, [stairs], physics)
    # From a platform down: the staircase ends at its edge, and the last rise is the platform's.
    course: list[Course] = [
        {"kind": "platform", "name": "top", "position": [-0.6, 0.0], "size": [1.2, 1.0, top]},
        _stairs((depth, 0.0), math.pi, rises[:-1], treads[:-1], width, landing=treads[-2]),
    ]
    goal = {"position": [depth + 0.6, 0.0], "height": 0.0}
    return _scenario(name, {**start, "height": top}, goal, course, physics)


def _pose(generator: np.random.Generator) -> tuple[Course, Course]:
    """Return start and physics: 0.4 to 0.8 m in front of x = 0, 20 degrees and 10 cm off."""
    x, y = -float(generator.uniform(0.4, 0.8)), float(generator.uniform(-0.1, 0.1))
    yaw = float(generator.uniform(-0.35, 0.35))
    return {"position": [x, y], "yaw": yaw}, {"friction": float(generator.uniform(0.6, 1.0))}


def _stairs(
    position: tuple[float, float],
    yaw: float,
    rises: Iterable[float],
    treads: Iterable[float],
    width: float,
    *,
    landing: float,
) -> Course:
    """Return a `[[course]]` entry of stairs."""
    heights, depths = [float(rise) for rise in rises], [float(tread) for tread in treads]
    return {
        "kind": "stairs",
        "name": "stairs",
        "position": list(position),
        "yaw": yaw,
        "steps": len(heights),
        "rise": heights,
        "tread": depths,
        "width": width,
        "landing": float(landing),
    }


def _corridor(begin: float, end: float) -> list[Course]:
    """Return walls on both sides and at the far end."""
    side = _CORRIDOR / 2 + 0.025
    lines = [((begin, y), (end, y)) for y in (side, -side)] + [((end, -side), (end, side))]
    return [{"kind": "wall", "from": list(a), "to": list(b), "height": 0.6} for a, b in lines]


def _scenario(
    name: str,
    start: Course,
    goal: Course,
    course: Sequence[Course],
    physics: Course,
    *,
    refused: bool = False,
) -> Course:
    """Return a whole scenario."""
    return {
        "schema": 1,
        "name": name,
        "time_limit": 180.0,
        "start": start,
        "goal": goal,
        "course": list(course),
        "physics": physics,
        "expect": {"outcome": "refused" if refused else "goal_reached"},
    }
