"""A NAO in a house on two levels, with a depth camera and a map (Maier et al., Humanoids 2012)."""

from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Final

from treadwell.experiments import nao_cases as cases
from treadwell.experiments.experiment import (
    NOTHING,
    Experiment,
    Picture,
    Results,
    Table,
    middle,
    share,
)
from treadwell.experiments.nao_localization import accuracy, finding, hallway
from treadwell.experiments.nao_maps import local_map, visitors
from treadwell.experiments.stairs import reasons

_STAGES: Final = ("segment", "localize", "map", "stairs", "plan")


def _claims(results: Results) -> Table:
    rows = []
    for claim in cases.CLAIMS:
        if runs := [run.result for run in results.get(claim.case.name, ())]:
            rows.append(
                (
                    claim.case.name,
                    claim.wanted,
                    share(sum(one.passed for one in runs), len(runs)),
                    share(sum(one.outcome == "goal_reached" for one in runs), len(runs)),
                    str(sum(one.falls for one in runs)),
                    str(sum(len(one.collisions) for one in runs)),
                    middle([one.simulated_seconds for one in runs if one.passed]),
                )
            )
    return Table(
        "Both robots on the same courses",
        ("case", "wanted", "as expected", "goal", "falls", "collisions", "s"),
        tuple(rows),
        ("As expected: the goal, and all else that the scenario asks. s: median of those.",),
    )


def _frame_times(results: Results) -> Table:
    """Return the table of the paper's cycle; with the map of the paper alone."""
    runs = [
        run.result.timing_ms
        for one in cases.SCENARIOS
        for run in results.get(cases.walked(one.number, "octree"), ())
    ]
    # Of localize all control ticks are counted, one in sixteen of which has a frame: the slow ones.
    # Their median is about the 97th percentile of all; the 99th errs on the safe side.
    times = {
        stage: [
            one[stage].p99 if stage == "localize" else one[stage].median
            for one in runs
            if stage in one and one[stage].count
        ]
        for stage in _STAGES
    }
    known = all(times.values())
    whole = f"{sum(map(median, times.values())):.1f}" if known else NOTHING
    ours = (*(middle(times[stage], 2) for stage in _STAGES), whole)
    return Table(
        "Planes, localization, map, stairs and plan, ms a frame",
        ("the paper", "wanted", *_STAGES, "in all"),
        (("167 in all, 4 cores", "15 in all", *ours),) if runs else (),
        (
            "Medians over the runs of scenarios 1 to 3 of each run's median, of localize of its "
            "99th percentile over all control ticks, one in sixteen of which has a frame; one core "
            "each.",
        ),
    )


def nao_tables(results: Results) -> list[Table]:
    """Return the tables of what came out; of what was not run there is none."""
    made = [
        accuracy(results),
        hallway(results),
        local_map(results),
        visitors(results),
        finding(results),
        _claims(results),
        reasons(results),
        _frame_times(results),
    ]
    return [table for table in made if table.rows]


def _pictures(results: Results, folder: Path) -> Sequence[Picture]:
    # Late, because matplotlib takes half a second to import.
    from treadwell.experiments.nao_pictures import nao_pictures

    return nao_pictures(results, folder)


NAO: Final = Experiment(
    name="nao",
    description="Navigation on two levels with a depth camera (Maier, Hornung, Bennewitz 2012)",
    cases=cases.CASES,
    tables=nao_tables,
    pictures=_pictures,
)
