"""The floor and obstacle height map of Gutmann, Fukuchi and Fujita (ICRA 2005, section V)."""

from collections.abc import Callable, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Final

from treadwell.experiments import fog_cases as cases
from treadwell.experiments.experiment import (
    NOTHING,
    THE_PAPER,
    Experiment,
    Picture,
    Results,
    Table,
    middle,
    share,
)
from treadwell.experiments.fog_drift import height_drift, turning
from treadwell.experiments.fog_levels import three_levels, worse_senses
from treadwell.experiments.fog_surfaces import ceilings, slopes_walked, surfaces
from treadwell.experiments.level_heights import level_heights
from treadwell.measuring.map_watch import MapFrame, MapHistory
from treadwell.measuring.regions import RegionCounts
from treadwell.runner import Run


def _removed(results: Results) -> Table:
    return _by_model(
        "A box is removed (Fig. 5)",
        (
            "its cells in the map before, %",
            "stale in the end",
            "runs with any",
            "frames until none",
        ),
        results,
        cases.removed,
        _removal,
        {cases.FOG: "none stale", "averaging": "some stale"},
        "Found: cells of the box that are floor at its height. Stale: cells that it has left and "
        "that are an obstacle to the map, or a floor that is no longer there. The paper: none, "
        "averaging keeps some. Wanted: none within 12 frames.",
    )


def _removal(runs: Sequence[MapHistory]) -> tuple[str, ...]:
    before, stale, frames = [], [], []
    for run in runs:
        gone = next((i for i, one in enumerate(run.frames) if not one.covered), len(run.frames))
        last = run.frames[gone - 1]
        before.append(100 * last.found / max(last.covered, 1))
        stale.append(run.frames[-1].stale)
        clear = _frames_until_clear(run.frames[gone:])
        frames += [] if clear is None else [clear]
    with_any = sum(count > 0 for count in stale)
    return (
        middle(before),
        middle(stale, 0),
        share(with_any, len(stale)),
        f"{middle(frames, 0)}, at most {max(frames)}" if frames else "never",
    )


def _frames_until_clear(frames: Sequence[MapFrame]) -> int | None:
    """Return after how many frames nothing is stale any more, None where something stays."""
    stale = [i for i, one in enumerate(frames, 1) if one.stale]
    last = stale[-1] if stale else 0
    return None if last == len(frames) else last


def _moved(results: Results) -> Table:
    return _by_model(
        "A box moves through the view at 5 cm/s",
        ("cells between box and floor, %", "worst run, %", "stale, cells a frame"),
        results,
        cases.moved,
        _motion,
        {cases.FOG: "none between", "averaging": "some between"},
        "Of the cells that the box covers or has covered and that the map has as floor, those with "
        "a height more than 10 mm off both. The paper: averaging has some, its own map none. "
        "Wanted: under 1 %, averaging above 5 %.",
    )


def _motion(runs: Sequence[MapHistory]) -> tuple[str, ...]:
    def between(run: MapHistory) -> float:
        floors = sum(one.floors for one in run.frames)
        return 100 * sum(one.between for one in run.frames) / max(floors, 1)

    shares = [between(run) for run in runs]
    stale = [one.stale for one in chain.from_iterable(run.frames for run in runs) if one.left]
    return (middle(shares, 2), f"{max(shares):.2f}", middle(stale, 0))


def _by_model(
    title: str,
    header: tuple[str, ...],
    results: Results,
    name: Callable[[str], str],
    row: Callable[[Sequence[MapHistory]], tuple[str, ...]],
    paper: Mapping[str, str],
    note: str,
) -> Table:
    """Return a table with a row for each world model that was run, and what the paper has."""
    histories = {
        model: [run.findings for run in results.get(name(model), ())]
        for model in cases.WORLD_MODELS
    }
    rows = tuple((model, *row(some), paper[model]) for model, some in histories.items() if some)
    return Table(title, ("world model", *header, THE_PAPER), rows, (note,))


def _segmenters(results: Results) -> Table:
    rows = []
    for name in cases.SEGMENTERS:
        runs = results.get(cases.seen(name), ())
        if runs:
            counts = sum((run.findings for run in runs), RegionCounts())
            rows.append((name, *_shares(counts)))
    return Table(
        "Level surfaces of a staircase told apart, frame by frame (Fig. 4)",
        ("segmenter", "surfaces", "correct, %", "over, %", "merged, %", "missed, %", "noise"),
        tuple(rows),
        (
            "Surfaces of 100 pixels or more at an overlap of 80 %, after Hoover et al. 1996; "
            "merged: covered by a region that covers another one, too. The same frames for all. "
            "scan_line, the default, finds few here since it joins levels that the noise of a "
            "single frame does not keep apart: of treads of 30 mm, seen from half a metre, most; "
            "by perfect depth it tells nine of ten apart. Climbing does not ask it of one frame: "
            "edges are fitted to the disparities, and treads merged over frames, as the robot "
            "comes near (experiment stairs). The paper shows one frame, without figures.",
        ),
    )


def _shares(counts: RegionCounts) -> tuple[str, ...]:
    parts = (counts.correct, counts.over, counts.merged, counts.missed)
    shares = [f"{100 * part / max(counts.true, 1):.1f}" for part in parts]
    return (str(counts.true), *shares, str(counts.noise))


def _course(results: Results) -> Table:
    runs: Sequence[Run] = results.get(cases.course(cases.FOG), ())
    maps = [run.result.map for run in runs]

    def row(what: str, wanted: str, values: Sequence[float]) -> tuple[str, ...]:
        worst = f"{max(values):.2f}" if values else NOTHING
        return (what, wanted, middle(values, 2), worst)

    return Table(
        "Cells of obstacle_course in the end",
        ("what", "wanted", "median", "highest"),
        (
            row("floor called obstacle, %", "0.5", [100 * m.floor_called_obstacle for m in maps]),
            row("obstacle called floor, %", "0", [100 * m.obstacle_called_floor for m in maps]),
            row(
                "the same of cells that lie in an obstacle whole, %",
                "0",
                [100 * m.whole_obstacle_called_floor for m in maps],
            ),
            row("floor at the wrong height, %", NOTHING, [_wrong_height(run) for run in runs]),
        )
        if runs
        else (),
    )


def _wrong_height(run: Run) -> float:
    """Return the share of floor cells that are floor to the map, but not at their height, %."""
    counted = run.result.map
    return 100 * (1.0 - counted.floor_cells_right - counted.floor_called_obstacle)


def fog_tables(results: Results) -> list[Table]:
    """Return the tables of what came out; of what was not run there is none."""
    made = [
        three_levels(results),
        _removed(results),
        _moved(results),
        level_heights(results.get(cases.course(cases.FOG), ())),
        _course(results),
        _segmenters(results),
        worse_senses(results),
        height_drift(results),
        turning(results),
        surfaces(results),
        slopes_walked(results),
        ceilings(results),
    ]
    return [table for table in made if table.rows]


def _pictures(results: Results, folder: Path) -> Sequence[Picture]:
    # Late, because matplotlib takes half a second to import.
    from treadwell.experiments.fog_pictures import fog_pictures

    return fog_pictures(results, folder)


FOG: Final = Experiment(
    name="fog",
    description="The floor and obstacle height map (Gutmann, Fukuchi, Fujita 2005)",
    cases=cases.CASES,
    tables=fog_tables,
    pictures=_pictures,
)
