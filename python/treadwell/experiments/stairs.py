"""The stairs of Gutmann, Fukuchi and Fujita (IROS 2004, section VI; ICRA 2005, section V)."""

import math
from collections.abc import Sequence
from pathlib import Path
from statistics import fmean, pstdev
from typing import Final

from treadwell.experiments.experiment import (
    NOTHING,
    Experiment,
    Picture,
    Results,
    Table,
    middle,
    share,
)
from treadwell.experiments.level_heights import level_heights
from treadwell.experiments.stairs_cases import (
    BASIN_BEGIN,
    BASINS_MM,
    CLAIMS,
    Claim,
    basin_name,
)
from treadwell.judging.result import Result
from treadwell.measuring.step_watch import EDGE_M, HEADING_RAD, HEIGHT_M, StepError
from treadwell.runner import Run

PHASES: Final[dict[str, tuple[tuple[str, ...], float]]] = {
    "search": (("look_around", "locate", "turn", "search"), 5.0),
    "align": (("walk", "sidle", "align"), 5.0),
    "approach": (("approach",), 5.0),
    "climb": (("climb", "step_back"), 24.0),
    "finish": (("finish", "arrive"), 5.0),
    "other": (("stop", "blind", "locate", "refuse"), 0.0),
}
"""Phase of the paper -> our states that count for it until the last step, and the paper's s."""
_TIMED: Final = ("stairs_up", "stairs_up_continuous", "stairs_down", "stairs_askew")
_STEPS: Final = 4
"""Steps of each of the timed staircases."""

_SAME_LEVEL: Final = 0.015
_SAME_PLACE: Final = 0.06


def _outcomes(results: Results) -> Table:
    rows = [
        _outcome(claim, results[claim.case.name]) for claim in CLAIMS if claim.case.name in results
    ]
    return Table(
        "What was climbed and what was refused",
        ("case", "the paper", "wanted", "as expected", "falls", "collisions", "steps right", "s"),
        tuple(rows),
        (
            "As expected: the goal reached, or refused where the scenario has no way that may be "
            "taken. Steps right: as many up and down as there are, by the simulator, none of them "
            "told to the robot. s: median of the runs that went as expected.",
        ),
    )


def _outcome(claim: Claim, runs: Sequence[Run]) -> tuple[str, ...]:
    results = [run.result for run in runs]
    right = NOTHING
    if claim.changes is not None:
        made = [(result.stairs_climbed, result.stairs_descended) for result in results]
        right = share(sum(one == claim.changes for one in made), len(made))
        right = f"{right} ({claim.changes[0]} up, {claim.changes[1]} down)"
    return (
        claim.case.name,
        claim.paper,
        claim.wanted,
        share(sum(result.passed for result in results), len(results)),
        str(sum(result.falls for result in results)),
        str(sum(len(result.collisions) for result in results)),
        right,
        middle([result.simulated_seconds for result in results if result.passed]),
    )


def _steps(results: Results) -> Table:
    """Return what was known of each step before it was climbed."""
    rows = []
    together = [one for some in results.values() for one in some]
    for name, runs in [*results.items(), ("all", together)]:
        steps = [step for run in runs for step in run.steps]
        if steps:
            rows.append(steps_row(name, steps))
    return Table(
        "Each step as it was known before a foot left for it",
        ("case", "known", "height, mm", "edge, mm", "heading, °", "≤ 3 mm", "≤ 10 mm, 3°"),
        tuple(rows),
        (
            "Known minus true, mean and standard deviation, and how many heights and edges (with "
            "their headings) are as near as asked for. Wanted: 95 of 100.",
        ),
    )


def steps_row(name: str, steps: Sequence[StepError]) -> tuple[str, ...]:
    """Return a row on the steps of a case: known, errors, and how many are within what is asked."""
    known = [step for step in steps if step.is_known()]
    edge = sum(abs(step.edge) <= EDGE_M and abs(step.heading) <= HEADING_RAD for step in known)
    return (
        name,
        share(len(known), len(steps)),
        _spread([1e3 * step.height for step in known]),
        _spread([1e3 * step.edge for step in known]),
        _spread([math.degrees(step.heading) for step in known]),
        share(sum(abs(step.height) <= HEIGHT_M for step in known), len(steps)),
        share(edge, len(steps)),
    )


def _spread(values: Sequence[float]) -> str:
    return f"{fmean(values):+.1f} ± {pstdev(values):.1f}" if values else NOTHING


def phase_seconds(result: Result) -> dict[str, float]:
    """Return the simulated seconds that each phase of the paper took.

    What comes after the last step is the finish, whatever it is called.
    """
    of = {state: phase for phase, (states, _) in PHASES.items() for state in states}
    entries = result.behaviour
    ends = [entry.time for entry in entries[1:]] + [result.simulated_seconds]
    last = max((i for i, entry in enumerate(entries) if entry.state == "climb"), default=None)
    seconds = dict.fromkeys(PHASES, 0.0)
    for i, (entry, end) in enumerate(zip(entries, ends, strict=True)):
        after = last is not None and i > last
        phase = "finish" if after else of.get(entry.state, "other")
        seconds[phase] += end - entry.time
    return seconds


