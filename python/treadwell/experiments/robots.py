"""Robots side by side: the same courses, each multiplied to the robot that walks it."""

import json
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from treadwell.data import robot_names
from treadwell.experiments.experiment import NOTHING, Case, Experiment, Results, Table, share
from treadwell.experiments.stairs import reasons
from treadwell.robot.load import load_robot
from treadwell.runner import Run
from treadwell.scenario.elements import Stairs
from treadwell.scenario.model import Scenario

COURSES: Final = ("open_floor", "slalom", "stairs_up", "stairs_down")
"""Scenarios that each robot walks, with `scale_to_robot`."""
STEPS: Final = ("stairs_up", "stairs_down")
"""Those of them with steps."""
LEG_M: Final = 0.25
"""Leg length of a robot of scale 1."""
OF: Final = 20
"""Seeds of which so many are wanted as `WANTED` has it."""
WANTED: Final[dict[str, tuple[int, int, int, int]]] = {
    "qrio": (20, 20, 19, 19),
    "nao": (20, 20, 19, 19),
    "op3": (20, 20, 19, 19),
    "toddlerbot": (19, 19, 18, 16),
    "t1": (19, 19, 18, 16),
}
"""A word of a robot's name -> runs wanted of `OF` on each of the courses."""
OF_ANY: Final = (17, 17, 15, 12)
"""The same of a robot that nobody here has seen."""
_PARTS_OF_NAME: Final = re.compile(r"[^A-Za-z0-9.]+")


@dataclass(frozen=True, slots=True)
class Entrant:
    """A robot that takes part.

    Attributes:
        label: what the tables call it: its folder's name, with a number where two have the same.
        robot: its name, or its folder.
    """

    label: str
    robot: str

    @property
    def wanted(self) -> tuple[int, ...]:
        """Runs of `OF` that are wanted on each of the courses."""
        words = [word.casefold() for word in _PARTS_OF_NAME.split(self.label)]
        return next((WANTED[word] for word in words if word in WANTED), OF_ANY)

    def case(self, course: str) -> Case:
        """Return what is run of it on a course."""
        # Quoted as TOML has it: a folder may be called as a number is.
        settings = (f"robot={json.dumps(self.robot, ensure_ascii=False)}", "scale_to_robot=true")
        return Case(f"{course}_{self.label}", course, settings)


def robots_experiment(robots: Sequence[str] = ()) -> Experiment:
    """Return the experiment with robots of the user's.

    Args:
        robots: names and folders; none: those that ship.

    Raises:
        InputError: one is none, is broken, or is given twice.
    """
    for robot in robots:
        load_robot(robot)  # so that nothing is run where one cannot
    entrants = _entrants(robots or robot_names())
    cases = tuple(entrant.case(course) for entrant in entrants for course in COURSES)
    return Experiment(
        name="robots",
        description="every robot on the same courses, each multiplied to its size",
        cases=cases,
        tables=robots_tables(entrants),
        of_robots=robots_experiment,
    )


def robots_tables(entrants: Sequence[Entrant]) -> Callable[[Results], Sequence[Table]]:
    """Return what makes the tables of these robots' runs; of what was not run there is none."""

    def tables(results: Results) -> Sequence[Table]:
        rows = [row for entrant in entrants if (row := _row(entrant, results))]
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
        return [made for made in (table, reasons(results)) if made.rows]

    return tables


def _entrants(robots: Sequence[str]) -> list[Entrant]:
    entrants: list[Entrant] = []
    for robot in dict.fromkeys(str(robot) for robot in robots):
        place = robot if robot in robot_names() else str(Path(robot).resolve())
        name = "_".join(filter(None, _PARTS_OF_NAME.split(Path(place).name))) or "robot"
        taken = [one.label for one in entrants]
        numbers = (f"{name}_{number}" for number in range(2, len(taken) + 3))
        label = next(one for one in (name, *numbers) if one not in taken)
        entrants.append(Entrant(label, place))
    return entrants


def _row(entrant: Entrant, results: Results) -> tuple[str, ...]:
    """Return a robot's row; nothing where it did not run."""
    runs = {course: results.get(entrant.case(course).name, ()) for course in COURSES}
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
