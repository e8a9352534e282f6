"""The audit: what plain MuJoCo needs to step to the same states as a run did, and that it does."""

import logging
from pathlib import Path
from typing import Any
from zipfile import ZIP_STORED, BadZipFile, ZipFile

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError, RecordingError
from treadwell.limited import Limits, limited
from treadwell.physics.parts import CTRL, EVENT_STEP, PARTS, QPOS, STATE0, join
from treadwell.physics.rows import Rows

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


class Audit:
    """Collects the audit of one run: what plain MuJoCo needs to step to the same states.

    `physics.npz` holds `state0`, `ctrl`, `qpos`, and with events `event_step` (n,): row i of every
    further array was set before physics step `event_step[i]`. The arrays have the names of
    MuJoCo's fields (`xfrc_applied`, `mocap_pos`, `geom_friction`, ...), each row the whole field;
    `event_qpos` and `event_qvel` are NaN where an event left them alone.

    What is collected lies in files, not in memory: nameless ones, or those of `keep_in`. Where
    one cannot be written, all but the constructor raise RecordingError.

    Attributes:
        ctrl: a row a physics step.
        qpos: a row a control tick.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Keep the model and the state as they are before the first step."""
        self._model = np.empty(mujoco.mj_sizeModel(model), dtype=np.uint8)
        mujoco.mj_saveModel(model, None, self._model)
        state0 = np.empty(mujoco.mj_stateSize(model, STATE))
        mujoco.mj_getState(model, data, state0, STATE)
        self.ctrl = Rows((model.nu,))
        self.qpos = Rows((model.nq,))
        self._state0, self._event_step = Rows(()), Rows((), np.int64)
        self._state0.extend(state0)
        self._events: dict[str, Rows] = {}
        self._now: dict[str, NDArray[Any]] = {}
        """Each field as it is before the next step: as an event left it, or untouched."""
        self._now_step: int | None = None
        self._folder: Path | None = None
        self._dropped = False
        self._steps_per_tick = steps_per_tick(model)

    def tick(self, controls: NDArray[np.float64], positions: NDArray[np.float64]) -> None:
        """Keep a control tick: the steps' controls (n, nu), and all positions (nq,) after them."""
        if not self._dropped:
            self.ctrl.extend(controls)
            self.qpos.append(positions)

    def event(self, step: int, field: str, before: NDArray[Any], after: NDArray[Any]) -> None:
        """Keep what an event set.

        Args:
            step: the physics step before which it was set.
            field: name of the field.
            before: the whole field as it was.
            after: the whole field as it is now.
        """
        if self._dropped:
            return
        if self._now_step != step:
            self._end_events()
            self._now_step = step
        if field not in self._events:
            rows = self._events[field] = Rows(before.shape, before.dtype)
            if self._folder is not None:
                rows.keep_in(self._folder / f"{_key(field)}.npy")
            earlier = _untouched(field, np.array(before))
            rows.extend(np.broadcast_to(earlier, (len(self._event_step), *earlier.shape)))
        self._now[field] = np.array(after)

    def keep_in(self, folder: Path) -> None:
        """Keep what there is and what is to come in a run's folder, which exists.

        As it comes it is there: `model.mjb`, and an array a file in the folder `PARTS`, of which
        `save` or `join_parts` make `physics.npz`.

        Raises:
            RecordingError: it cannot be written.
        """
        parts = folder / PARTS
        try:
            parts.mkdir(exist_ok=True)
            self._model.tofile(folder / "model.mjb")
        except OSError as error:
            raise RecordingError(f"{parts}: cannot be written: {error.strerror}") from error
        self._folder = parts
        for key, rows in self._rows().items():
            rows.keep_in(parts / f"{key}.npy")

    def drop(self) -> None:
        """Forget everything, and what is to come: of a run of which nothing will be written."""
        self._dropped = True
        for rows in self._rows().values():
            rows.drop()

    def flush(self) -> None:
        """Write what waits in memory."""
        if self._now_step is not None and len(self.ctrl) > self._now_step:
            self._end_events()
        # The steps last: what they need to be repeated is then there.
        for rows in reversed(self._rows().values()):
            rows.flush()

    def save(self, folder: Path) -> None:
        """Write `model.mjb` and `physics.npz` into a folder that exists."""
        if self._folder is None or self._folder.parent != folder:
            self.keep_in(folder)
        self._end_events()
        self.flush()
        join(folder, self._rows(), self._steps_per_tick)
        # The deleted parts stay open: the run may go on, and be saved again elsewhere.
        self._folder = None

    def _rows(self) -> dict[str, Rows]:
        """Return the arrays by their names in the file."""
        rows = {STATE0: self._state0, CTRL: self.ctrl, QPOS: self.qpos}
        rows[EVENT_STEP] = self._event_step
        return rows | {_key(field): each for field, each in self._events.items()}

    def _end_events(self) -> None:
        """Add the row of the last step that had events."""
        step, self._now_step = self._now_step, None
        if step is None:
            return
        self._event_step.append(np.array(step))
        for field, rows in self._events.items():
            rows.append(self._now[field])
            self._now[field] = _untouched(field, self._now[field])


def join_parts(folder: Path) -> None:
    """Make `physics.npz` of what a run that was killed has left in its folder.

    Raises:
        RecordingError: there is nothing, or it cannot be written.
    """
    try:
        model = mujoco.MjModel.from_binary_path(str(folder / "model.mjb"))
    except ValueError as error:
        raise RecordingError(f"{folder / 'model.mjb'}: is missing or broken") from error
    join(folder, (), steps_per_tick(model))


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
