"""What the models did on the suite: tables of the experiment `models`."""

import math
from collections import Counter
from collections.abc import Callable, Sequence
from statistics import median
from typing import Final

from treadwell.experiments.experiment import NOTHING, Results, Table, middle, share
from treadwell.experiments.models.suite import GONE, SCENES, WORLD_MODELS, Scene, case_name
from treadwell.measuring.ground_watch import GroundErrors
from treadwell.measuring.map_watch import MapFrame
from treadwell.runner import Run

Runs = dict[str, list[Run]]
"""World model -> its runs, of those that were run."""

_PERCENT: Final = 100.0
_MM: Final = 1e3


def models_tables(results: Results) -> list[Table]:
    """Return the tables of what came out; of what was not run there is none."""
    made = [
        which_for_what(results),
        _success(results),
        _others(results),
        _truth(results),
        _planes(results),
        _edges(results),
        _gone(results),
        _times(results),
    ]
    return [table for table in made if table.rows]


def which_for_what(results: Results) -> Table:
    """Return the table for a lecturer: what is asked, who always did it, and the quickest."""
    rows = []
    for scene in SCENES:
        runs = {model: _of(results, scene, model) for model in WORLD_MODELS}
        run = {model: some for model, some in runs.items() if some}
        if not run:
            continue
        able = [model for model, some in run.items() if all(_is_right(one) for one in some)]
        able.sort(key=lambda model: _milliseconds(run[model]))
        failed = [model for model in run if model not in able]
        rows.append((scene.asks, ", ".join(able) or NOTHING, ", ".join(failed) or NOTHING))
    return Table(
        "Which model for what",
        ("what there is", "models that did it in every run, quickest map first", "that did not"),
        tuple(rows),
        (
            "Right is a run that met its scenario's expectations; of a box that is taken away, one "
            "in the end of which not a cell was stale as well.",
        ),
    )


def _success(results: Results) -> Table:
    rows = []
    for scene in SCENES:
        cells = [
            share(sum(run.passed for run in runs), len(runs))
            for runs in (_of(results, scene, model) for model in WORLD_MODELS)
        ]
        if set(cells) != {NOTHING}:
            rows.append((f"{scene.name}: {scene.asks}", *cells))
    return Table("Runs as expected", ("scene", *WORLD_MODELS), tuple(rows))


def _others(results: Results) -> Table:
    rows = []
    for scene in SCENES:
        for model in WORLD_MODELS:
            ends = [run for run in _of(results, scene, model) if not run.passed]
            told = Counter(_end(run) for run in ends)
            for end, count in told.items():
                seeds = ", ".join(str(run.result.seed) for run in ends if _end(run) == end)
                rows.append((scene.name, model, end, str(count), seeds))
    return Table(
        "Runs that ended otherwise",
        ("scene", "world model", "end", "runs", "seeds"),
        tuple(rows),
    )


def _end(run: Run) -> str:
    """Return how a run ended, with the word of a refusal, or what else it fell short of."""
    if run.outcome == "goal_reached":
        return "; ".join(run.result.failures)
    word = (run.result.reason or "").partition(":")[0]
    return f"refused: {word}" if run.outcome == "refused" else run.outcome


def _truth(results: Results) -> Table:
    rows = []
    for model, runs in _by_model(results).items():
        errors = _errors(runs)
        counts = [run.result.map for run in runs]
        edges = sum(one.edges for one in errors)
        cells = sum(one.planes for one in errors)
        squares = sum(one.planes * one.plane_rms**2 for one in errors)
        rows.append(
            (
                model,
                str(cells),
                middle([_MM * one.plane_median for one in errors]),
                f"{_MM * math.sqrt(squares / cells):.1f}" if cells else NOTHING,
                str(edges),
                _share([one.within for one in errors], edges),
                _share([one.between for one in errors], edges),
                middle([_PERCENT * one.floor_called_obstacle for one in counts], 2),
                middle([_PERCENT * one.obstacle_called_floor for one in counts], 2),
            )
        )
    return Table(
        "The map in the end against the truth, all scenes together",
        (
            "world model",
            "cells on planes",
            "off, median, mm",
            "RMS, mm",
            "cells at edges",
            "a neighbour's height, %",
            "between levels, %",
            "floor called obstacle, %",
            "obstacle called floor, %",
        ),
        tuple(rows),
        (
            "Floor that was seen three times or more. Edges: two cells on either side of a step "
            "of 15 mm or more; right is the height of a true neighbour, within 10 mm: the edge "
            "lies within a cell of where it is. The robot's own drift counts. Wanted: no cell "
            "between levels.",
        ),
    )


