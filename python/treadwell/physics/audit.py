"""The audit: what plain MuJoCo needs to step to the same states as a run did, and that it does."""

import logging
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.errors import RecordingError
from treadwell.physics.parts import CTRL, EVENT_STEP, PARTS, QPOS, STATE0, TICK_SECONDS, join
from treadwell.physics.rows import Rows

# By default MuJoCo appends its warnings to a file in the current folder.
mujoco.set_mju_user_warning(logging.getLogger(__name__).warning)

SHORTEST_STEP = 1e-5
"""Seconds; a model with a shorter one is no run's."""
STATE = mujoco.mjtState.mjSTATE_INTEGRATION
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


def _key(field: str) -> str:
    return f"event_{field}" if field in _OWN_KEYS else field


def _untouched(field: str, row: NDArray[Any]) -> NDArray[Any]:
    return np.full_like(row, np.nan) if field in _OWN_KEYS else row
