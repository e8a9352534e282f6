"""A row of a sweep: one episode in figures, the same keys for every outcome."""

import hashlib
import json
import math
from dataclasses import asdict, dataclass, fields
from itertools import pairwise
from typing import Any, Final

from treadwell.judging.result import Result, worst_surface
from treadwell.scenario.model import Scenario
from treadwell.sweeps.request import Key

TIMED: Final = ("wall_seconds", "real_time_factor", "physics_real_time_factor", "timing_ms")
"""Keys of `result.json` that the clock decides."""
HARNESS: Final = ("physics", "depth")
"""Stages of `timing_ms` that are not the core's."""


@dataclass(frozen=True, slots=True)
class Row:
    """One episode. None: not known, or there is no such thing.

    Lengths are metres, angles radians, times seconds unless the name says otherwise.

    Attributes:
        passed: it met the scenario's expectations.
        solvable: a search on the true course finds a way within the robot's limits.
        justified: the robot refused, and there is no such way.
        success: passed or justified.
        straight_length: from the start over the points to pass to the goal's disc.
        path_efficiency: that by the way that was walked, at most 1; of those who arrived.
        worst_height_error: of the tops that the robot passed over; None where one has no cell.
        collisions_standing: those of the collisions with what moved while the robot stood.
        core_ms: sum of the medians of the core's stages.
        end_x, end_y, end_z: where the robot truly was in the end.
        folder: of its recording, within the sweep's folder.
        digest: of its result without what the clock decides: the same episode has the same.
        reproduced: whether the run for the recording had the same digest.
    """

    scenario: str
    robot: str
    variant: str
    seed: int
    outcome: str
    reason: str | None = None
    passed: bool = False
    solvable: bool | None = None
    justified: bool = False
    success: bool = False
    simulated_seconds: float | None = None
    wall_seconds: float | None = None
    falls: int | None = None
    collisions: int | None = None
    collisions_standing: int | None = None
    steps_taken: int | None = None
    stairs_climbed: int | None = None
    stairs_descended: int | None = None
    path_length: float | None = None
    straight_length: float | None = None
    path_efficiency: float | None = None
    replans: int | None = None
    translation_error_mean: float | None = None
    translation_error_max: float | None = None
    heading_error_mean: float | None = None
    odometry_translation_error_mean: float | None = None
    worst_height_error: float | None = None
    floor_cells_right: float | None = None
    obstacle_cells_right: float | None = None
    floor_called_obstacle: float | None = None
    obstacle_called_floor: float | None = None
    core_ms: float | None = None
    end_x: float | None = None
    end_y: float | None = None
    end_z: float | None = None
    folder: str | None = None
    digest: str | None = None
    reproduced: bool | None = None

    @property
    def key(self) -> Key:
        """Which episode it is."""
        return Key(self.scenario, self.robot, self.variant, self.seed)

    def document(self) -> dict[str, Any]:
        """Return it as plain data."""
        return asdict(self)


_TYPES: Final = {"str": (str,), "int": (int,), "float": (float, int), "bool": (bool,)}
COLUMNS: Final = tuple(field.name for field in fields(Row))


def row_of(document: dict[str, Any]) -> Row:
    """Return the row that `Row.document` gave.

    Raises:
        TypeError: it is none: a key or a value's type is another.
        ValueError: a number is not finite.
    """
    row = Row(**document)
    for name, kind in Row.__annotations__.items():
        value = getattr(row, name)
        allowed = _TYPES[str(getattr(kind, "__name__", kind)).partition(" ")[0]]
        optional = value is None and "None" in str(kind)
        if not optional and type(value) not in allowed:
            raise TypeError(f"{name}: found {value!r:.60}")
        if isinstance(value, float) and not math.isfinite(value):
            raise ValueError(f"{name}: found {value}")
    return row


def error_row(key: Key, reason: str) -> Row:
    """Return the row of an episode that came to no result."""
    return Row(key.scenario, key.robot, key.variant, key.seed, "error", reason)


def make_row(
    key: Key,
    result: Result,
    scenario: Scenario,
    end: tuple[float, float, float],
    *,
    solvable: bool | None,
) -> Row:
    """Return the row of an episode.

    Args:
        key: which it is.
        result: what came of it.
        scenario: as it was run.
        end: where the robot truly was, metres.
        solvable: whether a search on the true course finds a way; None: not known.
    """
    justified = result.outcome == "refused" and solvable is False
    straight = straight_length(scenario)
    arrived = result.outcome == "goal_reached" and result.path_length > 0.0
    errors, counted = result.localization, result.map
    drift = errors.odometry_translation_error if errors else None
    seen = counted.floor_cells + counted.obstacle_cells > 0
    worst = worst_surface(result)
    core = [times.median for stage, times in result.timing_ms.items() if stage not in HARNESS]
    return Row(
        scenario=key.scenario,
        robot=key.robot,
        variant=key.variant,
        seed=key.seed,
        outcome=result.outcome,
        reason=result.reason,
        passed=result.passed,
        solvable=solvable,
        justified=justified,
        success=result.passed or justified,
        simulated_seconds=result.simulated_seconds,
        wall_seconds=result.wall_seconds,
        falls=result.falls,
        collisions=len(result.collisions),
        collisions_standing=result.collisions_standing,
        steps_taken=result.steps_taken,
        stairs_climbed=result.stairs_climbed,
        stairs_descended=result.stairs_descended,
        path_length=result.path_length,
        straight_length=straight,
        path_efficiency=min(1.0, straight / result.path_length) if arrived else None,
        replans=result.replans,
        translation_error_mean=errors.translation_error.mean if errors else None,
        translation_error_max=errors.translation_error.max if errors else None,
        heading_error_mean=errors.heading_error.mean if errors else None,
        odometry_translation_error_mean=drift.mean if drift else None,
        worst_height_error=worst if worst is not None and math.isfinite(worst) else None,
        floor_cells_right=counted.floor_cells_right if seen else None,
        obstacle_cells_right=counted.obstacle_cells_right if seen else None,
        floor_called_obstacle=counted.floor_called_obstacle if seen else None,
        obstacle_called_floor=counted.obstacle_called_floor if seen else None,
        core_ms=sum(core) if core else None,
        end_x=end[0],
        end_y=end[1],
        end_z=end[2],
        digest=digest(result),
    )


def straight_length(scenario: Scenario) -> float:
    """Return the way from start to goal's disc, straight from point to point, metres."""
    goal = scenario.goal
    places = [scenario.start.position, *goal.via, goal.position]
    legs = sum(math.dist(a, b) for a, b in pairwise(places))
    return max(0.0, legs - goal.radius)


def digest(result: Result) -> str:
    """Return a hash of a result without what the clock decides."""
    document = result.model_dump(mode="json", by_alias=True)
    for key in TIMED:
        document.pop(key)
    text = json.dumps(document, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:32]
