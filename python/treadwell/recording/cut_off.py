"""A run that was cut off, killed or without power: until when, and what its log says.

Such a run has no `result.json`. Its trajectories and states are in its log, which has them to the
last third of a second; its map comes of a replay.
"""

import math
import os
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell.careful_json import json_of
from treadwell.errors import InputError
from treadwell.judging.result import StateEntry
from treadwell.physics.parts import PARTS, QPOS, TICK_SECONDS, part_rows
from treadwell.recording.log_file import BrokenLogError, read_front, read_messages
from treadwell.recording.messages import Belief, decode_estimate, decode_truth
from treadwell.recording.observation_log import NAME as OBSERVATIONS
from treadwell.recording.observation_log import ROBOT
from treadwell.recording.scenario_file import NAME as SCENARIO
from treadwell.recording.trajectory import ESTIMATE, TRUTH, Trajectory, read_trajectory
from treadwell.scenario.loading import read_toml

RESULT: Final = "result.json"


@dataclass(frozen=True, slots=True, eq=False)
class CutRun:
    """What is known of a run that was cut off.

    Attributes:
        seconds: simulated time until which it was recorded; None where nothing says it.
        configuration: the scenario as it was run; empty where it cannot be read.
        scale: what the lengths in it were multiplied by, with `scale_to_robot`.
        behaviour: the states, each with the time at which it began.
        estimate: (n, 8) the believed trajectory, as `read_trajectory` has it.
        truth: (n, 8) the true one.
    """

    seconds: float | None
    configuration: dict[str, Any] = field(default_factory=dict)
    behaviour: list[StateEntry] = field(default_factory=list)
    estimate: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 8)))
    truth: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 8)))
    scale: float = 1.0

    def sentence(self) -> str:
        """Return what is told of it in one line."""
        when = "" if self.seconds is None else f" at {self.seconds:.2f} s"
        return f"cut off{when}, killed or without power unless it still runs: it has no {RESULT}"


def is_cut_off(folder: Path) -> bool:
    """Say whether a run's folder was begun and has no result."""
    if os.path.lexists(folder / RESULT):
        return False
    return any((folder / name).exists() for name in (SCENARIO, OBSERVATIONS, PARTS))


def cut_run(folder: Path) -> CutRun | None:
    """Return what is known of a run that was cut off; None of one that came to its end."""
    if not is_cut_off(folder):
        return None
    try:
        configuration = read_toml(folder / SCENARIO)
    except InputError:
        configuration = {}
    log = folder / OBSERVATIONS
    if not log.is_file():
        return CutRun(_audited_seconds(folder), configuration)
    told = _Told()
    with suppress(InputError):  # it ends where it was cut off
        told.read(log)
    seconds = told.seconds if told.seconds is not None else _audited_seconds(folder)
    ways = (told.estimate.rows, told.truth.rows)
    scale = _scale(log) if configuration.get("scale_to_robot") is True else 1.0
    return CutRun(seconds, configuration, told.behaviour, *ways, scale)


def ways(folder: Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the believed and the true trajectory, (n, 8) each; of a cut run those of its log.

    Raises:
        InputError: one of them is missing or broken.
    """
    cut = cut_run(folder)
    if cut is not None:
        return cut.estimate, cut.truth
    return read_trajectory(folder / ESTIMATE), read_trajectory(folder / TRUTH)


def _scale(log: Path) -> float:
    """Return the robot's scale, as the log's description of it has it; 1 where nothing says it."""
    try:
        robot = json_of(read_front(log).attachments[ROBOT], f"{log}: {ROBOT}: is broken")
        scale = float(robot["scale"])
    except (InputError, KeyError, TypeError, ValueError):
        return 1.0
    return scale if math.isfinite(scale) and scale > 0.0 else 1.0


def _audited_seconds(folder: Path) -> float | None:
    """Return the simulated time that the parts of the audit hold."""
    rows = part_rows(folder, QPOS)
    return None if rows is None else rows * TICK_SECONDS


class _Told:
    """What a log tells, one message after the other."""

    def __init__(self) -> None:
        self.seconds: float | None = None
        self.behaviour: list[StateEntry] = []
        self.estimate, self.truth = Trajectory(), Trajectory()

    def read(self, log: Path) -> None:
        """Take in all messages.

        Raises:
            InputError: the log breaks off; what came before was taken in.
        """
        has_frame, belief = False, None
        for message in read_messages(log, ("/depth", "/estimate", "/truth")):
            try:
                if message.topic == "/depth":
                    has_frame = True
                elif message.topic == "/estimate":
                    belief = decode_estimate(message.data)
                    self._tick(belief)
                elif belief is not None:
                    if has_frame or belief.time_ns == 0:
                        self.estimate.add_level(belief.time_ns, belief.pose)
                        self.truth.add_row(belief.time_ns, decode_truth(message.data))
                    has_frame, belief = False, None
            except ValueError as error:
                raise BrokenLogError(f"{log}: is no recording: {error}", 0) from None

    def _tick(self, belief: Belief) -> None:
        time_s = 1e-9 * belief.time_ns
        self.seconds = time_s + TICK_SECONDS
        if not self.behaviour or self.behaviour[-1].state != belief.state:
            self.behaviour.append(StateEntry(time=time_s, state=belief.state))
