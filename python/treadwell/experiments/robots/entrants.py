"""Who takes part in the experiment `robots`, and on which courses."""

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final

from treadwell.data import robot_names
from treadwell.experiments.experiment import Case
from treadwell.experiments.robots.steps_of_buildings import DEPTH_M, RISES_M, stairs_of_a_building
from treadwell.robot.load import load_robot

COURSES: Final = ("open_floor", "slalom", "stairs_up", "stairs_down")
"""Scenarios that each robot walks, with `scale_to_robot`."""
OF: Final = 20
"""Seeds of which so many are wanted as `WANTED` has it."""
WANTED: Final[dict[str, tuple[int, int, int, int]]] = {
    "qrio": (20, 20, 19, 19),
    "nao": (20, 20, 19, 19),
    "op3": (20, 20, 19, 19),
    "toddlerbot": (19, 19, 18, 16),
    "t1": (19, 19, 18, 16),
    "h130": (19, 19, 15, 12),
}
"""A word of a robot's name -> runs wanted of `OF` on each of the courses."""
OF_ANY: Final = (17, 17, 15, 12)
"""The same of a robot that nobody here has seen."""
TALL: Final = 2.5
"""Scale from which on a robot is tried on the steps of buildings, too: legs of 63 cm."""
TALL_NAMES: Final = ("h130",)
"""Those that ship of this size: nothing is loaded to list what they run."""
_PARTS_OF_NAME: Final = re.compile(r"[^A-Za-z0-9.]+")


@dataclass(frozen=True, slots=True)
class Entrant:
    """A robot that takes part.

    Attributes:
        label: what the tables call it: its folder's name, with a number where two have the same.
        robot: its name, or its folder.
        is_tall: whether it is tried on the steps of buildings.
    """

    label: str
    robot: str
    is_tall: bool = False

    @property
    def wanted(self) -> tuple[int, ...]:
        """Runs of `OF` that are wanted on each of the courses."""
        words = [word.casefold() for word in _PARTS_OF_NAME.split(self.label)]
        return next((WANTED[word] for word in words if word in WANTED), OF_ANY)

    @property
    def cases(self) -> tuple[Case, ...]:
        """What is run of it."""
        steps = [(rise, way) for rise in RISES_M for way in ("up", "down")] if self.is_tall else []
        return (
            *(self.course(name) for name in COURSES),
            *(self.steps(rise, way) for rise, way in steps),
        )

    def course(self, name: str) -> Case:
        """Return what is run of it on a course that is multiplied to it."""
        # Quoted as TOML has it: a folder may be called as a number is.
        settings = (f"robot={json.dumps(self.robot, ensure_ascii=False)}", "scale_to_robot=true")
        return Case(f"{name}_{self.label}", name, settings)

    def steps(self, rise: float, way: str) -> Case:
        """Return what is run of it on steps of a building, of this rise, m, `up` or `down`."""
        name = f"steps_{100 * rise:.0f}x{100 * DEPTH_M:.0f}_{way}_{self.label}"
        return Case(name, partial(stairs_of_a_building, self.robot, rise, way))


def entrants(robots: Sequence[str]) -> list[Entrant]:
    """Return who takes part.

    Args:
        robots: names and folders; none: the robots that ship.

    Raises:
        InputError: one is none, or is broken.
    """
    found: list[Entrant] = []
    for robot in dict.fromkeys(str(robot) for robot in robots or robot_names()):
        ships = robot in robot_names()
        # So that nothing is run where one cannot.
        tall = robot in TALL_NAMES if ships and not robots else load_robot(robot).scale >= TALL
        place = robot if ships else str(Path(robot).resolve())
        name = "_".join(filter(None, _PARTS_OF_NAME.split(Path(place).name))) or "robot"
        taken = [one.label for one in found]
        numbers = (f"{name}_{number}" for number in range(2, len(taken) + 3))
        label = next(one for one in (name, *numbers) if one not in taken)
        found.append(Entrant(label, place, tall))
    return found
