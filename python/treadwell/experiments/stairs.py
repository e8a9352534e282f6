"""The stairs of Gutmann, Fukuchi and Fujita (IROS 2004, section VI; ICRA 2005, section V)."""

from collections.abc import Sequence
from typing import Final

from treadwell.experiments.experiment import (
    NOTHING,
    Experiment,
    Results,
    Table,
    middle,
    share,
)
from treadwell.judging.result import Result

CHANGES: Final[dict[str, tuple[int, int]]] = {
    "stairs_up": (4, 0),
    "stairs_down": (0, 4),
    "sill": (1, 1),
    "basin": (1, 1),
    "basin_narrow": (0, 0),
    "stairs_too_high": (0, 0),
    "stairs_over": (4, 4),
    "stairs_spiral": (5, 0),
    "stairs_askew": (4, 0),
    "obstacle_course": (5, 1),
}
"""Scenario -> steps up and down on the way to its goal; none where it has to be refused."""

_PAPER: Final[dict[str, str]] = {
    "stairs_up": "climbs 4 steps of 30 mm in 44 s",
    "stairs_down": "descends them",
    "sill": "steps up and down over 9 cm",
    "basin": "proceeds through 13 cm",
    "basin_narrow": "refuses below a threshold",
    "stairs_too_high": "limit of 50 mm (Table I)",
    "stairs_spiral": "can be modelled",
    "obstacle_course": "walks up to the stairs",
}

PHASES: Final[dict[str, tuple[tuple[str, ...], float]]] = {
    "search": (("look_around", "turn", "search"), 5.0),
    "align": (("walk", "align"), 5.0),
    "approach": (("approach",), 5.0),
    "climb": (("climb", "step_back"), 24.0),
    "finish": (("finish", "arrive"), 5.0),
    "other": (("stop", "blind", "refuse"), 0.0),
}
"""Phase of the paper -> our states that count for it until the last step, and the paper's s."""
_TIMED: Final = ("stairs_up", "stairs_down", "stairs_askew")
_STEPS: Final = 4
"""Steps of each of the timed staircases."""

_LEVELS: Final = (
    ("sill", 0.038, 37.0),
    ("1st step", 0.031, 31.0),
    ("2nd step", 0.061, 61.0),
    ("3rd step", 0.092, 94.0),
    ("platform", 0.122, 126.0),
)
"""Table I of ICRA 2005: level, its true height m, the paper's estimate mm."""
_SAME_HEIGHT: Final = 0.0015


def _outcomes(results: Results) -> Table:
    rows = []
    for scenario in CHANGES:
        runs = results.get(scenario, ())
        up, down = CHANGES[scenario]
        right = sum((run.stairs_climbed, run.stairs_descended) == (up, down) for run in runs)
        went = [run.simulated_seconds for run in runs if run.passed]
        rows.append(
            (
                scenario,
                _PAPER.get(scenario, NOTHING),
                share(sum(run.passed for run in runs), len(runs)),
                str(sum(run.falls for run in runs)),
                str(sum(len(run.collisions) for run in runs)),
                f"{up} up, {down} down",
                share(right, len(runs)),
                middle(went),
            )
        )
    return Table(
        "What was climbed and what was refused",
        ("scenario", "the paper", "as expected", "falls", "collisions", "steps", "right", "s"),
        tuple(rows),
        (
            "As expected: the goal reached, or refused where the scenario has no way that may be "
            "taken. Right: as many steps up and down as there are, by the simulator, none of them "
            "told to the robot. s: median of the runs that went as expected.",
        ),
    )


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
    spent = {
        scenario: [phase_seconds(run) for run in results.get(scenario, ()) if run.passed]
        for scenario in _TIMED
    }

    def row(name: str, paper: float, times: Sequence[Sequence[float]]) -> tuple[str, ...]:
        return (name, f"{paper:g}" if paper else NOTHING, *(middle(values) for values in times))

    rows = []
    for phase, (_, paper) in PHASES.items():
        rows.append(row(phase, paper, [[one[phase] for one in spent[s]] for s in _TIMED]))
        if phase == "climb":
            each = [[one[phase] / _STEPS for one in spent[s]] for s in _TIMED]
            rows.append(row("climb, a step", paper / _STEPS, each))
    rows.append(row("in all", 44.0, [[sum(one.values()) for one in spent[s]] for s in _TIMED]))
    states = "; ".join(f"{phase}: {', '.join(states)}" for phase, (states, _) in PHASES.items())
    return Table(
        "Seconds of each phase",
        ("phase", "the paper", *_TIMED),
        tuple(rows),
        (
            "Medians of the runs that went as expected, simulated time. The paper's figures are "
            "of the way up.",
            f"States that count for a phase until the last step is taken: {states}. All that "
            "comes later is the finish, one second of standing at the goal with it.",
        ),
    )


def _refusals(results: Results) -> Table:
    rows = tuple(
        (scenario, str(run.seed), run.reason or NOTHING, "yes" if run.passed else "no")
        for scenario, runs in results.items()
        for run in runs
        if run.outcome == "refused" or not run.passed
    )
    return Table(
        "What was refused, and what did not go as expected",
        ("scenario", "seed", "reason", "as expected"),
        rows or ((NOTHING,) * 4,),
    )


def _heights(results: Results) -> Table:
    tops = [
        surface
        for run in results.get("obstacle_course", ())
        for surface in run.surfaces
        if surface.estimate is not None
    ]
    rows = []
    for name, truth, paper in _LEVELS:
        found = [
            1e3 * (top.estimate or 0.0) for top in tops if abs(top.truth - truth) < _SAME_HEIGHT
        ]
        spread = f"{min(found):.1f} to {max(found):.1f}" if found else NOTHING
        cells = (f"{1e3 * truth:.0f}", f"{paper:.0f}", middle(found), spread, str(len(found)))
        rows.append((name, *cells))
    return Table(
        "Heights of the levels in the map of obstacle_course, mm",
        ("level", "true", "the paper", "median", "range", "runs"),
        tuple(rows),
        ("The paper: ICRA 2005, Table I. Ours: what the map had in the end.",),
    )


def stairs_tables(results: Results) -> list[Table]:
    """Return the tables of what came out."""
    return [_outcomes(results), _times(results), _refusals(results), _heights(results)]


STAIRS: Final = Experiment(
    name="stairs",
    description="Stairs seen, understood and climbed (Gutmann, Fukuchi, Fujita 2004 and 2005)",
    scenarios=tuple(CHANGES),
    tables=stairs_tables,
)
