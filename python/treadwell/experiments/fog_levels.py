"""Three levels, with the robot's senses and with worse ones: tables of the experiment `fog`."""

from collections.abc import Sequence
from typing import Final

from treadwell.experiments import fog_cases as cases
from treadwell.experiments.experiment import NOTHING, THE_PAPER, Results, Table, middle
from treadwell.judging.result import MapCounts
from treadwell.runner import Run

_COLUMNS: Final = (
    "case",
    "floor right, %",
    "obstacle right, %",
    "interior right, %",
    "median height error, mm",
    "worst, mm",
)


def three_levels(results: Results) -> Table:
    """Return the table of each world model's map of the same scene (Fig. 3)."""
    names = (cases.LEVELS_IDEAL, *(cases.levels(model) for model in cases.WORLD_MODELS))
    paper = {cases.LEVELS_IDEAL: "a picture, no number"}
    return Table(
        "Three levels and two obstacles with rough tops (Fig. 3)",
        (*_COLUMNS, THE_PAPER),
        tuple(
            (*_row(name, results[name]), paper.get(name, NOTHING))
            for name in names
            if results.get(name)
        ),
        (
            "Floor cells lie on one level whole, obstacle cells have their centres in an "
            "obstacle; interior: floor cells, and cells that lie in an obstacle whole. "
            "The paper gives no number here: by a picture of what a perfect sensor sees it shows "
            "floors at their precise heights and obstacles at coarse ones. Wanted with stereo "
            "noise: 99 % of the interior, 3 mm.",
        ),
    )


def worse_senses(results: Results) -> Table:
    """Return the table of three levels seen with a camera that is wrong, and with outliers."""
    names = (cases.levels(cases.FOG), *(case.name for case in cases.WORSE))
    rows = tuple(_row(name, results[name]) for name in names if results.get(name))
    return Table(
        "Three levels with worse senses (sections III and IV)",
        _COLUMNS,
        rows if any(results.get(case.name) for case in cases.WORSE) else (),
        (
            "The camera's pose is drawn within 7 degrees and 10 mm of the one by the joints, or "
            "within what the case says; 0.7 % of the pixels are mismatched, or what it says. "
            "uncorrected: where the ground is seen does not correct the camera's pose. "
            "unmatched: nor are frames fitted in height to the floor that is known. "
            "The paper: needed, without figures. Wanted: 1.4 mm and 4 mm with a wrong camera, "
            "and labels of 98 % with 2 % of outliers.",
        ),
    )


def _interior_right(counts: MapCounts) -> float:
    """Return the share of the cells that lie in one thing whole which are what the map says."""
    whole, floor = counts.whole_obstacle_cells, counts.floor_cells
    right = floor * counts.floor_cells_right + whole * (1.0 - counts.whole_obstacle_called_floor)
    return right / max(1, whole + floor)


def _row(name: str, runs: Sequence[Run]) -> tuple[str, ...]:
    maps = [run.result.map for run in runs]
    errors = [
        1e3 * abs(surface.estimate - surface.truth)
        for run in runs
        for surface in run.result.surfaces
        if surface.estimate is not None
    ]
    return (
        name,
        middle([100 * one.floor_cells_right for one in maps], 2),
        middle([100 * one.obstacle_cells_right for one in maps], 2),
        middle([100 * _interior_right(one) for one in maps], 2),
        middle(errors, 2),
        f"{max(errors):.2f}" if errors else NOTHING,
    )
