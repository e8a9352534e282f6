"""The ways that sides of a comparison went over one and the same course, of what was recorded."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from treadwell.comparing.comparison import Candidate
from treadwell.errors import InputError, TreadwellError
from treadwell.recording.scenario_file import NAME as SCENARIO
from treadwell.recording.trajectory import TRUTH, read_trajectory
from treadwell.sweeps.folder import kept_folder

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Sketch:
    """A course from above, world frame, metres.

    Attributes:
        obstacles: (n, 2) outlines of what cannot be walked on.
        floors: (n, 2) outlines of what can.
        later: (n, 2) outlines of what events bring.
        start: x, y.
        goal: x, y and radius.
        via: x, y of points to pass.
    """

    obstacles: tuple[Floats, ...]
    floors: tuple[Floats, ...]
    later: tuple[Floats, ...]
    start: tuple[float, float]
    goal: tuple[float, float, float]
    via: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """Where the robot of a side truly was: (n, 2) m, and whether the episode was a success."""

    places: Floats
    success: bool


@dataclass(frozen=True, slots=True, eq=False)
class Ways:
    """Ways over one course.

    Attributes:
        scenario: its name.
        seed: of all of them.
        ways: index of a side -> its way; of those that have one.
        sketch: the course; None where it cannot be built any more.
        note: what lacks, a sentence; empty where nothing does.
    """

    scenario: str
    seed: int
    ways: dict[int, Way]
    sketch: Sketch | None
    note: str


NO_WAYS = (
    "no way was recorded: a sweep records the first seeds of each variant where --keep is more "
    "than 0"
)


def common_ways(sides: Sequence[Candidate]) -> Ways | None:
    """Return the ways over the scenario and seed of which most sides have a recording.

    Of several such the first is taken, in the order of the rows. A sweep keeps recordings of each
    variant's first seeds and of failures.

    Returns:
        The ways; None where nothing was recorded, for which `NO_WAYS` is what to say.
    """
    kept: dict[tuple[str, int], dict[int, tuple[Path, bool]]] = {}
    for number, side in enumerate(sides):
        for row in side.rows:
            folder = None if side.folder is None else kept_folder(side.folder, row.folder)
            if folder is not None and (folder / TRUTH).is_file():
                found = kept.setdefault((row.scenario, row.seed), {})
                found.setdefault(number, (folder, row.success))
    if not kept:
        return None
    scenario, seed = max(kept, key=lambda key: len(kept[key]))
    ways, faults = {}, []
    for number, (folder, success) in kept[scenario, seed].items():
        try:
            ways[number] = Way(read_trajectory(folder / TRUTH)[:, 1:3], success)
        except InputError as error:
            faults.append(str(error))
    missing = [side.name for number, side in enumerate(sides) if number not in ways]
    if missing:
        faults.append(f"no recording of {scenario} seed {seed} by {', '.join(missing)}")
    sketch, fault = _sketch([folder for folder, _ in kept[scenario, seed].values()])
    return Ways(scenario, seed, ways, sketch, "; ".join(filter(None, (*faults, fault))))


def _sketch(folders: Sequence[Path]) -> tuple[Sketch | None, str]:
    """Return the course of the first run whose scenario can be built, or why there is none."""
    # Late: both bring MuJoCo.
    from treadwell.course.build import build_course
    from treadwell.robot.load import load_robot
    from treadwell.scenario.loading import load_scenario
    from treadwell.scenario.scaling import to_robot

    fault = ""
    for folder in folders:
        try:
            written = load_scenario(folder / SCENARIO)
            robot = load_robot(written.robot)
            made = to_robot(written, robot)
            course = build_course(made, robot)
        except TreadwellError as error:
            fault = fault or f"the course cannot be drawn: {error}"
            continue
        there = [e for e in course.elements if e.present]
        later = [e for e in course.elements if not e.present]
        sketch = Sketch(
            obstacles=tuple(p.outline for e in there if not e.walkable for p in e.pieces),
            floors=tuple(p.outline for e in there if e.walkable for p in e.pieces),
            later=tuple(p.outline for e in later for p in e.pieces),
            start=course.start.position,
            goal=(*made.goal.position, made.goal.radius),
            via=tuple(made.goal.via),
        )
        return sketch, ""
    return None, fault
