"""One export: which format, from which folder, into which."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Final

from treadwell.errors import InputError, RecordingError
from treadwell.recording.cut_off import is_cut_off
from treadwell.recording.map_file import NAME as MAP
from treadwell.scenario.loading import scenario_names


def _octomap(source: Path, out: Path) -> Sequence[Path]:
    from treadwell.exports.octomap import export_octomap

    return export_octomap(source, out)


def _map_server(source: Path, out: Path) -> Sequence[Path]:
    from treadwell.exports.map_server import export_map_server

    return export_map_server(source, out)


def _ply(source: Path, out: Path) -> Sequence[Path]:
    from treadwell.exports.ply import export_ply

    return export_ply(source, out)


def _tum(source: Path, out: Path) -> Sequence[Path]:
    from treadwell.exports.tum import export_tum

    return export_tum(source, out)


def _mcap(source: Path, out: Path) -> Sequence[Path]:
    from treadwell.exports.mcap import export_mcap

    return export_mcap(source, out)


def _gltf(source: Path, out: Path) -> Sequence[Path]:
    from treadwell.exports.gltf import export_gltf

    return export_gltf(source, out)


def _rosbag2(source: Path, out: Path, storage: str = "mcap") -> Sequence[Path]:
    from treadwell.exports.rosbag2 import export_rosbag2

    return export_rosbag2(source, out, storage)


FORMATS: Final[dict[str, Callable[[Path, Path], Sequence[Path]]]] = {
    "octomap": _octomap,
    "map_server": _map_server,
    "ply": _ply,
    "tum": _tum,
    "mcap": _mcap,
    "gltf": _gltf,
    "rosbag2": _rosbag2,
}
"""Name of a format -> what writes it; what a format needs is imported when it is asked for."""


def export(
    run_dir: Path, to: str, out: Path | None = None, *, storage: str | None = None
) -> list[Path]:
    """Write a run's files in a format of other tools.

    Args:
        run_dir: the run's folder; for `octomap` also a scenario, of which the course is written
            as the map that a robot is told.
        to: one of `FORMATS`.
        out: the folder; made where there is none. Default: `export-<format>` in the run's; of a
            scenario `<scenario>-octomap`.
        storage: of `rosbag2`: `mcap`, which is the default, or `sqlite3`.

    Returns:
        The files written. A file of that name that was there is replaced; the folder of a bag must
        be new or empty.

    Raises:
        InputError: there is no such run or format, or the run lacks what the format shows.
        RecordingError: a file cannot be written.
    """
    if to not in FORMATS:
        raise InputError(f"--to: found {to}; must be one of {', '.join(FORMATS)}")
    if storage is not None and to != "rosbag2":
        raise InputError(f"--storage: found {storage}; only a rosbag2 has one, and not {to}")
    folder = run_dir / f"export-{to}"
    work: Callable[[Path], Sequence[Path]]
    if run_dir.is_dir():
        work = partial(FORMATS[to], run_dir)
        if storage is not None:
            work = partial(_rosbag2, run_dir, storage=storage)
    elif to == "octomap" and (run_dir.is_file() or str(run_dir) in scenario_names()):
        from treadwell.exports.octomap import export_course

        work = partial(export_course, str(run_dir))
        folder = Path(f"{run_dir.stem}-{to}")
    else:
        raise InputError(f"{run_dir}: there is no such run")
    folder = folder if out is None else out
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"--out: {folder}: {error.strerror}") from None
    try:
        return list(work(folder))
    except InputError as error:
        if is_cut_off(run_dir) and not (run_dir / MAP).exists():
            raise InputError(
                f"{error} (the run was cut off; `treadwell replay {run_dir}` makes its map)"
            ) from None
        raise
    except OSError as error:
        raise RecordingError(f"{folder}: cannot be written: {error.strerror or error}") from error
