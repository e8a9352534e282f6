"""The audit: what plain MuJoCo needs to step to the same states as a run did, and that it does."""

import logging
from pathlib import Path
from typing import Any
from zipfile import ZIP_STORED, BadZipFile, ZipFile

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.limited import Limits, limited

# By default MuJoCo appends its warnings to a file in the current folder.
mujoco.set_mju_user_warning(logging.getLogger(__name__).warning)

TICK_SECONDS = 0.01
"""A control tick: the time between two rows of `qpos`, s."""
SHORTEST_STEP = 1e-5
"""Seconds; a model with a shorter one is no run's."""
STATE = mujoco.mjtState.mjSTATE_INTEGRATION
LARGEST_MODEL = 500 << 20
"""Bytes of a model: as many as those of all files of a robot may have."""
MOST_ARRAYS = 100
LEAST_ROW = 8 * 12
"""Bytes of a row of `ctrl`: a robot has more motors than its legs' twelve."""
FIXED_SECONDS, STEP_SECONDS = 3, 1e-3
"""Of the processor's time that an audit may take, and more for each step; ten times the usual."""
DATA_FIELDS = ("xfrc_applied", "qpos", "qvel", "mocap_pos", "mocap_quat")
"""Fields of MuJoCo's data that an event may set; any other name is a field of the model."""
_OWN_KEYS = ("qpos", "qvel")
"""Fields that move by themselves. Their keys begin with `event_`, and a row of NaN sets nothing."""


def steps_per_tick(model: mujoco.MjModel) -> int:
    """Return the physics steps of a control tick: what the model's time step says.

    Raises:
        ValueError: a tick is not whole steps.
    """
    timestep = float(model.opt.timestep)
    steps = round(TICK_SECONDS / timestep) if timestep >= SHORTEST_STEP else 0
    if steps < 1 or abs(steps * timestep - TICK_SECONDS) > 1e-9:
        raise ValueError(f"{TICK_SECONDS} s must be whole time steps, got steps of {timestep:g} s")
    return steps


class Rows:
    """A two-dimensional array that grows by rows."""

    def __init__(self, width: int) -> None:
        """Make room for rows of this width."""
        self._rows = np.empty((1024, width))
        self._count = 0

    def add(self, count: int) -> NDArray[np.float64]:
        """Return new rows (count, width) at the end, to be filled."""
        begin, self._count = self._count, self._count + count
        while self._count > len(self._rows):
            self._rows = np.concatenate([self._rows, np.empty_like(self._rows)])
        return self._rows[begin : self._count]

    def array(self) -> NDArray[np.float64]:
        """Return (n, width): the rows so far, a view."""
        return self._rows[: self._count]


class Audit:
    """Collects the audit of one run: what plain MuJoCo needs to step to the same states.

    `physics.npz` holds `state0`, `ctrl`, `qpos`, and with events `event_step` (n,): row i of every
    further array was set before physics step `event_step[i]`. The arrays have the names of
    MuJoCo's fields (`xfrc_applied`, `mocap_pos`, `geom_friction`, ...), each row the whole field;
    `event_qpos` and `event_qvel` are NaN where an event left them alone.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Keep the model and the state as they are before the first step."""
        self._model = np.empty(mujoco.mj_sizeModel(model), dtype=np.uint8)
        mujoco.mj_saveModel(model, None, self._model)
        self._state0 = np.empty(mujoco.mj_stateSize(model, STATE))
        mujoco.mj_getState(model, data, self._state0, STATE)
        self.ctrl = Rows(model.nu)
        self.qpos = Rows(model.nq)
        self._event_step: list[int] = []
        self._events: dict[str, list[NDArray[Any]]] = {}

    def event(self, step: int, field: str, before: NDArray[Any], after: NDArray[Any]) -> None:
        """Keep what an event set.

        Args:
            step: the physics step before which it was set.
            field: name of the field.
            before: the whole field as it was.
            after: the whole field as it is now.
        """
        if not self._event_step or self._event_step[-1] != step:
            self._event_step.append(step)
            for name, rows in self._events.items():
                rows.append(_untouched(name, rows[-1]))
        if field not in self._events:
            earlier = _untouched(field, np.array(before))
            self._events[field] = [earlier] * len(self._event_step)
        self._events[field][-1] = np.array(after)

    def save(self, folder: Path) -> None:
        """Write `model.mjb` and `physics.npz` into a folder that exists."""
        self._model.tofile(folder / "model.mjb")
        arrays: dict[str, Any] = {
            "state0": self._state0,
            "ctrl": self.ctrl.array(),
            "qpos": self.qpos.array(),
        }
        if self._event_step:
            arrays["event_step"] = np.array(self._event_step, dtype=np.int64)
            for field, rows in self._events.items():
                arrays[_key(field)] = np.stack(rows)
        np.savez(folder / "physics.npz", **arrays)


