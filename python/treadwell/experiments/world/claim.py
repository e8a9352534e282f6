"""What is claimed of a case: which ends of a run are right, and whether one was."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

from treadwell.course.build import build_course
from treadwell.experiments.experiment import Case
from treadwell.robot.load import load_robot
from treadwell.runner import Run
from treadwell.scenario.loading import load_scenario
from treadwell.solving.solvable import is_solvable

ROBOTS: Final = ("qrio", "nao")
"""Those that ship with the project; the second has another gait, camera and height."""
GOAL: Final = "goal"
"""Stands among refusal words for the goal reached."""

Ends = Callable[[int], frozenset[str]]
"""Makes the right ends of the run with a seed: words of refusals, `GOAL`; none: whatever comes."""


@dataclass(frozen=True, slots=True)
class Claim:
    """A case, for one robot, and how its runs have to end.

    Attributes:
        case: what is run.
        what: name of the row of the table; several cases may share it.
        robot: whose it is.
        ends: the right ends.
        untouched: whether the robot may meet nothing.
        judged: whether any refusal is right where the search on the true course finds no way.
    """

    case: Case
    what: str
    robot: str
    ends: Ends
    untouched: bool = True
    judged: bool = False

    def is_right(self, run: Run) -> bool:
        """Say whether a run ended as it has to: without a fall, and truly."""
        result = run.result
        if result.falls or (self.untouched and result.collisions):
            return False
        if result.outcome == "goal_reached":
            return GOAL in self.ends(result.seed) or not self.ends(result.seed)
        if result.outcome != "refused":
            return False
        told = word(run) in self.ends(result.seed)
        return told or (self.judged and has_no_way(self.case, run))


def always(*ends: str) -> Ends:
    """Return right ends that are the same for every seed."""
    return partial(_same, frozenset(ends))


def _same(ends: frozenset[str], _seed: int) -> frozenset[str]:
    return ends


def for_robot(robot: str, draw: Callable[[int], dict[str, Any]]) -> Callable[[int], dict[str, Any]]:
    """Return what draws the same scenario for a robot."""
    return partial(_with_robot, robot, draw)


def _with_robot(robot: str, draw: Callable[[int], dict[str, Any]], seed: int) -> dict[str, Any]:
    return {**draw(seed), "robot": robot}


def word(run: Run) -> str:
    """Return the word with which the robot refused; "" where it did not."""
    return (run.result.reason or "").partition(":")[0] if run.outcome == "refused" else ""


def touches_of_the_head(run: Run) -> int:
    """Return how often the head met something."""
    return sum("head" in met.robot_part for met in run.result.collisions)


def has_no_way(case: Case, run: Run) -> bool:
    """Say whether the search on the true course finds no way; False where it cannot tell."""
    drawn = not isinstance(case.scenario, str)
    file = run.folder.parent / f"{run.folder.name}.toml" if drawn else str(case.scenario)
    made = load_scenario(file, seed=run.result.seed, overrides=case.overrides)
    robot = load_robot(made.robot)
    return is_solvable(made, build_course(made, robot), robot) is False
