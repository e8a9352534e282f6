"""All that the experiment claims: each case with how it has to end, in the order of its tables."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Final

from treadwell.experiments.experiment import Case
from treadwell.experiments.world import courses, inclines
from treadwell.experiments.world.claim import GOAL, ROBOTS, Claim, Ends, always, for_robot
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
_AROUND_OR_OVER: Final = (GOAL, "too_steep")

_COMPLAINTS: Final[tuple[tuple[Draw, tuple[str, ...], bool], ...]] = (
    (courses.table, (GOAL,), True),
    (courses.ceiling_flat, ("too_low",), True),
    (courses.head_room_on_stairs, ("too_low",), True),
    (courses.ceiling_step, ("too_low",), True),
    (courses.facing_wall, (GOAL,), True),
    (courses.stairs_down_near, (GOAL,), True),
    (courses.near_up, (GOAL,), True),
    (courses.low_near, (GOAL,), True),
    (courses.low_down_near, (GOAL,), True),
    (courses.ramp_edge, _AROUND_OR_OVER, True),
    (courses.door_sill_ramps, _AROUND_OR_OVER, True),
    (courses.ramp_corridor, (GOAL,), True),
    (courses.cable_open, (GOAL,), False),
    (courses.cable_across, (GOAL, "blocked"), False),
    (courses.start_by_wall, (GOAL,), True),
)
"""Course, right ends, and whether nothing may be met: a cable is felt before it is known."""

_HELD: Final[tuple[tuple[Draw, tuple[str, ...]], ...]] = (
    (courses.nosing, (GOAL,)),
    (courses.open_risers, (GOAL,)),
    (courses.handrails, (GOAL,)),
    (courses.narrow_corridor, (GOAL,)),
    (courses.dead_end, (GOAL,)),
    (courses.grating, (GOAL, "blocked", "no_path", "tread_too_short")),
)


def _one(draw: Draw, outcome: str, _seed: int) -> Part:
    """Return a course that is the same for every seed; what varies stands in it."""
    made = draw()
    return {**made, "expect": {**made["expect"], "outcome": outcome}}


def _course(draw: Draw, robot: str, ends: tuple[str, ...], *, met: bool, share: float) -> Claim:
    name = draw.__name__
    beside = tuple((file, text) for file, text in BOARDS.items() if file == f"{name}.xml")
    outcome = "goal_reached" if GOAL in ends else "refused"
    scenario = for_robot(robot, partial(_one, draw, outcome))
    case = Case(f"{name}_{robot}", scenario, share=share, beside=beside)
    judged = draw is courses.ramp_corridor
    return Claim(case, name, robot, always(*ends), untouched=not met, judged=judged)


def _complaints() -> Iterator[Claim]:
    for draw, ends, untouched in _COMPLAINTS:
        for robot in ROBOTS:
            yield _course(draw, robot, ends, met=not untouched, share=1.0)


def _slope_claim(band: tuple[float, float]) -> Claim:
    name = f"slopes_{band[0]:.0f}_to_{band[1]:.0f}"
    draw = partial(inclines.incline, band)
    case = Case(name, for_robot("qrio", draw), share=SLOPES_SHARES[band])
    return Claim(case, name, "qrio", always(*inclines.incline_ends(band)))


def _named(name: str, robot: str, share: float, ends: Ends) -> Claim:
    case = Case(f"{name}_{robot}", name, (f"robot={robot}",), share=share)
    return Claim(case, name, robot, ends, judged=True)


def _overhead(robot: str) -> Claim:
    case = Case(f"overhead_{robot}", for_robot(robot, overhead), share=DRAWN_SHARE)
    return Claim(case, "overhead", robot, partial(overhead_ends, robot))


COMPLAINTS: Final = tuple(_complaints())
"""Small courses on which others' robots, and ours, went wrong."""
HELD: Final = tuple(
    _course(draw, "qrio", ends, met=False, share=HELD_SHARE) for draw, ends in _HELD
)
"""Small courses that went well, and have to."""
OVERHEAD: Final = tuple(_overhead(robot) for robot in ROBOTS)
SLOPES: Final = tuple(_slope_claim(band) for band in SLOPES_SHARES)
WORLD_CLAIMS: Final = tuple(
    _named(name, robot, DRAWN_SHARE, always(GOAL)) for name in WORLDS for robot in ROBOTS
)
RANDOM_CLAIMS: Final = tuple(
    _named(name, robot, RANDOM_SHARE, always(GOAL)) for name in RANDOM for robot in ROBOTS
)
CLAIMS: Final = (*COMPLAINTS, *HELD, *OVERHEAD, *SLOPES, *WORLD_CLAIMS, *RANDOM_CLAIMS)
"""All but the faults, which are right or wrong in another way."""
