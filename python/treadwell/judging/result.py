"""`result.json`: what came of an episode, and whether it met its expectations."""

# ruff: noqa: RUF012 - pydantic gives each object its own copy of a default

import json
import math
from pathlib import Path
from typing import Annotated, Any, Final, Literal

from pydantic import Field, FiniteFloat, ValidationError

from treadwell.errors import InputError
from treadwell.files import read_text, write_text
from treadwell.judging.entries import Count, FootstepPlanEntry, Instant, Table
from treadwell.scenario.model import Expect
from treadwell.summary import Shown

LARGEST_RESULT: Final = 100_000_000
"""Bytes."""
SCHEMA: Final = "treadwell.result/1"
STAGES: Final = (
    "physics", "depth", "segment", "map", "stairs", "localize", "plan", "behave", "walk"
)  # fmt: skip
"""Keys of `timing_ms`."""

Outcome = Literal["goal_reached", "refused", "fell", "timed_out", "stuck", "interrupted", "error"]
Share = Annotated[FiniteFloat, Field(ge=0.0, le=1.0)]
_WHERE_IT_MOVED: Any = Field(default=None, exclude_if=lambda found: found is None)


class CollisionEntry(Table):
    """A contact between the robot and an element that is no sole on a walkable top."""

    time: Instant
    """When it began, simulated seconds."""
    robot_part: str
    """The robot's link."""
    element: str
    """The element's name, or its kind and number."""
    impulse: float
    """Force times time, N·s."""
    standing: bool | None = _WHERE_IT_MOVED
    """Of an element that moved when it began: whether the robot stood, for half a second unmoved on
    both soles. Left out for what did not move, as are the two speeds."""
    robot_speed: FiniteFloat | None = _WHERE_IT_MOVED
    """At which the robot's touched point moved towards the element then, m/s."""
    element_speed: FiniteFloat | None = _WHERE_IT_MOVED
    """At which the element's touched point moved towards the robot then, m/s."""


class Spread(Table):
    """Mean, standard deviation and maximum over the episode."""

    mean: float
    """Mean."""
    std: float
    """Standard deviation."""
    max: float
    """Largest."""


class LocalizationErrors(Table):
    """The estimate against the truth, over the camera frames."""

    translation_error: Spread
    """Distance between the believed and the true place, m."""
    heading_error: Spread
    """Difference in heading, rad."""
    odometry_translation_error: Spread
    """Distance between the place by leg odometry alone and the true one, m."""
    lost_share: Share = 0.0
    """Share of the frames in which the robot knew that it did not know its place, as before it is
    found and after it was carried off; the errors are of these frames, too."""


class SurfaceEntry(Table):
    """A walkable top, and what the map has for it."""

    element: str
    """The element's name, or its kind and number."""
    part: str
    """Which of its tops, as in `step 1`."""
    truth: float
    """True height, m."""
    estimate: float | None
    """Mapped height, m; none where the robot passed over it and the map has no cell for it."""
    cells: Count
    """Cells that the map has for it: interior ones, seen three times or more."""


class MapCounts(Table):
    """Cells of the map against the truth: numbers of cells, and shares of them.

    A floor cell lies on one floor whole, an obstacle cell has its centre in an obstacle; a whole
    obstacle cell has its corners there, too.
    """

    floor_cells: Count = 0
    """Cells that are floor in truth, of those that the map knows."""
    floor_cells_right: Share = 0.0
    """Share of them that the map calls floor."""
    obstacle_cells: Count = 0
    """Cells that are an obstacle in truth, of those that the map knows."""
    obstacle_cells_right: Share = 0.0
    """Share of them that the map calls an obstacle."""
    floor_called_obstacle: Share = 0.0
    """Share of the floor cells that the map calls an obstacle."""
    obstacle_called_floor: Share = 0.0
    """Share of the obstacle cells that the map calls floor."""
    whole_obstacle_cells: Count = 0
    """Cells that an obstacle fills whole."""
    whole_obstacle_called_floor: Share = 0.0
    """Share of them that the map calls floor."""


class StateEntry(Table):
    """A state of the behaviour."""

    time: Instant
    """When it was entered, simulated seconds."""
    state: str
    """Its name."""


class Timing(Table):
    """How long a stage took."""

    median: float = 0.0
    """Median, ms."""
    p99: float = 0.0
    """99th percentile, ms."""
    max: float = 0.0
    """Longest, ms."""
    count: Count = 0
    """How often it ran."""


