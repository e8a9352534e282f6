"""Where everything was at each control tick of a run: its audit, without stepping the physics."""

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.physics.audit import STATE, steps_per_tick
from treadwell.physics.parts import TICK_SECONDS
from treadwell.physics.recorded_audit import event_keys, load_audit

TICK_S = TICK_SECONDS
"""Seconds between two rows."""
_MOVED = ("mocap_pos", "mocap_quat")
"""What an event sets that is seen."""


class RecordedPoses:
    """A run's poses, row by row in any order.

    Attributes:
        model: as it was run.
        data: its poses are those of the row that was set last.
        count: rows, one a control tick; row i is the state i + 1 ticks after the start.
    """

    def __init__(self, folder: Path) -> None:
        """Load a run's audit.

        Raises:
            InputError: it is missing or broken.
        """
        self.model, self._arrays = load_audit(folder)
        self._steps_per_tick = steps_per_tick(self.model)
        self.data = mujoco.MjData(self.model)
        mujoco.mj_setState(self.model, self.data, self._arrays["state0"], STATE)
        self.count = len(self._arrays["qpos"])
        self._steps: NDArray[Any] = self._arrays.get("event_step", np.empty(0, np.int64))
        self._moved = [key for key in event_keys(self._arrays) if key in _MOVED]
        self._first = {key: getattr(self.data, key).copy() for key in self._moved}
        mujoco.mj_kinematics(self.model, self.data)

    def set(self, row: int) -> mujoco.MjData:
        """Return the data with the poses of a row, 0 <= row < count."""
        self.data.qpos[:] = self._arrays["qpos"][row]
        step = (row + 1) * self._steps_per_tick
        last = int(np.searchsorted(self._steps, step, side="left")) - 1
        for key in self._moved:
            getattr(self.data, key)[:] = self._arrays[key][last] if last >= 0 else self._first[key]
        mujoco.mj_kinematics(self.model, self.data)
        return self.data

    def root(self) -> int:
        """Return the robot's body: the one that moves freely; the first body without one."""
        free = np.flatnonzero(self.model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)
        return int(self.model.jnt_bodyid[free[0]]) if free.size else min(1, self.model.nbody - 1)

    def robot_bodies(self) -> NDArray[np.bool_]:
        """Return which bodies (nbody,) are the robot's."""
        mine: NDArray[np.bool_] = self.model.body_rootid == self.model.body_rootid[self.root()]
        return mine
