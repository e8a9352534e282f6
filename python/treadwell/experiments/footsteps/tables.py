"""The tables of the experiment `footsteps`: what was reached, how soon, and what is asked."""

from collections import Counter
from collections.abc import Callable, Sequence
from typing import Final

from treadwell.experiments.experiment import NOTHING, Results, Table, middle, share
from treadwell.experiments.footsteps.suite import OF_20, TIMES, Suite
from treadwell.experiments.stairs import reasons
from treadwell.experiments.world.claim import Claim, has_no_way, word
from treadwell.runner import Run

_PERCENT: Final = 100.0


def footsteps_tables(suite: Suite) -> Callable[[Results], Sequence[Table]]:
    """Return what makes the tables of a suite's runs; of what was not run there is none."""

    def tables(results: Results) -> Sequence[Table]:
        made = [
            _scenarios(suite, results),
            _families(suite, results),
            _bars(suite, results),
            _times(results),
            reasons(results),
        ]
        return [table for table in made if table.rows]

    return tables


def _scenarios(suite: Suite, results: Results) -> Table:
    rows = [_scenario(claim, runs) for claim, runs in _run(suite.walks, results)]
    return Table(
        "Scenarios",
        ("scenario", "robot", "goal", "wanted", "refused", "otherwise", "falls", "touches", "s",
         "s a stair", "steps a metre"),
        tuple(rows),
        (
            "s: simulated seconds to the goal, median of the runs that reached it. s a stair: from "
            "the time when both feet had made a change of level to the following, median of all "
            "runs; wanted: 1 on steps up to 40 mm high and at least as deep as a sole is long; "
            "`stair_climbing`: 2. Steps a metre: of the way of the robot's frame.",
        ),
    )  # fmt: skip


def _scenario(claim: Claim, runs: Sequence[Run]) -> tuple[str, ...]:
    goals = [run for run in runs if run.outcome == "goal_reached"]
    ends = Counter(run.outcome for run in runs)
    others = len(runs) - ends["goal_reached"] - ends["refused"] - ends["fell"]
    stairs = [seconds for run in runs for seconds in run.findings.intervals()]
    walked = [run.result for run in goals if run.result.path_length > 0.0]
    return (
        claim.what,
        claim.robot,
        share(len(goals), len(runs)),
        f"{OF_20[claim.robot]} of 20, no fall",
        _words(runs),
        str(others),
        str(sum(run.result.falls for run in runs)),
        str(sum(len(run.result.collisions) for run in runs)),
        middle([run.result.simulated_seconds for run in goals]),
        middle(stairs),
        middle([one.steps_taken / one.path_length for one in walked]),
    )


def _words(runs: Sequence[Run]) -> str:
    """Return how often it was refused by which word."""
    counted = Counter(word(run) for run in runs if run.outcome == "refused")
    return ", ".join(f"{one} {count}" for one, count in counted.most_common()) or NOTHING


def _families(suite: Suite, results: Results) -> Table:
    rows = []
    for claim, runs in _run(suite.families, results):
        refused = [run for run in runs if run.outcome == "refused"]
        rightly = sum(has_no_way(claim.case, run) for run in refused)
        goals = [run for run in runs if run.outcome == "goal_reached"]
        right = len(goals) + rightly
        rows.append(
            (
                claim.what,
                claim.robot,
                f"{share(right, len(runs))} ({_PERCENT * right / len(runs):.1f} %)",
                str(len(goals)),
                str(rightly),
                str(len(refused) - rightly),
                str(sum(run.result.falls for run in runs)),
                middle([run.result.simulated_seconds for run in goals]),
            )
        )
    return Table(
        "Flights that draw themselves",
        ("family", "robot", "goal, or no way", "goal", "refused, no way", "refused, a way",
         "falls", "s"),
        tuple(rows),
        (
            "No way: none that a search on the true course finds within the robot's published "
            "limits. Wanted: 97 %, and a fall at most in 200. s: median of the goals.",
        ),
    )  # fmt: skip


def _bars(suite: Suite, results: Results) -> Table:
    rows = [
        (
            claim.robot,
            share(sum(claim.is_right(run) for run in runs), len(runs)),
            str(sum(run.outcome == "goal_reached" for run in runs)),
            _words(runs),
            str(sum(bool(run.result.collisions) for run in runs)),
            str(sum(run.result.falls for run in runs)),
        )
        for claim, runs in _run(suite.bars, results)
    ]
    return Table(
        "A bar across the way, 10 mm deep and 25 mm high",
        ("robot", "right", "goal", "refused", "runs with a touch", "falls"),
        tuple(rows),
        (
            "Right: stepped over or refused, and never touched. Wanted: 20 of 20; "
            "`stair_climbing` walks into it.",
        ),
    )


def _times(results: Results) -> Table:
    rows = []
    for name, time in TIMES.items():
        runs = results.get(f"{name}_qrio", ())
        goals = [run.result.simulated_seconds for run in runs if run.outcome == "goal_reached"]
        if runs:
            rows.append((name, time.before, time.wanted, middle(goals)))
    return Table(
        "Seconds to the goal, qrio",
        ("scenario", "stair_climbing", "wanted", "median"),
        tuple(rows),
        ("Of the runs that reached it. `stair_climbing`: as it was before there was another.",),
    )


def _run(claims: Sequence[Claim], results: Results) -> list[tuple[Claim, Sequence[Run]]]:
    """Return the claims that were run, each with its runs."""
    return [(claim, results[claim.case.name]) for claim in claims if results.get(claim.case.name)]
