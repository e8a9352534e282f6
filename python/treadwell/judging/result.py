"""`result.json`: what came of an episode, and whether it met its expectations."""

import json
import math
import os
import tempfile
from pathlib import Path
from typing import Annotated, Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, ValidationError

from treadwell.errors import InputError
from treadwell.files import read_text
from treadwell.scenario.model import Expect

LARGEST_RESULT: Final = 100_000_000
"""Bytes."""
SCHEMA: Final = "treadwell.result/1"
STAGES: Final = (
    "physics",
    "depth",
    "segment",
    "map",
    "stairs",
    "localize",
    "plan",
    "behave",
    "walk",
)
"""Keys of `timing_ms`."""

Outcome = Literal["goal_reached", "refused", "fell", "timed_out", "stuck", "interrupted", "error"]
Count = Annotated[int, Field(ge=0)]
Instant = Annotated[FiniteFloat, Field(ge=0.0, le=1e6)]
"""Simulated seconds since the start: a scenario's time limit is below it."""
Share = Annotated[FiniteFloat, Field(ge=0.0, le=1.0)]


class Table(BaseModel):
    """A part of the result: no further keys, no NaN, no infinity."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False, populate_by_name=True)


class CollisionEntry(Table):
    """A collision: s, the robot's link, the element's name, N·s."""

    time: Instant
    robot_part: str
    element: str
    impulse: float


class Spread(Table):
    """Mean, standard deviation and maximum over the episode."""

    mean: float
    std: float
    max: float


class LocalizationErrors(Table):
    """The estimate against the truth: m, rad, m."""

    translation_error: Spread
    heading_error: Spread
    odometry_translation_error: Spread


class SurfaceEntry(Table):
    """A walkable top: true and mapped height, m, and the cells that the map has for it."""

    element: str
    part: str
    truth: float
    estimate: float | None
    cells: Count


class MapCounts(Table):
    """Cells of the map against the truth: numbers of cells, and shares of them.

    A floor cell lies on one floor whole, an obstacle cell has its centre in an obstacle; a whole
    obstacle cell has its corners there, too.
    """

    floor_cells: Count = 0
    floor_cells_right: Share = 0.0
    obstacle_cells: Count = 0
    obstacle_cells_right: Share = 0.0
    floor_called_obstacle: Share = 0.0
    obstacle_called_floor: Share = 0.0
    whole_obstacle_cells: Count = 0
    whole_obstacle_called_floor: Share = 0.0


class StateEntry(Table):
    """When the behaviour entered a state, s, and the state's name."""

    time: Instant
    state: str


class Timing(Table):
    """How long a stage took, ms."""

    median: float = 0.0
    p99: float = 0.0
    max: float = 0.0
    count: Count = 0


class Result(Table):
    """Schema `treadwell.result/1`; the keys of `result.json`."""

    schema_: Annotated[Literal["treadwell.result/1"], Field(alias="schema")] = SCHEMA
    scenario: str
    robot: str
    seed: int
    version: str
    configuration: dict[str, Any]
    ablation: bool = False
    outcome: Outcome
    reason: str | None = None
    passed: bool = False
    failures: list[str] = []
    simulated_seconds: Instant
    wall_seconds: float
    real_time_factor: float
    physics_real_time_factor: float
    falls: Count = 0
    collisions: list[CollisionEntry] = []
    steps_taken: Count = 0
    stairs_climbed: Count = 0
    stairs_descended: Count = 0
    path_length: float = 0.0
    replans: Count = 0
    localization: LocalizationErrors | None = None
    surfaces: list[SurfaceEntry] = []
    map: MapCounts = MapCounts()
    behaviour: list[StateEntry] = []
    timing_ms: dict[str, Timing] = {}

    def judged_by(self, expect: Expect) -> "Result":
        """Return the result with `failures` and `passed` by a scenario's expectations."""
        failures = unmet(self, expect)
        return self.model_copy(update={"failures": failures, "passed": not failures})

    def write(self, path: Path) -> None:
        """Write the file whole or not at all.

        Raises:
            OSError: the file cannot be written.
        """
        table = self.model_dump(mode="json", by_alias=True)
        write_whole(path, json.dumps(table, indent=2, allow_nan=False) + "\n")


def unmet(result: Result, expect: Expect) -> list[str]:
    """Return a sentence for each expectation that was not met."""
    failures = []
    if result.outcome != expect.outcome:
        because = f" ({result.reason})" if result.reason else ""
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


def write_whole(path: Path, text: str) -> None:
    """Write a text file by way of a temporary one beside it, so that no half file is ever seen.

    Raises:
        OSError: the file cannot be written.
    """
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        Path(temporary).chmod(0o644)
        Path(temporary).replace(path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
