"""Reading an audit: plain MuJoCo steps through it, and its states are held against the run's."""

import os
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from zipfile import ZIP_STORED, BadZipFile, ZipFile

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError, RecordingError
from treadwell.files import opened
from treadwell.limited import Limits, limited
from treadwell.physics.audit import DATA_FIELDS, STATE, steps_per_tick
from treadwell.physics.parts import AUDIT, CTRL, MODEL, PARTS, QPOS, join, part_bytes

LARGEST_MODEL = 500 << 20
"""Bytes of a model: as many as those of all files of a robot may have."""
MOST_ARRAYS = 100
LEAST_ROW = 8 * 12
"""Bytes of a row of `ctrl`: a robot has more motors than its legs' twelve."""
FIXED_SECONDS, STEP_SECONDS = 3, 1e-3
"""Of the processor's time that an audit may take, and more for each step; ten times the usual."""


def join_parts(folder: Path) -> None:
    """Make `physics.npz` of what a run that was killed has left in its folder.

    Raises:
        RecordingError: there is nothing, or it cannot be written.
    """
    try:
        join(folder, (), steps_per_tick(read_model(folder)))
    except InputError as error:
        raise RecordingError(str(error)) from error


def replay_audit(folder: Path) -> int | None:
    """Step plain MuJoCo through an audit and compare the states bit for bit.

    Args:
        folder: with `model.mjb` and `physics.npz`.

    Returns:
        The first row of `qpos` that differs, or None if all are the same.

    Raises:
        InputError: a file is missing or broken, or they do not belong together.
    """
    return _first_difference(*load_audit(folder))


def _first_difference(model: mujoco.MjModel, arrays: dict[str, NDArray[Any]]) -> int | None:
    data, steps = mujoco.MjData(model), steps_per_tick(model)
    mujoco.mj_setState(model, data, arrays["state0"], STATE)
    events = {int(step): row for row, step in enumerate(arrays.get("event_step", ()))}
    fields = [(arrays[key], _field(model, data, key)) for key in event_keys(arrays)]
    for step, ctrl in enumerate(arrays["ctrl"]):
        if step in events:
            for rows, array in fields:
                row = rows[events[step]]
                if not np.isnan(row).all():
                    array[:] = row
        data.ctrl[:] = ctrl
        mujoco.mj_step(model, data)
        tick, rest = divmod(step + 1, steps)
        if rest == 0 and not np.array_equal(arrays["qpos"][tick - 1], data.qpos):
            return tick - 1
    return None


def replay_limited(folder: Path) -> tuple[int, int | None, int]:
    """Do what `replay_audit` does in a child process: a model may be made to crash MuJoCo.

    Returns:
        The rows of `qpos`, the first that differs, or None if all are the same, and the physics
        steps of a row.

    Raises:
        InputError: a file is missing or broken, or takes more than an audit of its size should.
    """
    model = folder / MODEL
    check_model(model)
    seconds = FIXED_SECONDS + int(STEP_SECONDS * _steps(folder))
    limits = Limits(cpu_seconds=seconds, deadline_seconds=60.0 + 10.0 * seconds)
    rows, different, steps = limited(replay_lengths, [str(folder)], str(model), limits)
    return int(rows), None if different is None else int(different), int(steps)


def replay_lengths(folder: str) -> tuple[int, int | None, int]:
    """Return what `replay_limited` returns: the part that the child does."""
    model, arrays = load_audit(Path(folder))
    return len(arrays[QPOS]), _first_difference(model, arrays), steps_per_tick(model)


def check_model(path: Path) -> None:
    """Look at a model's file before MuJoCo does, which waits for a pipe, and reads what never ends.

    Raises:
        InputError: it is missing, no file, or too large.
    """
    try:
        opened(path).close()
    except InputError as error:
        raise InputError(f"{path}: is missing or broken: {error}") from None
    if path.stat().st_size > LARGEST_MODEL:
        raise InputError(
            f"{path}: is missing or broken: larger than {LARGEST_MODEL} bytes, which is the limit"
        )


