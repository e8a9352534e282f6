"""Robots side by side: the same courses, each multiplied to the robot that walks it."""

import math
from collections.abc import Callable, Sequence
from typing import Final

from treadwell.experiments.experiment import NOTHING, Experiment, Results, Table, share
from treadwell.experiments.robots.entrants import COURSES, OF, Entrant, entrants
from treadwell.experiments.robots.steps_of_buildings import DEPTH_M, RISES_M
from treadwell.experiments.stairs import reasons
from treadwell.runner import Run
from treadwell.scenario.elements import Stairs
from treadwell.scenario.model import Scenario

STEPS: Final = ("stairs_up", "stairs_down")
"""Courses with steps."""
LEG_M: Final = 0.25
"""Leg length of a robot of scale 1."""
WANTED_OF_BUILDINGS: Final = {0.12: "19 of 20"}
"""Rise, m -> runs wanted; of others none."""


def robots_experiment(robots: Sequence[str] = ()) -> Experiment:
    """Return the experiment with robots of the user's.

    Args:
        robots: names and folders; none: those that ship.

    Raises:
        InputError: one is none, or is broken.
    """
    those = entrants(robots)
    return Experiment(
        name="robots",
        description="every robot on the same courses, each multiplied to its size",
        cases=tuple(case for entrant in those for case in entrant.cases),
        tables=robots_tables(those),
        of_robots=robots_experiment,
    )


def robots_tables(those: Sequence[Entrant]) -> Callable[[Results], Sequence[Table]]:
    """Return what makes the tables of these robots' runs; of what was not run there is none."""

    def tables(results: Results) -> Sequence[Table]:
        rows = [row for entrant in those if (row := _row(entrant, results))]
        table = Table(
            "Robots",
            ("robot", "scale", *COURSES, "wanted", "short of it", "rise, mm", "rise / leg"),
            tuple(rows),
            (
                "Of each course: runs at the goal without a fall or a touch; falls and touches of "
                f"the others. Wanted: of {OF} runs, in the order of the columns. Short of it: "
                "courses on which the share of the runs is less. Rise: of the highest step; leg: "
                f"from the hip to the ground, {LEG_M:g} m times the scale.",
            ),
        )
        made = (table, _buildings(those, results), reasons(results))
        return [one for one in made if one.rows]

    return tables


def _row(entrant: Entrant, results: Results) -> tuple[str, ...]:
    """Return a robot's row; nothing where it did not run."""
    runs = {course: results.get(entrant.course(course).name, ()) for course in COURSES}
    every = [run for done in runs.values() for run in done]
    if not every:
        return ()
    scale = every[0].result.scale
    rises = [_highest(run) for course in STEPS for run in runs[course]]
    short = [
        course
        for course, wanted in zip(COURSES, entrant.wanted, strict=True)
        if runs[course] and _passed(runs[course]) < math.ceil(len(runs[course]) * wanted / OF)
    ]
    return (
        entrant.label,
        f"{scale:g}",
        *(_cell(runs[course]) for course in COURSES),
        ", ".join(str(count) for count in entrant.wanted),
        ", ".join(short) or NOTHING,
        f"{1e3 * max(rises):.0f}" if rises else NOTHING,
        f"{max(rises) / (LEG_M * scale):.2f}" if rises else NOTHING,
    )


def _buildings(those: Sequence[Entrant], results: Results) -> Table:
    rows = []
    for entrant in those:
        for rise in RISES_M:
            up, down = (results.get(entrant.steps(rise, way).name, ()) for way in ("up", "down"))
            if up or down:
                size = f"{100 * rise:.0f} x {100 * DEPTH_M:.0f} cm"
                wanted = WANTED_OF_BUILDINGS.get(rise, NOTHING)
                rows.append((entrant.label, size, _cell(up), _cell(down), wanted))
    return Table(
        "Steps of buildings",
        ("robot", "rise x depth", "up", "down", "wanted, each"),
        tuple(rows),
        ("Four steps, whatever the robot's size; counted as above.",),
    )


def _passed(runs: Sequence[Run]) -> int:
    return sum(run.outcome == "goal_reached" and _unharmed(run) for run in runs)


def _unharmed(run: Run) -> bool:
    return not run.result.falls and not run.result.collisions


def _cell(runs: Sequence[Run]) -> str:
    falls = sum(run.result.falls for run in runs)
    touches = sum(len(run.result.collisions) for run in runs)
    harm = [_counted(falls, "fall", "falls"), _counted(touches, "touch", "touches")]
    told = ", ".join(filter(None, harm))
    return share(_passed(runs), len(runs)) + (f" ({told})" if told else "")


def _counted(count: int, one: str, several: str) -> str:
    return f"{count} {one if count == 1 else several}" if count else ""


def _highest(run: Run) -> float:
    """Return the rise of the highest step of a run's stairs, m."""
    made = Scenario.model_validate(dict(run.result.configuration))
    rises = [rise for one in made.course if isinstance(one, Stairs) for rise in one.rises()]
    return run.result.scale * max(rises, default=0.0)


ROBOTS: Final = robots_experiment()
