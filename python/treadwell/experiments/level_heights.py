"""Heights of the levels of `obstacle_course` in the map: Table I of Gutmann 2005."""

from collections.abc import Sequence
from statistics import fmean, median
from typing import Final

from treadwell.experiments.experiment import NOTHING, THE_PAPER, Table, middle
from treadwell.runner import Run

LEVELS: Final = (
    ("sill", 0.038, 37.0),
    ("1st step", 0.031, 31.0),
    ("2nd step", 0.061, 61.0),
    ("3rd step", 0.092, 94.0),
    ("platform", 0.122, 126.0),
)
"""Level, its true height m, the paper's estimate mm."""
_SAME_HEIGHT: Final = 0.0015


def level_heights(runs: Sequence[Run]) -> Table:
    """Return the table; without rows where no run knew of a level."""
    errors = {name: _errors(runs, truth) for name, truth, _ in LEVELS}
    typical = [median(abs(error) for error in some) for some in errors.values() if some]
    rows = [
        (
            name,
            f"{1e3 * truth:.0f}",
            f"{paper:.0f}",
            middle([1e3 * truth + error for error in errors[name]]),
            middle([abs(error) for error in errors[name]]),
            _range(errors[name]),
            str(len(errors[name])),
        )
        for name, truth, paper in LEVELS
    ]
    off = [abs(paper - 1e3 * truth) for _, truth, paper in LEVELS]
    for name, papers, ours in (
        ("mean of the five", fmean(off), f"{fmean(typical):.1f}" if typical else NOTHING),
        ("worst of the five", max(off), f"{max(typical):.1f}" if typical else NOTHING),
    ):
        rows.append((name, NOTHING, f"{papers:.1f}", NOTHING, ours, NOTHING, NOTHING))
    return Table(
        "Heights of the levels in the map of obstacle_course, mm",
        ("level", "true", THE_PAPER, "median", "median absolute error", "errors", "runs"),
        tuple(rows) if typical else (),
        (
            "The paper: ICRA 2005, Table I; its mean and its worst absolute error in the last two "
            "rows. Ours: what the map had in the end. Wanted: 1.0 mm and 2.5 mm.",
        ),
    )


def _errors(runs: Sequence[Run], truth: float) -> list[float]:
    """Return estimate minus truth of the level of this height, mm, of the runs that knew it."""
    return [
        1e3 * (surface.estimate - surface.truth)
        for run in runs
        for surface in run.result.surfaces
        if surface.estimate is not None and abs(surface.truth - truth) < _SAME_HEIGHT
    ]


def _range(errors: Sequence[float]) -> str:
    return f"{min(errors):+.1f} to {max(errors):+.1f}" if errors else NOTHING
