"""The verb `report`: one page on runs or sweeps, and a film where it is asked for."""

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from treadwell.cli.output import write_message
from treadwell.errors import InputError


def reported(run_dirs: Sequence[Path], *, out: Path | None, video: Path | None) -> dict[str, Any]:
    """Write page and film and return where they are.

    Raises:
        InputError: a folder is none of a run or a sweep, or an option is bad.
        RecordingError: a file cannot be written.
    """
    from treadwell.reporting.report import report

    faster: float | None = None
    if video is not None:
        from treadwell.film.film import write_film

        if len(run_dirs) != 1:
            raise InputError("--video: is of one run; give one folder")
        if not run_dirs[0].is_dir():
            raise InputError(f"{run_dirs[0]}: there is no such run")
        faster = write_film(run_dirs[0], video, _counter("film"))
        write_message(f"wrote {video}, {faster:g} times as fast as the run")
    path = report(run_dirs, out, video, _counter("page") if len(run_dirs) > 1 else None)
    write_message(f"wrote {path} ({path.stat().st_size / 1000:.0f} kB)")
    told = {"runs": [str(each) for each in run_dirs], "report": str(path)}
    return told | ({} if video is None else {"video": str(video)})


def _counter(title: str) -> Callable[[int, int], None]:
    """Return what shows on standard error how far the work is."""
    terminal = sys.stderr.isatty()

    def show(done: int, total: int) -> None:
        if terminal:
            sys.stderr.write(f"\r{title} {done} of {total}" + ("\n" if done == total else ""))
            sys.stderr.flush()
        elif done == total or done % max(1, total // 4) == 0:
            write_message(f"{title} {done} of {total}")

    return show
