"""The arrays of an audit while it goes on, a file each, and `physics.npz` made of them."""

import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import IO, Final
from zipfile import ZIP_STORED, ZipFile

import numpy as np

from treadwell.errors import InputError, RecordingError
from treadwell.files import opened, whole_file
from treadwell.physics.rows import write_header

PARTS: Final = "physics.part"
"""Name of the folder, in a run's, while it goes on."""
AUDIT: Final = "physics.npz"
MODEL: Final = "model.mjb"
STATE0, CTRL, QPOS, EVENT_STEP = "state0", "ctrl", "qpos", "event_step"
TICK_SECONDS: Final = 0.01
"""A control tick: the time between two rows of `qpos`, s."""
_FIRST: Final = (STATE0, CTRL, QPOS, EVENT_STEP)


def join(folder: Path, names: Iterable[str], steps_a_tick: int, path: Path | None = None) -> None:
    """Make `physics.npz` of the parts in a run's folder, and delete them.

    Of a run that was killed the rows to the last tick that all parts have are taken.

    Args:
        folder: the run's.
        names: the arrays in the order in which they are written; those that are there by default.
        steps_a_tick: rows of `ctrl` to one of `qpos`.
        path: of a file elsewhere; the parts then stay.

    Raises:
        RecordingError: a part is missing or broken, or the file cannot be written.
    """
    parts = folder / PARTS
    try:
        others = sorted(path.stem for path in parts.glob("*.npy") if path.stem not in _FIRST)
        order = list(names) or [*_FIRST, *others]
        rows = {name: _rows(parts / f"{name}.npy") for name in order}
        ticks = min(rows[QPOS], rows[CTRL] // steps_a_tick)
        events = min(rows[name] for name in order if name not in (STATE0, CTRL, QPOS))
        taken = dict.fromkeys(order, events)
        taken |= {STATE0: rows[STATE0], CTRL: ticks * steps_a_tick, QPOS: ticks}
        with (
            whole_file(path or folder / AUDIT) as temporary,
            ZipFile(temporary, "w", ZIP_STORED) as archive,
        ):
            for name in order if events else (STATE0, CTRL, QPOS):
                # As numpy writes it: an hour's are larger than what memory should hold.
                with (
                    opened(parts / f"{name}.npy") as part,
                    archive.open(f"{name}.npy", "w", force_zip64=True) as member,
                ):
                    _copy(part, member, taken[name])
        if path is None:
            shutil.rmtree(parts)
    except (InputError, OSError, ValueError, KeyError) as error:
        reason = getattr(error, "strerror", None) or error
        raise RecordingError(f"{path or folder / AUDIT}: cannot be written: {reason}") from error


def part_bytes(folder: Path, name: str) -> int:
    """Return the bytes of a part; 0 where it is missing.

    Args:
        folder: the run's.
        name: the array's.
    """
    path = folder / PARTS / f"{name}.npy"
    return path.stat().st_size if path.is_file() else 0


def part_rows(folder: Path, name: str) -> int | None:
    """Return how many whole rows a part has; None where there is none.

    Args:
        folder: the run's.
        name: the array's.
    """
    try:
        return _rows(folder / PARTS / f"{name}.npy")
    except (InputError, OSError, ValueError):
        return None


def _rows(path: Path) -> int:
    """Return how many rows a part has in truth."""
    with opened(path) as file:
        shape, _, dtype = _header(file)
        row_bytes = dtype.itemsize * int(np.prod(shape[1:]))
        return min(shape[0], (path.stat().st_size - file.tell()) // max(1, row_bytes))


def _copy(part: IO[bytes], member: IO[bytes], count: int) -> None:
    """Copy a part's first rows with a header that says how many they are."""
    shape, _, dtype = _header(part)
    write_header(member, dtype, (count, *shape[1:]))
    left = count * dtype.itemsize * int(np.prod(shape[1:]))
    while left and (block := part.read(min(left, 1 << 20))):
        left -= len(block)
        member.write(block)


def _header(file: IO[bytes]) -> tuple[tuple[int, ...], bool, "np.dtype[np.generic]"]:
    np.lib.format.read_magic(file)
    said: tuple[tuple[int, ...], bool, np.dtype[np.generic]]
    said = np.lib.format.read_array_header_1_0(file)
    return said
