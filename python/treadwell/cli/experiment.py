"""The verb `experiment`: a paper's tables with ours beside them."""

import os
from collections.abc import Sequence
from pathlib import Path

from treadwell.cli.output import (
    ERROR,
    FAILED,
    INTERRUPTED,
    PASSED,
    write_json,
    write_message,
    write_table,
)
from treadwell.cli.progress import ProgressLine
from treadwell.experiments.catalogue import find_experiment
from treadwell.experiments.conduct import Report, conduct


def experiment(
    name: str,
    *,
    robots: Sequence[str] = (),
    only: Sequence[str],
    seeds: range,
    workers: int | None,
    out: Path | None,
    as_json: bool,
    record: bool = False,
) -> int:
    """Run an experiment, show its tables, and return the exit status.

    Args:
        name: which.
        robots: names and folders of those that take part; none: the experiment's own.
        only: names of its cases that are run; all where there is none.
        seeds: of each case.
        workers: processes that run episodes at the same time; None: as many as there are cores.
        out: the folder of the report and of the runs.
        as_json: write the report to standard output as JSON instead of tables.
        record: keep a recording of every run.

    Raises:
        InputError: there is no such experiment, robot or case, or the folder cannot be taken.
    """
    chosen = find_experiment(name).with_robots(robots).narrowed(only)
    workers = workers or os.cpu_count() or 1
    report = conduct(chosen, seeds, out, workers=workers, record=record, progress=ProgressLine)
    if as_json:
        write_json(report.document())
    else:
        show(report)
    write_message(f"report: {report.folder / 'experiment.md'}")
    if report.interrupted:
        return INTERRUPTED
    if "error" in report.outcomes:
        return ERROR
    return PASSED if report.passed else FAILED


def show(report: Report) -> None:
    """Write the tables, each with how to read it."""
    for table in report.tables:
        write_table(table.title, table.header, table.rows)
        for note in table.notes:
            write_message(note)
