"""What the experiment `footsteps` runs: scenarios for both robots, and what is asked of each."""

from dataclasses import dataclass
from functools import partial
from typing import Final

from treadwell.experiments.experiment import Case
from treadwell.experiments.world.claim import GOAL, ROBOTS, Claim, always, for_robot
from treadwell.experiments.world.parts import Part, platform, scenario, wall
from treadwell.measuring.level_watch import LevelWatch

BEHAVIOUR: Final = "footsteps"
"""What walks: a behaviour's name. The one that plans each foot, unless another is asked for."""
SCENARIOS: Final = (
    "l_stairs",
    "l_stairs_down",
    "u_stairs",
    "u_stairs_down",
    "winder",
    "winder_down",
    "spiral_12",
    "spiral_12_down",
    "stairs_beside",
    "stairs_behind",
    "two_flights",
    "two_flights_down",
    "stepping_stones",
    "slabs",
)
"""Those that were laid out for planned steps."""
FAMILY: Final = "random_flights"
FAMILY_SHARE: Final = 10.0
"""200 where 20 seeds are asked for."""
TIMED: Final = ("stairs_up", "obstacle_course")
"""Others that are timed, as `l_stairs` is."""
OF_20: Final = {"qrio": 19, "nao": 18}
"""Goals wanted of 20 runs of a scenario."""


@dataclass(frozen=True, slots=True)
class Time:
    """Seconds to the goal, medians of `qrio`.

    Attributes:
        before: what took the behaviour `stair_climbing`.
        wanted: what is asked for.
    """

    before: str
    wanted: str


TIMES: Final = {
    "l_stairs": Time("71 to 200", "35"),
    "stairs_up": Time("35", "22"),
    "obstacle_course": Time("85", "60"),
}


@dataclass(frozen=True, slots=True)
class Suite:
    """What a behaviour is held against.

    Attributes:
        walks: each scenario with each robot.
        families: courses that are drawn, some of which have no way to the goal.
        bars: a thin bar across the way.
    """

    walks: tuple[Claim, ...]
    families: tuple[Claim, ...]
    bars: tuple[Claim, ...]

    @property
    def cases(self) -> tuple[Case, ...]:
        """What is run, in the order of the tables."""
        return tuple(claim.case for claim in (*self.walks, *self.families, *self.bars))


def suite_of(behaviour: str = BEHAVIOUR) -> Suite:
    """Return what is run with a behaviour of `treadwell list components`, or a class."""
    walks = [(name, robot) for name in SCENARIOS for robot in ROBOTS]
    walks += [(name, "qrio") for name in TIMED]
    return Suite(
        walks=tuple(_walk(name, robot, behaviour) for name, robot in walks),
        families=tuple(
            _walk(FAMILY, robot, behaviour, share=FAMILY_SHARE, judged=True) for robot in ROBOTS
        ),
        bars=tuple(_bar(robot, behaviour) for robot in ROBOTS),
    )


def _walk(
    name: str, robot: str, behaviour: str, *, share: float = 1.0, judged: bool = False
) -> Claim:
    settings = (f"robot={robot}", f"navigation.behaviour={behaviour}")
    case = Case(f"{name}_{robot}", name, settings, share=share, watch=LevelWatch)
    # A touch keeps a run from being as expected, and is counted; the goal is the goal.
    return Claim(case, name, robot, always(GOAL), untouched=False, judged=judged)


def _bar(robot: str, behaviour: str) -> Claim:
    settings = (f"navigation.behaviour={behaviour}",)
    case = Case(f"bar_{robot}", for_robot(robot, partial(_same, bar())), settings)
    ends = always(GOAL, "blocked", "no_path", "tread_too_short", "gap_too_short")
    return Claim(case, "bar", robot, ends)


def bar() -> Part:
    """A bar 10 mm deep and 25 mm high, across a corridor: step over it, or refuse untouched."""
    course = [
        platform("bar", (1.0, 0.0), (0.01, 1.8, 0.025)),
        *(
            wall(f"{name} wall", (-0.6, y), (2.4, y))
            for name, y in (("left", 0.9), ("right", -0.9))
        ),
        *(wall(f"{name} wall", (x, -0.9), (x, 0.9)) for name, x in (("near", -0.6), ("end", 2.4))),
    ]
    return scenario("bar", {"position": [1.9, 0.0]}, course)


def _same(made: Part, _seed: int) -> Part:
    return made
