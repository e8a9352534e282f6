"""What is compared: a row's figures, which way is better, and how each is shown."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Literal

from treadwell.sweeps.row import Row


@dataclass(frozen=True, slots=True)
class Metric:
    """One figure of an episode.

    Attributes:
        name: its key in the comparison.
        title: of its column, with the unit.
        kind: `share` of the episodes, `mean` or `median` over those that have it.
        of: a row's figure; a bool for a share; None where there is none.
        better: `more` or `less`.
        digits: behind the point.
    """

    name: str
    title: str
    kind: Literal["share", "mean", "median"]
    of: Callable[[Row], float | bool | None]
    better: Literal["more", "less"]
    digits: int = 1


def _of_results(
    value: Callable[[Row], float | bool | None],
) -> Callable[[Row], float | bool | None]:
    """An episode that ended by an error has no figure: it did not even get far enough to fall."""
    return lambda row: None if row.outcome == "error" else value(row)


def _of_successes(value: Callable[[Row], float | None]) -> Callable[[Row], float | None]:
    return lambda row: value(row) if row.success and row.outcome == "goal_reached" else None


METRICS: Final = (
    Metric("success", "success", "share", lambda row: row.success, "more"),
    Metric("fall", "fell", "share", _of_results(lambda row: (row.falls or 0) > 0), "less"),
    Metric("collisions", "collisions", "mean", _of_results(lambda row: row.collisions), "less", 2),
    Metric("time", "time s", "median", _of_successes(lambda row: row.simulated_seconds), "less"),
    Metric(
        "path_efficiency",
        "path efficiency",
        "mean",
        _of_successes(lambda row: row.path_efficiency),
        "more",
        3,
    ),
    Metric(
        "translation_error",
        "place off m",
        "mean",
        _of_results(lambda r: r.translation_error_mean),
        "less",
        3,
    ),
    Metric(
        "heading_error",
        "heading off rad",
        "mean",
        _of_results(lambda r: r.heading_error_mean),
        "less",
        3,
    ),
    Metric(
        "height_error",
        "height off m",
        "mean",
        _of_results(lambda row: row.worst_height_error),
        "less",
        4,
    ),
    Metric(
        "floor_right",
        "floor right",
        "mean",
        _of_results(lambda row: row.floor_cells_right),
        "more",
        3,
    ),
    Metric(
        "obstacle_called_floor",
        "obstacle called floor",
        "mean",
        _of_results(lambda row: row.obstacle_called_floor),
        "less",
        4,
    ),
    Metric("core_ms", "core ms", "median", _of_results(lambda row: row.core_ms), "less", 2),
)
"""In the order of the columns."""
