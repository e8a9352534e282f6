"""A run as the page shows it: plain words, numbers with units, tables of text."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from markupsafe import Markup

from treadwell.errors import InputError
from treadwell.judging.result import Result, Spread
from treadwell.physics.parts import MODEL
from treadwell.recording.map_file import PICTURE
from treadwell.recording.scenario_file import without_nothing
from treadwell.reporting.charts import Line, plot, state_lane
from treadwell.reporting.footstep_costs import footstep_costs
from treadwell.reporting.images import Shot, film_uri, picture_uri, strip
from treadwell.reporting.repeat import Repeat, repeat_command
from treadwell.reporting.run_data import RunData, pose_errors
from treadwell.reporting.tables import TableData, table
from treadwell.summary import collisions_in_words


@dataclass(slots=True)
class RunSection:
    """What the page says of one run, failures first."""

    anchor: str
    title: str
    subtitle: str
    description: str
    folder: str
    passed: bool
    outcome: str
    reason: str
    failures: list[str]
    problems: list[str]
    facts: list[tuple[str, str]]
    repeat: Repeat
    processor: str = ""
    configuration: str = ""
    picture: str = ""
    shots: Sequence[Shot] = ()
    film: str = ""
    film_kind: str = ""
    plots: list[Markup] = field(default_factory=list)
    first_tables: list[TableData] = field(default_factory=list)
    tables: list[TableData] = field(default_factory=list)


def run_section(
    run: RunData, anchor: str, *, pictures: bool = True, film: Path | None = None
) -> RunSection:
    """Return what the page says of a run; what cannot be shown is said among its problems.

    Args:
        run: as far as its folder tells.
        anchor: of the section.
        pictures: whether the robot is drawn at some moments.
        film: of the run, which goes into the page where it is small.
    """
    result, problems = run.result, list(run.problems)
    title = f"{run.name('scenario')} · {run.name('robot')} · seed {run.name('seed')}"
    section = RunSection(
        anchor=anchor,
        title=title,
        subtitle=f"treadwell {run.name('version')}",
        description=str(run.configuration.get("description") or ""),
        folder=str(run.folder),
        passed=run.passed,
        outcome="cut off" if result is None else result.outcome.replace("_", " "),
        reason=_reason(run),
        failures=[] if result is None else result.failures,
        problems=problems,
        facts=_facts(run),
        repeat=repeat_command(run.configuration, run.folder) if run.configuration else Repeat(()),
        processor="" if result is None else result.processor or "",
    )
    try:
        if (run.folder / PICTURE).is_file():
            section.picture = picture_uri(run.folder / PICTURE)
        if pictures and (run.folder / MODEL).is_file():
            section.shots = strip(run.folder)
    except InputError as error:
        if str(error) not in problems:
            problems.append(str(error))
    if film is not None:
        section.film = film_uri(film) or ""
        section.film_kind = film.suffix.lower()[1:]
    section.plots = _plots(run)
    section.configuration = _toml(run.configuration)
    if result is not None:
        section.first_tables = _first_tables(result)
        section.tables = _tables(result)
    return section


def _reason(run: RunData) -> str:
    if run.result is not None:
        return run.result.reason or ""
    return "" if run.cut is None else run.cut.sentence()


def _toml(configuration: dict[str, Any]) -> str:
    try:
        return tomli_w.dumps(without_nothing(configuration))
    except (TypeError, ValueError, RecursionError):
        return str(configuration)


def _facts(run: RunData) -> list[tuple[str, str]]:
    result = run.result
    if result is None:
        seconds = None if run.cut is None else run.cut.seconds
        return [] if seconds is None else [("recorded until", f"{seconds:.2f} s")]
    facts = [
        ("simulated", f"{result.simulated_seconds:.1f} s"),
        ("against real time", f"{result.real_time_factor:.1f} ×"),
        ("falls", str(result.falls)),
        ("collisions", collisions_in_words(len(result.collisions), result.collisions_standing)),
        ("steps taken", str(result.steps_taken)),
        *(
            [("of them planned one by one", str(result.footsteps_planned))]
            if result.footsteps_planned is not None
            else []
        ),
        ("stairs up / down", f"{result.stairs_climbed} / {result.stairs_descended}"),
        ("path", f"{result.path_length:.2f} m"),
        ("replans", str(result.replans)),
    ]
    if result.localization is not None:
        mean, lost = result.localization.translation_error.mean, result.localization.lost_share
        share = f"; in {lost:.0%} of the frames it knew that it was lost" if lost else ""
        facts.append(("localization error", f"{1e3 * mean:.1f} mm{share}"))
    if result.ablation:
        facts.append(("ablation", "the core was given the truth"))
    return facts


def _first_tables(result: Result) -> list[TableData]:
    """Return what went wrong on the way."""
    if not result.collisions:
        return []
    hits = sorted(result.collisions, key=lambda hit: -hit.impulse)
    rows = [(f"{hit.time:.2f}", hit.robot_part, hit.element, f"{hit.impulse:.2f}") for hit in hits]
    columns = ("time (s)", "part of the robot", "element", "impulse (N·s)")
    found = [table("Collisions, the hardest first", columns, rows)]
    met = [
        (
            f"{hit.time:.2f}",
            hit.robot_part,
            hit.element,
            "stood" if hit.standing else "walked",
            *(f"{speed or 0.0:.2f}" for speed in (hit.robot_speed, hit.element_speed)),
        )
        for hit in result.collisions
        if hit.standing is not None
    ]
    if met:
        ways = ("the robot", "towards it (m/s)", "towards the robot (m/s)")
        found.append(table("Collisions with what moved", (*columns[:3], *ways), met))
    return found


def _tables(result: Result) -> list[TableData]:
    tables = [
        _localization(result),
        _surfaces(result),
        _map(result),
        footstep_costs(result),
        _timing(result),
    ]
    return [table for table in tables if table.rows]


def _localization(result: Result) -> TableData:
    kinds, rows = result.localization, []
    if kinds is not None:
        rows = [
            ("place (mm)", *_spread(kinds.translation_error, 1e3)),
            ("heading (°)", *_spread(kinds.heading_error, 180.0 / np.pi)),
            ("leg odometry alone (mm)", *_spread(kinds.odometry_translation_error, 1e3)),
        ]
    return table("Localization against the truth", ("", "mean", "std", "max"), rows)


def _surfaces(result: Result) -> TableData:
    rows = [
        (
            top.element,
            top.part,
            f"{1e3 * top.truth:.1f}",
            "not seen" if top.estimate is None else f"{1e3 * top.estimate:.1f}",
            "" if top.estimate is None else f"{1e3 * (top.estimate - top.truth):+.1f}",
            str(top.cells),
        )
        for top in result.surfaces
    ]
    columns = ("element", "part", "truth (mm)", "map (mm)", "error (mm)", "cells")
    return table("Heights of what can be walked on", columns, rows)


def _map(result: Result) -> TableData:
    counts, rows = result.map, []
    if counts.floor_cells + counts.obstacle_cells:
        rows = [
            ("floor cells", str(counts.floor_cells)),
            ("of them right", f"{100 * counts.floor_cells_right:.1f} %"),
            ("called obstacle", f"{100 * counts.floor_called_obstacle:.1f} %"),
            ("obstacle cells", str(counts.obstacle_cells)),
            ("of them right", f"{100 * counts.obstacle_cells_right:.1f} %"),
            ("called floor", f"{100 * counts.obstacle_called_floor:.1f} %"),
        ]
    return table("Map", ("", ""), rows)


def _timing(result: Result) -> TableData:
    rows = [
        (stage, f"{t.median:.2f}", f"{t.p99:.2f}", f"{t.max:.2f}", str(t.count))
        for stage, t in result.timing_ms.items()
        if t.count
    ]
    return table("Time (ms)", ("stage", "median", "p99", "max", "times"), rows)


def _spread(spread: Spread, factor: float) -> tuple[str, str, str]:
    return (
        f"{factor * spread.mean:.2f}",
        f"{factor * spread.std:.2f}",
        f"{factor * spread.max:.2f}",
    )


def _plots(run: RunData) -> list[Markup]:
    result = run.result
    ends = [rows[-1, 0] for rows in (run.estimate, run.truth) if len(rows)]
    end = float(max([result.simulated_seconds if result else 0.0, *ends, 1e-3]))
    plots = []
    if run.behaviour:
        plots.append(state_lane([(each.time, each.state) for each in run.behaviour], end))
    times, place, turn = pose_errors(run)
    if len(times):
        plots.append(
            plot(
                "Error of localization: place", "mm", [Line("place", times, 1e3 * place)], end, 5.0
            )
        )
        degrees = [Line("heading", times, np.degrees(turn))]
        plots.append(plot("Error of localization: heading", "°", degrees, end, 1.0))
    heights = [
        Line(name, rows[:, 0], 1e3 * rows[:, 3])
        for name, rows in (("true", run.truth), ("believed", run.estimate))
        if len(rows)
    ]
    if heights:
        plots.append(plot("Height of the ground under the robot", "mm", heights, end, 20.0))
    away = _distance(run)
    if away is not None:
        plots.append(plot("Distance to the goal", "m", [away], end))
    return plots


def _distance(run: RunData) -> Line | None:
    if not len(run.truth):
        return None
    try:
        x, y = (run.scale * float(value) for value in run.configuration["goal"]["position"])
    except (KeyError, TypeError, ValueError):
        return None
    with np.errstate(over="ignore"):
        away = np.hypot(run.truth[:, 1] - x, run.truth[:, 2] - y)
    return Line("true distance", run.truth[:, 0], away)