class Result(Shown, Table):
    """Schema `treadwell.result/1`; the keys of `result.json`."""

    schema_: Annotated[Literal["treadwell.result/1"], Field(alias="schema")] = SCHEMA
    """The version of this form."""
    scenario: str
    """The scenario's name."""
    robot: str
    """The robot's name."""
    seed: int
    """The seed: one seed gives one result, bit for bit, on one kind of processor."""
    version: str
    """The version of treadwell."""
    processor: str | None = None
    """What the physics ran on; on another the last bits, and so the run, may differ. None in runs
    of before."""
    configuration: dict[str, Any]
    """The whole scenario as it was run: overrides and draws applied."""
    scale: Annotated[FiniteFloat, Field(gt=0.0, exclude_if=lambda scale: bool(scale == 1.0))] = 1.0
    """What the lengths of course, start, goal and events in the configuration were multiplied by,
    with `scale_to_robot`; left out where that is 1."""
    ablation: bool = False
    """Whether anything in the core was given the truth."""
    outcome: Outcome
    """How it ended."""
    reason: str | None = None
    """Why, as `word: sentence`; none where the goal was reached."""
    passed: bool = False
    """Whether it met the scenario's expectations."""
    failures: list[str] = []
    """A sentence for each expectation that was not met."""
    simulated_seconds: Instant
    """How long it took, simulated seconds."""
    wall_seconds: float
    """How long that took by the clock, s."""
    real_time_factor: float
    """Simulated over wall-clock time."""
    physics_real_time_factor: float
    """Simulated time over what the physics took."""
    falls: Count = 0
    """How often it fell."""
    collisions: list[CollisionEntry] = []
    """What it ran into."""
    steps_taken: Count = 0
    """Steps of the feet."""
    footsteps_planned: Count | None = None
    """Steps that were planned one by one, and landed; None of a behaviour that plans none."""
    footsteps_refused: list[str] = []
    """Steps that the user's planner listed and that were not taken, each with the reason."""
    stairs_climbed: Count = 0
    """Changes of height of 15 mm or more upwards, by truth."""
    stairs_descended: Count = 0
    """Changes of height of 15 mm or more downwards, by truth."""
    path_length: float = 0.0
    """Way of the robot's middle, m, by truth."""
    replans: Count = 0
    """How often a way was planned anew after the first."""
    localization: LocalizationErrors | None = None
    """How far it was from where it believed to be."""
    surfaces: list[SurfaceEntry] = []
    """Every walkable top of the course."""
    map: MapCounts = MapCounts()
    """The map's cells against the truth."""
    behaviour: list[StateEntry] = []
    """The states of the behaviour, in order."""
    footstep_plans: list[FootstepPlanEntry] = []
    """Plans of footsteps by which the feet began to step, in order."""
    timing_ms: dict[str, Timing] = {}
    """Stage -> how long it took, ms."""

    @property
    def collisions_standing(self) -> int:
        """Collisions with what moved into the robot, or along it, while it stood."""
        return sum(hit.standing is True for hit in self.collisions)

    def judged_by(self, expect: Expect) -> "Result":
        """Return the result with `failures` and `passed` by a scenario's expectations."""
        failures = unmet(self, expect)
        return self.model_copy(update={"failures": failures, "passed": not failures})

    def document(self) -> dict[str, Any]:
        """Return it as plain data, as in the file."""
        return self.model_dump(mode="json", by_alias=True)

    def write(self, path: Path) -> None:
        """Write the file whole or not at all.

        Raises:
            OSError: the file cannot be written.
        """
        write_text(path, json.dumps(self.document(), indent=2, allow_nan=False) + "\n")


def unmet(result: Result, expect: Expect) -> list[str]:
    """Return a sentence for each expectation that was not met."""
    failures = []
    if result.outcome != expect.outcome:
        # A reason begins with a word, which may be the outcome's own.
        reason = (result.reason or "").removeprefix(f"{result.outcome}: ")
        because = f" ({reason})" if reason else ""
        failures.append(f"outcome: {result.outcome}{because}, expected {expect.outcome}")

    def at_most(name: str, found: float | None, limit: float | None, unit: str) -> None:
        if limit is None:
            return
        if found is None:
            failures.append(f"{name}: nothing was measured, at most {limit:g}{unit} expected")
        elif found > limit:
            failures.append(f"{name}: {found:.4g}{unit}, at most {limit:g}{unit} expected")

    at_most("max_time", result.simulated_seconds, expect.max_time, " s")
    at_most("max_falls", result.falls, expect.max_falls, "")
    at_most("max_collisions", len(result.collisions), expect.max_collisions, "")
    walking = len(result.collisions) - result.collisions_standing
    at_most("max_collisions_walking", walking, expect.max_collisions_walking, "")
    localization = result.localization
    error = None if localization is None else localization.translation_error.mean
    at_most("max_translation_error", error, expect.max_translation_error, " m")
    at_most("max_height_error", worst_surface(result), expect.max_height_error, " m")
    return failures


def worst_surface(result: Result) -> float | None:
    """Return the greatest error of a mapped top, m; infinite where one is missing, None for none.

    Only tops that the robot has passed over are listed without an estimate.
    """
    if not result.surfaces:
        return None
    return max(
        math.inf if entry.estimate is None else abs(entry.estimate - entry.truth)
        for entry in result.surfaces
    )


def read_result(path: Path) -> Result:
    """Read a `result.json`.

    Raises:
        InputError: it is missing, no JSON, or not of this schema.
    """
    text = read_text(path, LARGEST_RESULT)
    try:
        result = Result.model_validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"])
        raise InputError(f"{path}: {key + ': ' if key else ''}{first['msg']}") from None
    try:
        json.dumps(result.configuration, allow_nan=False)
    except ValueError:
        raise InputError(f"{path}: configuration: has a number that is not finite") from None
    return result