def read_model(folder: Path) -> mujoco.MjModel:
    """Return the model of a run.

    Raises:
        InputError: it is missing or broken.
    """
    check_model(folder / MODEL)
    try:
        return mujoco.MjModel.from_binary_path(str(folder / MODEL))
    except ValueError:
        raise InputError(f"{folder / MODEL}: is missing or broken") from None


def in_parts(folder: Path) -> bool:
    """Say whether an audit is still in parts: the run was cut off, or there was no room."""
    return (folder / PARTS).is_dir() and not os.path.lexists(folder / AUDIT)


def _steps(folder: Path) -> int:
    """Return how many physics steps an audit can have at most, by the bytes of its file.

    Raises:
        InputError: it is no archive as `save` writes it, whose arrays are as large as the file.
    """
    if in_parts(folder):
        return part_bytes(folder, CTRL) // LEAST_ROW
    path = folder / AUDIT
    try:
        with opened(path) as file, ZipFile(file) as archive:
            members, size = archive.infolist(), os.fstat(file.fileno()).st_size
    except (InputError, OSError, ValueError, EOFError, BadZipFile, NotImplementedError) as error:
        raise InputError(f"{path}: is missing or broken: {error}") from None
    packed = any(member.compress_type != ZIP_STORED for member in members)
    if packed or len(members) > MOST_ARRAYS:
        raise InputError(f"{path}: is missing or broken: is not as a run writes it")
    ctrl = next((member.file_size for member in members if member.filename == "ctrl.npy"), 0)
    return int(min(ctrl, size)) // LEAST_ROW


def load_audit(folder: Path) -> tuple[mujoco.MjModel, dict[str, NDArray[Any]]]:
    """Return the model and the arrays of an audit; of a run that was cut off, those of its parts.

    Raises:
        InputError: a file is missing or broken, or they do not belong together.
    """
    model = read_model(folder)
    if in_parts(folder):
        with TemporaryDirectory() as place:
            path = Path(place) / AUDIT
            try:
                join(folder, (), steps_per_tick(model), path)
            except (RecordingError, ValueError) as error:
                raise InputError(f"{folder / PARTS}: is broken: {error}") from None
            return model, _arrays(path, model)
    _steps(folder)
    return model, _arrays(folder / AUDIT, model)


def _arrays(path: Path, model: mujoco.MjModel) -> dict[str, NDArray[Any]]:
    try:
        with opened(path) as stream, np.load(stream, allow_pickle=False) as file:
            arrays = {key: file[key] for key in file.files}
        whole = _fits(model, arrays)
    except MemoryError:
        raise InputError(f"{path}: is missing or broken: an array that no memory holds") from None
    except Exception as error:  # of an old file numpy takes the header apart as Python: any fault
        raise InputError(f"{path}: is missing or broken: {error}") from error
    if not whole:
        raise InputError(f"{path}: does not fit {MODEL} beside it")
    return arrays


def _fits(model: mujoco.MjModel, arrays: dict[str, NDArray[Any]]) -> bool:
    """Whether all arrays are there with the sizes that the model asks for."""
    ctrl, qpos, state0 = arrays["ctrl"], arrays["qpos"], arrays["state0"]
    data, events = mujoco.MjData(model), arrays.get("event_step", ())
    return (
        all(array.dtype.kind in "bifu" for array in arrays.values())
        and ctrl.ndim == 2
        and ctrl.shape[1] == model.nu
        and qpos.shape == (len(ctrl) // steps_per_tick(model), model.nq)
        and state0.shape == (mujoco.mj_stateSize(model, STATE),)
        and all(
            arrays[key].shape == (len(events), *_field(model, data, key).shape)
            for key in event_keys(arrays)
        )
    )


def event_keys(arrays: dict[str, NDArray[Any]]) -> list[str]:
    """Return which arrays of an audit hold what events set."""
    return [key for key in arrays if key not in ("state0", "ctrl", "qpos", "event_step")]


def _field(model: mujoco.MjModel, data: mujoco.MjData, key: str) -> NDArray[Any]:
    field = key.removeprefix("event_")
    array: NDArray[Any] = getattr(data if field in DATA_FIELDS else model, field)
    return array