def replay_audit(folder: Path) -> int | None:
    """Step plain MuJoCo through an audit and compare the states bit for bit.

    Args:
        folder: with `model.mjb` and `physics.npz`.

    Returns:
        The first row of `qpos` that differs, or None if all are the same.

    Raises:
        InputError: a file is missing or broken, or they do not belong together.
    """
    model, arrays = load_audit(folder)
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
    path, model = folder / "physics.npz", folder / "model.mjb"
    if not model.is_file():
        raise InputError(f"{model}: is missing or broken")
    if model.stat().st_size > LARGEST_MODEL:
        raise InputError(
            f"{model}: is missing or broken: larger than {LARGEST_MODEL} bytes, which is the limit"
        )
    seconds = FIXED_SECONDS + int(STEP_SECONDS * _steps(path))
    limits = Limits(cpu_seconds=seconds, deadline_seconds=60.0 + 10.0 * seconds)
    rows, different, steps = limited(replay_lengths, [str(folder)], str(model), limits)
    return int(rows), None if different is None else int(different), int(steps)


def replay_lengths(folder: str) -> tuple[int, int | None, int]:
    """Return what `replay_limited` returns: the part that the child does."""
    different = replay_audit(Path(folder))
    with np.load(Path(folder) / "physics.npz", allow_pickle=False) as file:
        rows = len(file["qpos"])
        return rows, different, len(file["ctrl"]) // max(rows, 1)


def _steps(path: Path) -> int:
    """Return how many physics steps an audit can have at most, by the bytes of its file.

    Raises:
        InputError: it is no archive as `save` writes it, whose arrays are as large as the file.
    """
    try:
        if not path.is_file():
            raise InputError(f"{path}: is missing or broken: there is no such file")
        with ZipFile(path) as archive:
            members = archive.infolist()
        packed = any(member.compress_type != ZIP_STORED for member in members)
    except (OSError, ValueError, EOFError, BadZipFile, NotImplementedError) as error:
        raise InputError(f"{path}: is missing or broken: {error}") from None
    if packed or len(members) > MOST_ARRAYS:
        raise InputError(f"{path}: is missing or broken: is not as a run writes it")
    ctrl = next((member.file_size for member in members if member.filename == "ctrl.npy"), 0)
    return int(min(ctrl, path.stat().st_size)) // LEAST_ROW


def load_audit(folder: Path) -> tuple[mujoco.MjModel, dict[str, NDArray[Any]]]:
    """Return the model and the arrays of an audit.

    Raises:
        InputError: a file is missing or broken, or they do not belong together.
    """
    try:
        model = mujoco.MjModel.from_binary_path(str(folder / "model.mjb"))
    except ValueError as error:
        raise InputError(f"{folder / 'model.mjb'}: is missing or broken") from error
    path = folder / "physics.npz"
    _steps(path)
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            arrays = {key: file[key] for key in file.files}
        whole = _fits(model, arrays)
    except (OSError, ValueError, EOFError, KeyError, AttributeError, BadZipFile) as error:
        raise InputError(f"{path}: is missing or broken: {error}") from error
    except MemoryError:
        raise InputError(f"{path}: is missing or broken: an array that no memory holds") from None
    if not whole:
        raise InputError(f"{path}: does not fit model.mjb beside it")
    return model, arrays


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


def _key(field: str) -> str:
    return f"event_{field}" if field in _OWN_KEYS else field


def _untouched(field: str, row: NDArray[Any]) -> NDArray[Any]:
    return np.full_like(row, np.nan) if field in _OWN_KEYS else row
