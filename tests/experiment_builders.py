"""Runs with given findings, and rows of the tables that they make."""

from collections.abc import Callable, Sequence
from pathlib import Path

from episode_builders import result, scenario

from treadwell.experiments.experiment import Results, Table
from treadwell.runner import Run

MADE = scenario()


def rows_of(
    tables: Callable[[Results], Sequence[Table]], results: Results, title: str
) -> dict[str, tuple[str, ...]]:
    """The rows, by their first cell, of the table whose title begins so."""
    made = next(one for one in tables(results) if one.title.startswith(title))
    assert all(len(row) == len(made.header) for row in made.rows)
    return {row[0]: row[1:] for row in made.rows}


def watched(*findings: object) -> list[Run]:
    return [Run(result(MADE), Path("folder"), findings=one) for one in findings]
