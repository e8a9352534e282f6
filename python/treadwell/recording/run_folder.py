"""Folders of runs and experiments: where they are, that they are new, and `runs/latest`."""

import errno
import os
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from treadwell.errors import InputError, RecordingError

RUNS = Path("runs")
_DISK = (errno.ENOSPC, errno.EDQUOT, errno.EIO)
"""Faults of the disk, which are not the user's."""


@contextmanager
def run_folder(out: Path | None, scenario: str, robot: str, seed: int) -> Iterator[Path]:
    """Give a new, empty folder to begin a run in; where that fails, nothing is left of it.

    Args:
        out: where; None: `runs/<scenario>-<robot>-<seed>-<time>/`, and `runs/latest` leads there
            once the run has begun.
        scenario: the scenario's name.
        robot: the robot's name.
        seed: the seed.

    Raises:
        InputError: there is something already, or no folder can be made there.
        RecordingError: the disk is full or broken.
    """
    was_there = out is not None and os.path.isdir(out)
    folder = _make(out, f"{scenario}-{robot}-{seed}")
    try:
        yield folder
        if out is None:
            _point_latest(folder)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        if was_there:
            folder.mkdir(exist_ok=True)
        raise


def make_experiment_folder(out: Path | None, experiment: str) -> Path:
    """Return a new, empty folder for an experiment's report and its runs.

    Args:
        out: where; None: `runs/experiment-<name>-<time>/`.
        experiment: the experiment's name.

    Raises:
        InputError: there is something already, or no folder can be made there.
    """
    return _make(out, f"experiment-{experiment}")


def sweep_folder(out: Path | None, name: str) -> Path:
    """Return the folder of a sweep, which may be there already: a sweep goes on.

    Args:
        out: where; None: a new one, `runs/sweep-<name>-<time>/`.
        name: of its first scenario or its suite.
    """
    return out or _unused(RUNS / f"sweep-{name}-{time.strftime('%Y%m%d-%H%M%S')}")


def make_folder_beside(out: Path | None, run_dir: Path, word: str) -> Path:
    """Return a new, empty folder for what is made of a run afterwards.

    Args:
        out: where; None: `<run>-<word>` beside the run's folder.
        run_dir: the run's folder.
        word: what is made.

    Raises:
        InputError: there is something already, or no folder can be made there.
    """
    beside = run_dir.resolve()
    return _make(out or _unused(beside.with_name(f"{beside.name}-{word}")), "")


def _make(out: Path | None, stem: str) -> Path:
    folder = out or RUNS / f"{stem}-{time.strftime('%Y%m%d-%H%M%S')}"
    try:
        if out is None:
            return _made_anew(folder)
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise InputError(f"--out: {folder} exists already; a run is never overwritten")
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _refused(folder, error) from None
    return folder


def _made_anew(folder: Path) -> Path:
    """Make a folder of this name, or with a number behind it where another process has it."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    while True:
        free = _unused(folder)
        try:
            free.mkdir()
        except FileExistsError:
            continue
        return free


def _unused(folder: Path) -> Path:
    candidate, number = folder, 1
    while candidate.exists():
        number += 1
        candidate = folder.with_name(f"{folder.name}-{number}")
    return candidate


def _point_latest(folder: Path) -> None:
    """Let `runs/latest` lead to the folder, in one step.

    Raises:
        InputError: there is something of that name.
        RecordingError: the disk is full or broken.
    """
    fresh = RUNS / f".latest-{os.getpid()}"
    try:
        fresh.unlink(missing_ok=True)
        fresh.symlink_to(folder.name)
        fresh.replace(RUNS / "latest")
    except OSError as error:
        raise _refused(folder, error) from None


def _refused(folder: Path, error: OSError) -> InputError | RecordingError:
    kind = RecordingError if error.errno in _DISK else InputError
    return kind(f"--out: {folder}: {error.strerror}")
