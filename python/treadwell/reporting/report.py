"""A report: folders read, sections made, one page written."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from treadwell.errors import InputError
from treadwell.reporting.page import NAME, page, write_page
from treadwell.reporting.run_data import read_run
from treadwell.reporting.sections import RunSection, run_section
from treadwell.reporting.sweep_data import is_sweep, read_sweep
from treadwell.reporting.sweep_section import SweepSection, sweep_section

MOST_STRIPS: Final = 20
"""Runs of one page that have pictures of the robot; the failed ones come first."""


def report(
    folders: Sequence[Path],
    out: Path | None = None,
    film: Path | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Write a page on runs and sweeps, and return where.

    Args:
        folders: of runs, or of sweeps.
        out: the page, or the folder for it. Default: `report.html` in the only folder.
        film: that was made of the only run; it goes into the page.
        progress: is told sections done and sections in all.

    Raises:
        InputError: there is no such folder, or it is neither a run's nor a sweep's, or `out` is
            needed.
        RecordingError: the page cannot be written.
    """
    path = _place(folders, out)
    sweeps: list[SweepSection] = []
    data = []
    for number, folder in enumerate(folders):
        if folder.is_dir() and is_sweep(folder):
            sweeps.append(sweep_section(read_sweep(folder), f"sweep-{number + 1}", path))
        else:
            data.append((f"run-{number + 1}", read_run(folder)))
    data.sort(key=lambda each: each[1].passed)
    runs: list[RunSection] = []
    for number, (anchor, run) in enumerate(data):
        runs.append(run_section(run, anchor, pictures=number < MOST_STRIPS, film=film))
        if progress is not None:
            progress(number + 1, len(data))
    write_page(path, page(runs, sweeps))
    return path


def _place(folders: Sequence[Path], out: Path | None) -> Path:
    if out is None:
        if len(folders) != 1:
            raise InputError("--out: is needed for a page on several folders")
        if not folders[0].is_dir():
            raise InputError(f"{folders[0]}: there is no such run")
        return folders[0] / NAME
    path = out if out.suffix.lower() in (".html", ".htm") and not out.is_dir() else out / NAME
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"--out: {path.parent}: {error.strerror}") from None
    return path