def _times(results: Results) -> Table:
    timed = [name for name in _TIMED if name in results]
    spent = {
        name: [phase_seconds(run.result) for run in results[name] if run.passed] for name in timed
    }

    def row(name: str, paper: float, times: Sequence[Sequence[float]]) -> tuple[str, ...]:
        return (name, f"{paper:g}" if paper else NOTHING, *(middle(values) for values in times))

    rows = []
    for phase, (_, paper) in PHASES.items():
        rows.append(row(phase, paper, [[one[phase] for one in spent[s]] for s in timed]))
        if phase == "climb":
            each = [[one[phase] / _STEPS for one in spent[s]] for s in timed]
            rows.append(row("climb, a step", paper / _STEPS, each))
    rows.append(row("in all", 44.0, [[sum(one.values()) for one in spent[s]] for s in timed]))
    states = "; ".join(f"{phase}: {', '.join(states)}" for phase, (states, _) in PHASES.items())
    return Table(
        "Seconds of each phase",
        ("phase", "the paper", *timed),
        tuple(rows) if timed else (),
        (
            "Medians of the runs that went as expected, simulated time. The paper's figures are "
            "of the way up.",
            f"States that count for a phase until the last step is taken: {states}. All that "
            "comes later is the finish, one second of standing at the goal with it.",
        ),
    )


def reasons(results: Results) -> Table:
    """Return the table of what was refused, and of what went otherwise than expected."""
    rows = []
    for name, runs in results.items():
        told = [run.result for run in runs if run.outcome == "refused" or not run.passed]
        for kind in sorted({_kind(one) for one in told}):
            alike = [one for one in told if _kind(one) == kind]
            seeds = ", ".join(str(one.seed) for one in alike if not one.passed)
            example = alike[0].reason or alike[0].outcome
            rows.append((name, str(len(alike)), example, seeds or NOTHING))
    return Table(
        "What was refused, and what did not go as expected",
        ("case", "runs", "reason of the first", "seeds that were to go otherwise"),
        tuple(rows),
    )


def _kind(result: Result) -> tuple[str, str]:
    """Return how a run ended, and the word of its reason."""
    return result.outcome, (result.reason or "").partition(":")[0]


def _widths(results: Results) -> Table:
    rows = []
    for width_mm in BASINS_MM:
        name = basin_name(width_mm)
        if name not in results:
            continue
        measured = [_measured_width(run, 1e-3 * width_mm) for run in results[name]]
        errors = [1e3 * width - width_mm for width in measured if width is not None]
        rows.append((name, str(len(errors)), _spread(errors)))
    return Table(
        "The measured width of the basins minus the true one, mm",
        ("case", "runs that measured it", "error"),
        tuple(rows),
    )


def _measured_width(run: Run, width: float) -> float | None:
    """Return how wide the robot believed the basin to be, m; None: it knew none there."""
    middle_x = BASIN_BEGIN + 0.5 * width
    near = [(abs(top.x - middle_x), top.depth) for top in run.tops if abs(top.z) < _SAME_LEVEL]
    return min((one for one in near if one[0] < _SAME_PLACE), default=(0.0, None))[1]


def _frame_times(results: Results) -> Table:
    stages = ("segment", "stairs", "behave")
    runs = [run.result for some in results.values() for run in some]
    medians = {
        stage: [run.timing_ms[stage].median for run in runs if stage in run.timing_ms]
        for stage in stages
    }
    return Table(
        "Segmentation, recognition and behaviour, ms a frame",
        ("the paper", "wanted", *stages),
        (("< 30 (400 MHz MIPS)", "1 in all", *(middle(medians[s], 2) for s in stages)),)
        if runs
        else (),
        ("Medians over the runs of each run's median; one core each.",),
    )


def stairs_tables(results: Results) -> list[Table]:
    """Return the tables of what came out; of what was not run there is none."""
    made = [
        _outcomes(results),
        _times(results),
        _steps(results),
        _widths(results),
        reasons(results),
        level_heights(results.get("obstacle_course", ())),
        _frame_times(results),
    ]
    return [table for table in made if table.rows]


def _pictures(results: Results, folder: Path) -> Sequence[Picture]:
    # Late, because matplotlib takes half a second to import.
    from treadwell.experiments.stairs_pictures import stairs_pictures

    return stairs_pictures(results, folder)


STAIRS: Final = Experiment(
    name="stairs",
    description="Stairs seen, understood and climbed (Gutmann, Fukuchi, Fujita 2004 and 2005)",
    cases=tuple(claim.case for claim in CLAIMS),
    tables=stairs_tables,
    pictures=_pictures,
)
