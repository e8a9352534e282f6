"""Folders of short real runs, made once a process and copied by whoever changes one."""

import atexit
import shutil
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

import treadwell


@cache
def _scratch() -> Path:
    folder = Path(mkdtemp(prefix="treadwell-runs-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


@cache
def recorded_run() -> Path:
    """Three seconds before stairs, recorded; it fails, as the time is up."""
    folder = _scratch() / "recorded"
    settings = ("time_limit=3", "course.stairs.width=0.5")
    treadwell.run("stairs_up", seed=4, overrides=settings, out=folder)
    return folder


@cache
def plain_run() -> Path:
    """A second between walls, not recorded."""
    folder = _scratch() / "plain"
    treadwell.run("slalom", seed=1, overrides=("time_limit=1",), out=folder, record=False)
    return folder
