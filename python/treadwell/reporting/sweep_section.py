"""A sweep as the page shows it: counts by line, failures with reasons, and where they happened."""

import shlex
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Final

from markupsafe import Markup

from treadwell.comparing.comparison import compared
from treadwell.comparing.sides import candidates
from treadwell.comparing.tables import comparison_tables
from treadwell.errors import InputError
from treadwell.reporting.course_plan import course_plan
from treadwell.reporting.sweep_data import EpisodeRow, SweepData
from treadwell.reporting.tables import TableData

_MOST_FAILURES: Final = 500
_MOST_PLANS: Final = 30


@dataclass(frozen=True, slots=True)
class Failure:
    """A failed episode: what the row says, the command to see it again, and its page if kept."""

    scenario: str
    robot: str
    variant: str
    seed: str
    outcome: str
    reason: str
    command: str
    link: str


@dataclass(frozen=True, slots=True)
class SweepSection:
    """What the page says of a sweep."""

    anchor: str
    title: str
    folder: str
    episodes: int
    successes: int
    problems: tuple[str, ...]
    lines: TableData
    words: TableData
    failures: list[Failure]
    more_failures: int
    plans: list[Markup]
    command: str
    comparison: list[TableData]
    kept: list[tuple[str, str]]


def sweep_section(sweep: SweepData, anchor: str, page: Path) -> SweepSection:
    """Return what the page says of a sweep.

    Args:
        sweep: its rows.
        anchor: of the section.
        page: where the page is written: links to kept runs are relative to it.
    """
    failed = [row for row in sweep.rows if not row.success]
    lines = list(dict.fromkeys(row.line for row in sweep.rows))
    plans = []
    for line in lines[:_MOST_PLANS]:
        ends = [row for row in failed if row.line == line and row.end is not None]
        if ends:
            plans.append(course_plan(ends))
    return SweepSection(
        anchor=anchor,
        title=f"Sweep {sweep.folder.name}",
        folder=str(sweep.folder),
        episodes=len(sweep.rows),
        successes=len(sweep.rows) - len(failed),
        problems=sweep.problems,
        lines=_lines(sweep.rows, lines),
        words=_words(failed),
        failures=[_failure(row, page) for row in failed[:_MOST_FAILURES]],
        more_failures=max(0, len(failed) - _MOST_FAILURES),
        plans=plans,
        command=sweep.command,
        comparison=_comparison(sweep),
        kept=[
            (" ".join(filter(None, (*row.line, row.seed))), link)
            for row in sweep.rows
            if row.success and (link := _link(row.folder, page))
        ],
    )


def _comparison(sweep: SweepData) -> list[TableData]:
    """Return the variants of a finished sweep side by side; nothing where it has only one."""
    try:
        sides = candidates([sweep.folder])
    except InputError:
        return []
    if len(sides) < 2:
        return []
    return [
        TableData(table.title, table.header, table.rows, " ".join(table.notes))
        for table in comparison_tables(compared(sides))
    ]


def _lines(rows: tuple[EpisodeRow, ...], lines: list[tuple[str, str, str]]) -> TableData:
    table = []
    for line in lines:
        own = [row for row in rows if row.line == line]
        good = sum(row.success for row in own)
        outcomes = Counter(row.outcome.replace("_", " ") for row in own if not row.success)
        errors = [row.error for row in own if row.error is not None]
        times = [row.seconds for row in own if row.seconds is not None and row.success]
        table.append(
            (
                *line,
                f"{good}\u202fof\u202f{len(own)}",
                f"{100 * good / len(own):.1f}\u202f%",
                f"{median(times):.1f}" if times else "",
                f"{1e3 * sum(errors) / len(errors):.1f}" if errors else "",
                ", ".join(f"{count} {name}" for name, count in outcomes.most_common()),
            )
        )
    columns = (
        "scenario", "robot", "variant", "success", "", "median time (s)",
        "localization error (mm)", "failures",
    )  # fmt: skip
    return TableData("Lines", columns, table)


def _words(failed: list[EpisodeRow]) -> TableData:
    """Return how often each outcome with the first word of its reason was there."""
    counts = Counter((row.outcome, row.reason.partition(":")[0]) for row in failed)
    rows = [(outcome, word, str(count)) for (outcome, word), count in counts.most_common()]
    return TableData("Why", ("outcome", "reason", "episodes"), rows)


def _failure(row: EpisodeRow, page: Path) -> Failure:
    sets = [word for setting in row.settings for word in ("--set", setting)]
    robot = ["--robot", row.robot_given] if row.robot_given else []
    words = ["treadwell", "run", row.source, *robot, "--seed", row.seed, *sets]
    known = bool(row.scenario and row.seed and (row.settings or not row.variant))
    return Failure(
        row.scenario,
        row.robot,
        row.variant,
        row.seed,
        row.outcome.replace("_", " "),
        row.reason,
        shlex.join(words) if known else "",
        _link(row.folder, page),
    )


def _link(folder: Path | None, page: Path) -> str:
    """Return where a kept run is, seen from the page: its own page where it has one."""
    if folder is None:
        return ""
    try:
        place = folder.resolve().relative_to(page.resolve().parent).as_posix()
    except ValueError:
        return ""
    return f"{place}/report.html" if (folder / "report.html").is_file() else f"{place}/"
