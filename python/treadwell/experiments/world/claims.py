"""All that the experiment claims: each case with how it has to end, in the order of its tables."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Final

from treadwell.experiments.experiment import Case
from treadwell.experiments.world import courses, inclines
from treadwell.experiments.world.claim import GOAL, ROBOTS, Claim, always, for_robot
from treadwell.experiments.world.courses import BOARDS
from treadwell.experiments.world.overhead import overhead, overhead_ends
from treadwell.experiments.world.parts import Part

HELD_SHARE: Final = 0.5
DRAWN_SHARE: Final = 10.0
"""Of worlds, and of things above the head: 200 where 20 seeds are asked for."""
SLOPES_SHARES: Final = {inclines.WALKED: 5.0, inclines.EITHER: 1.0, inclines.REFUSED: 2.0}
RANDOM_SHARE: Final = 5.0
WORLDS: Final = ("random_house", "random_yard")
RANDOM: Final = ("random_flat", "random_stairs")

Draw = Callable[[], Part]


@dataclass(frozen=True, slots=True)
class _Course:
    """A small course, and what its claims are.

    Attributes:
        draw: makes it.
        ends: the right ends.
        untouched: whether nothing may be met.
        judged: whether what varies may leave no way.
    """

    draw: Draw
    ends: tuple[str, ...] = (GOAL,)
    untouched: bool = True
    judged: bool = False


_BEVEL_ENDS: Final = (GOAL, "too_steep")
_COMPLAINTS: Final = (
    _Course(courses.table),
    _Course(courses.ceiling_flat, ("too_low",)),
    _Course(courses.head_room_on_stairs, ("too_low",)),
    _Course(courses.ceiling_step, ("too_low",)),
    _Course(courses.facing_wall),
    _Course(courses.stairs_down_near),
    _Course(courses.near_up),
    _Course(courses.low_near),
    _Course(courses.low_down_near),
    _Course(courses.ramp_edge, _BEVEL_ENDS),
    _Course(courses.door_sill_ramps, _BEVEL_ENDS),
    _Course(courses.ramp_corridor, judged=True),
    # A cable is felt before it is known.
    _Course(courses.cable_open, untouched=False),
    _Course(courses.cable_across, (GOAL, "blocked"), untouched=False),
    _Course(courses.start_by_wall),
)
_HELD: Final = (
    _Course(courses.nosing),
    _Course(courses.open_risers),
    _Course(courses.handrails),
    _Course(courses.narrow_corridor),
    _Course(courses.dead_end),
    _Course(courses.grating, (GOAL, "blocked", "no_path", "tread_too_short")),
)


def _one(draw: Draw, outcome: str, _seed: int) -> Part:
    """Return a course that is the same for every seed; what varies stands in it."""
    made = draw()
    return {**made, "expect": {**made["expect"], "outcome": outcome}}


def _claim(course: _Course, robot: str, share: float) -> Claim:
    name = course.draw.__name__
    beside = tuple((file, text) for file, text in BOARDS.items() if file == f"{name}.xml")
    outcome = "goal_reached" if GOAL in course.ends else "refused"
    scenario = for_robot(robot, partial(_one, course.draw, outcome))
    case = Case(f"{name}_{robot}", scenario, share=share, beside=beside)
    ends = always(*course.ends)
    return Claim(case, name, robot, ends, untouched=course.untouched, judged=course.judged)


def _slope_claim(band: tuple[float, float]) -> Claim:
    name = f"slopes_{band[0]:.0f}_to_{band[1]:.0f}"
    draw = partial(inclines.incline, band)
    case = Case(name, for_robot("qrio", draw), share=SLOPES_SHARES[band])
    return Claim(case, name, "qrio", always(*inclines.incline_ends(band)))


def _named(name: str, robot: str, share: float) -> Claim:
    case = Case(f"{name}_{robot}", name, (f"robot={robot}",), share=share)
    return Claim(case, name, robot, always(GOAL), judged=True)


def _overhead(robot: str) -> Claim:
    case = Case(f"overhead_{robot}", for_robot(robot, overhead), share=DRAWN_SHARE)
    return Claim(case, "overhead", robot, partial(overhead_ends, robot))


COMPLAINTS: Final = tuple(_claim(course, robot, 1.0) for course in _COMPLAINTS for robot in ROBOTS)
"""Small courses on which others' robots, and ours, went wrong."""
HELD: Final = tuple(_claim(course, "qrio", HELD_SHARE) for course in _HELD)
"""Small courses that went well, and have to."""
OVERHEAD: Final = tuple(_overhead(robot) for robot in ROBOTS)
SLOPES: Final = tuple(_slope_claim(band) for band in SLOPES_SHARES)
WORLD_CLAIMS: Final = tuple(_named(name, robot, DRAWN_SHARE) for name in WORLDS for robot in ROBOTS)
RANDOM_CLAIMS: Final = tuple(
    _named(name, robot, RANDOM_SHARE) for name in RANDOM for robot in ROBOTS
)
CLAIMS: Final = (*COMPLAINTS, *HELD, *OVERHEAD, *SLOPES, *WORLD_CLAIMS, *RANDOM_CLAIMS)
"""All but the faults, which are right or wrong in another way."""
