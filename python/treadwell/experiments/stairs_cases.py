"""What the experiment `stairs` runs: its cases, what the paper tells of each and what is asked."""

from dataclasses import dataclass
from typing import Final

from treadwell.experiments.experiment import NOTHING, Case
from treadwell.experiments.random_stairs import low, ordinary, single


@dataclass(frozen=True, slots=True)
class Claim:
    """A row of the table.

    Attributes:
        case: what is run.
        paper: what Gutmann, Fukuchi and Fujita tell of it.
        wanted: share of the runs that have to go as the scenario expects, or what else is asked.
        changes: steps up and down on the way to the goal; None where each course has its own.
    """

    case: Case
    paper: str = NOTHING
    wanted: str = NOTHING
    changes: tuple[int, int] | None = None


BASINS_MM: Final = (80, 100, 120, 130, 150)
BASIN_BEGIN: Final = 0.6
"""Metres: x at which the basin of scenario `basin` begins."""
_HALF_PLATFORM: Final = 0.6
"""Metres: from there on the far platform's middle is this much further than the basin is wide."""


def basin_name(width_mm: int) -> str:
    """Return the name of the case."""
    return f"basin_{width_mm}_mm"


def _basin(width_mm: int, *, refused: bool = False) -> Case:
    """Return scenario `basin` with another width."""
    middle = BASIN_BEGIN + 1e-3 * width_mm + _HALF_PLATFORM
    overrides = [f"course.far.position.0={middle:.3f}"]
    if refused:
        overrides.append("expect.outcome=refused")
    return Case(basin_name(width_mm), "basin", tuple(overrides))


def _continuous() -> Case:
    setting = "navigation.behaviour=continuous"
    return Case("stairs_up_continuous", "stairs_up", (setting,))


def _too_high(millimetres: int) -> Case:
    rise = f"course.stairs.rise={1e-3 * millimetres}"
    return Case(f"step_{millimetres}_mm", "stairs_too_high", (rise,))


def _scenario(name: str) -> Case:
    return Case(name, name)


_ALL: Final = "20 of 20"

CLAIMS: Final = (
    Claim(_scenario("stairs_up"), "climbs 4 steps of 30 mm in 44 s", f"{_ALL}, 44 s", (4, 0)),
    Claim(_continuous(), NOTHING, "30 s", (4, 0)),
    Claim(_scenario("stairs_down"), "descends them", _ALL, (0, 4)),
    Claim(_scenario("sill"), "steps up and down over 9 cm", _ALL, (1, 1)),
    Claim(_basin(80, refused=True), "refuses below a threshold", _ALL, (0, 0)),
    Claim(_basin(100, refused=True), "refuses below a threshold", _ALL, (0, 0)),
    Claim(_basin(120, refused=True), NOTHING, "17 of 20", (0, 0)),
    Claim(_basin(130), "proceeds through 13 cm", "17 of 20", (1, 1)),
    Claim(_basin(150), NOTHING, _ALL, (1, 1)),
    Claim(_too_high(55), "limit of 50 mm (Table I)", _ALL, (0, 0)),
    Claim(_too_high(65), "limit of 50 mm (Table I)", _ALL, (0, 0)),
    Claim(Case("stairs_random", ordinary, share=5.0), NOTHING, "95 of 100, no fall"),
    Claim(Case("stairs_random_low", low, share=2.0), NOTHING, "no fall"),
    Claim(Case("step_10_to_55_mm", single, share=2.0), "steps of 10 to 50 mm (Table I)", NOTHING),
    Claim(_scenario("stairs_over"), NOTHING, NOTHING, (4, 4)),
    Claim(_scenario("stairs_spiral"), "can be modelled", NOTHING, (5, 0)),
    Claim(_scenario("stairs_askew"), NOTHING, NOTHING, (4, 0)),
    Claim(_scenario("obstacle_course"), "walks up to the stairs", "19 of 20, no fall", (5, 1)),
    Claim(_scenario("stairs_in_air"), NOTHING, "no fall"),
    Claim(_scenario("stairs_uneven"), NOTHING, "no fall", (4, 0)),
    Claim(_scenario("stair_removed"), NOTHING, "no fall"),
    Claim(_scenario("stair_lifted"), NOTHING, "no fall", (4, 0)),
    Claim(_scenario("stair_blind"), NOTHING, "no fall", (4, 0)),
    Claim(_scenario("stair_blind_long"), NOTHING, "no fall"),
    Claim(_scenario("stairs_blank"), "does not see them", "no fall", (0, 0)),
)
