"""What the experiment `nao` runs: a NAO with a map of a house on two levels (Maier 2012)."""

from dataclasses import dataclass
from functools import partial
from typing import Final

from treadwell.experiments.experiment import NOTHING, Case
from treadwell.experiments.nao_filters import with_other_draws
from treadwell.measuring.visitor_watch import VisitorWatch
from treadwell.measuring.walk_watch import WalkWatch

WORLD_MODELS: Final = ("octree", "fog")
"""The paper's map and the one of Gutmann 2005; both on the same scenarios."""
FILTERS: Final = 5
"""Filters over one walk, each with random numbers of its own."""
ROBOTS: Final = ("nao", "qrio")


@dataclass(frozen=True, slots=True)
class Scenario:
    """One of the paper's three.

    Attributes:
        number: in the paper.
        mean: of the error in the plane, by Table I, m.
        std: its standard deviation, m.
        wanted: of the mean, m.
    """

    number: int
    mean: float
    std: float
    wanted: float


SCENARIOS: Final = (
    Scenario(1, 0.07, 0.04, 0.04),
    Scenario(2, 0.09, 0.07, 0.05),
    Scenario(3, 0.07, 0.05, 0.04),
)


def walked(number: int, model: str) -> str:
    """Return the name of the case of a scenario with a world model."""
    return f"nao_{number}_{model}"


def filtered(draw: int) -> str:
    """Return the name of the case of scenario 1 as seen by a filter with other random numbers."""
    return f"nao_1_filter_{draw}"


def _model(name: str) -> tuple[str, ...]:
    return (f"navigation.world_model={name}",)


def _walk(number: int, model: str) -> Case:
    return Case(walked(number, model), f"nao_{number}", _model(model), watch=WalkWatch)


def _filter(draw: int) -> Case:
    """Return the walk of the first seed alone; its own filter is the draw 0."""
    return Case(
        filtered(draw),
        "nao_1",
        _model("octree"),
        share=0.0,
        watch=WalkWatch,
        afterwards=partial(with_other_draws, draw=draw),
    )


VISITOR: Final = "visitor_nao"
VISITOR_MOVES: Final = "visitor_nao_moves"
VISITORS: Final = (VISITOR, VISITOR_MOVES)
_COMES_WALKING: Final = (
    'event=[{near=[0.9, 2.2], within=0.25, do="add", element={kind="box", name="visitor", '
    "position=[1.75, 2.9], size=[0.3, 0.3, 0.6]}}, "
    '{near=[0.9, 2.2], within=0.25, do="move", name="visitor", to=[1.75, 2.0], speed=0.2}]'
)
"""The same visitor comes from the side, at 0.2 m/s."""

UNKNOWN_ABOVE: Final = "two_levels_unknown_above"
UNKNOWN_BELOW: Final = "two_levels_unknown_below"
KIDNAPPED: Final = "kidnapped"
FINDING: Final = (UNKNOWN_ABOVE, UNKNOWN_BELOW, KIDNAPPED)


def _somewhere(x: tuple[float, float], y: tuple[float, float]) -> tuple[str, ...]:
    """Return settings that draw the start in a rectangle, m."""
    return tuple(
        f'vary."start.position.{axis}"={{uniform=[{low},{high}]}}'
        for axis, (low, high) in enumerate((x, y))
    )


_UNKNOWN: Final = "two_levels_unknown"
_ABOVE: Final = _somewhere((4.3, 6.0), (2.0, 3.6))
_BELOW: Final = ("start.height=0.0", *_somewhere((0.5, 1.6), (1.5, 2.6)))


@dataclass(frozen=True, slots=True)
class Claim:
    """A row of what is reached.

    Attributes:
        case: what is run.
        robot: which walks.
        wanted: share of the runs that have to go as the scenario expects.
    """

    case: Case
    robot: str
    wanted: str = NOTHING


def _both(name: str, wanted: str) -> tuple[Claim, ...]:
    """Return a scenario walked by either robot."""
    return tuple(
        Claim(Case(f"{name}_{robot}", name, (f"robot={robot}",)), robot, wanted) for robot in ROBOTS
    )


CLAIMS: Final = (
    *_both("slalom", "19 of 20"),
    *_both("stairs_up", "19 of 20"),
    *_both("stairs_down", "19 of 20"),
    *_both("two_levels", NOTHING),
    *_both("underpass", NOTHING),
)

CASES: Final = (
    *(_walk(one.number, model) for one in SCENARIOS for model in WORLD_MODELS),
    *(_filter(draw) for draw in range(1, FILTERS)),
    Case(VISITOR, "visitor_nao", _model("octree"), watch=VisitorWatch),
    Case(VISITOR_MOVES, "visitor_nao", (*_model("octree"), _COMES_WALKING), watch=VisitorWatch),
    Case(UNKNOWN_ABOVE, _UNKNOWN, _ABOVE, watch=WalkWatch),
    Case(UNKNOWN_BELOW, _UNKNOWN, _BELOW, watch=WalkWatch),
    Case(KIDNAPPED, "kidnapped", watch=WalkWatch),
    *(claim.case for claim in CLAIMS),
)