def _planes(results: Results) -> Table:
    def cell(runs: Sequence[Run]) -> str:
        return middle([_MM * one.plane_median for one in _errors(runs)])

    return _by_scene(
        results, "Error on planes, median, mm", cell, "Of floor cells that lie on one surface."
    )


def _edges(results: Results) -> Table:
    def cell(runs: Sequence[Run]) -> str:
        errors = _errors(runs)
        return _share([one.within for one in errors], sum(one.edges for one in errors))

    note = "As above, of each scene; a scene without steps has no such cell."
    return _by_scene(results, "Cells at edges with a neighbour's height, %", cell, note)


def _times(results: Results) -> Table:
    def cell(runs: Sequence[Run]) -> str:
        return f"{_milliseconds(runs):.2f}"

    return _by_scene(
        results,
        "The map's time a frame, median, ms",
        cell,
        "By the clock, as many runs side by side as there were processes. The robots' cameras have "
        "88x72 pixels. What a model takes of memory is in the table of recorded data alone: "
        "the core does not tell it.",
    )


def _by_scene(
    results: Results, title: str, cell: Callable[[Sequence[Run]], str], note: str
) -> Table:
    rows = []
    for scene in SCENES:
        runs = [_of(results, scene, model) for model in WORLD_MODELS]
        if any(runs):
            rows.append((scene.name, *(cell(some) if some else NOTHING for some in runs)))
    return Table(title, ("scene", *WORLD_MODELS), tuple(rows), (note,))


def _gone(results: Results) -> Table:
    rows = []
    for name in GONE:
        for model in WORLD_MODELS:
            runs = results.get(case_name(name, model), ())
            histories = [run.findings.frames for run in runs if run.findings.frames]
            if histories:
                stale = [frames[-1].stale for frames in histories]
                counts = [frames_until_clear(frames) for frames in histories]
                after = [count for count in counts if count is not None]
                told = f"{middle(after, 0)}, at most {max(after)}" if after else NOTHING
                with_any = share(sum(count > 0 for count in stale), len(stale))
                rows.append((name, model, middle(stale, 0), with_any, told))
    return Table(
        "What is gone",
        ("scene", "world model", "stale cells in the end", "runs with any", "frames until none"),
        tuple(rows),
        (
            "Stale: cells that something has left and that are an obstacle to the map, or a floor "
            "that is no longer there. A visitor who left behind the robot's back stays.",
        ),
    )


def frames_until_clear(frames: Sequence[MapFrame]) -> int | None:
    """Return for how many frames in all cells were stale; None where some stay to the end."""
    return None if frames[-1].stale else sum(one.stale > 0 for one in frames)


def _is_right(run: Run) -> bool:
    frames = run.findings.frames
    taken = run.result.scenario == GONE[0] and bool(frames) and frames[-1].stale > 0
    return run.passed and not taken


def _milliseconds(runs: Sequence[Run]) -> float:
    stages = [run.result.timing_ms.get("map") for run in runs]
    return median([one.median for one in stages if one is not None] or [0.0])


def _errors(runs: Sequence[Run]) -> list[GroundErrors]:
    found: list[GroundErrors] = [run.findings.errors for run in runs]
    return [one for one in found if one.planes]


def _share(parts: Sequence[int], whole: int) -> str:
    return f"{_PERCENT * sum(parts) / whole:.1f}" if whole else NOTHING


def _of(results: Results, scene: Scene, model: str) -> Sequence[Run]:
    return results.get(case_name(scene.name, model), ())


def _by_model(results: Results) -> Runs:
    every = {
        model: [run for scene in SCENES for run in _of(results, scene, model)]
        for model in WORLD_MODELS
    }
    return {model: runs for model, runs in every.items() if runs}
