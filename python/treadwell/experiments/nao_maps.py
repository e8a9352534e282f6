"""What the robot mapped and went around: tables of the experiment `nao`."""

from collections.abc import Sequence

from treadwell.experiments import nao_cases as cases
from treadwell.experiments.experiment import NOTHING, Results, Table, middle, share
from treadwell.measuring.visitor_watch import Avoidance
from treadwell.measuring.walk_watch import Unmapped
from treadwell.runner import Run


def local_map(results: Results) -> Table:
    """Return the table of what the static map lacks, and of free floor (section IV.B)."""
    rows = tuple(
        (f"{one.number}, {model}", *_mapped(runs))
        for one in cases.SCENARIOS
        for model in cases.WORLD_MODELS
        if (runs := results.get(cases.walked(one.number, model), ()))
    )
    return Table(
        "The local map (section IV.B)",
        (
            "scenario, map",
            "unmapped things found",
            "missed",
            "floor called obstacle, %",
            "worst",
            "clear floor, %",
            "worst",
            "of all runs together",
        ),
        rows,
        (
            "Found: in the end, at least one cell over it is an obstacle, or a floor above half "
            "its height; things of 80 mm and more, over all runs. Floor: cells that lie on one "
            "level whole, median of the runs; clear: of those that lie 70 mm or more from "
            "everything that is not walked on; together: of all such cells of all runs. The paper: "
            "all obstacles included. Wanted: all, 0.1 %.",
        ),
    )


def _mapped(runs: Sequence[Run]) -> tuple[str, ...]:
    unmapped: list[Unmapped] = [one for run in runs for one in run.findings.unmapped]
    missed = sorted({one.name for one in unmapped if not one.found})
    wrong = [100 * run.result.map.floor_called_obstacle for run in runs]
    found = [run.findings for run in runs]
    clear = [100 * one.clear_wrong / max(one.clear, 1) for one in found]
    together = 100 * sum(one.clear_wrong for one in found) / max(sum(one.clear for one in found), 1)
    return (
        share(sum(one.found > 0 for one in unmapped), len(unmapped)),
        ", ".join(missed) or NOTHING,
        middle(wrong, 2),
        f"{max(wrong):.2f}",
        middle(clear, 2),
        f"{max(clear):.2f}",
        f"{together:.2f}",
    )


def visitors(results: Results) -> Table:
    """Return the table of somebody who steps in the way (Fig. 6)."""
    wanted = {cases.VISITOR: "20 of 20, 0.2 s", cases.VISITOR_MOVES: "19 of 20"}
    rows = tuple(
        (name, wanted[name], *_avoided(runs))
        for name in cases.VISITORS
        if (runs := results.get(name, ()))
    )
    return Table(
        "Somebody steps in the way (Fig. 6)",
        (
            "case",
            "wanted",
            "without contact",
            "goal",
            "was in the way",
            "seen",
            "new way after, s",
            "latest",
            "way clear of it after, s",
            "latest",
            "new ways",
        ),
        rows,
        (
            "In the way: the path led through the visitor, by half the feet's width, at any time. "
            "New way: from the first picture with 20 points or more on it, if it was in the way by "
            "then, until the first way that is planned anew. Clear of it: until the path is clear "
            "of the whole visitor, of which the robot sees only a part. New ways: median of all in "
            "a run. The paper: immediately, collision-free, goal reached.",
        ),
    )


def _avoided(runs: Sequence[Run]) -> tuple[str, ...]:
    found: list[Avoidance] = [run.findings for run in runs]
    delays = [delay for one in found if (delay := one.delay()) is not None]
    around = [delay for one in found if (delay := one.delay_around()) is not None]
    return (
        share(sum(not run.result.collisions for run in runs), len(runs)),
        share(sum(run.outcome == "goal_reached" for run in runs), len(runs)),
        share(sum(one.blocked is not None for one in found), len(found)),
        share(sum(one.seen is not None for one in found), len(found)),
        middle(delays, 2),
        f"{max(delays):.2f}" if delays else NOTHING,
        middle(around, 2),
        f"{max(around):.2f}" if around else NOTHING,
        middle([run.result.replans for run in runs], 0),
    )
