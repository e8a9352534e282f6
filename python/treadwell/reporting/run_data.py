"""What a run's folder still has: everything that can be read, and a sentence for what cannot."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.judging.result import Result, StateEntry, read_result
from treadwell.physics.parts import MODEL
from treadwell.recording.cut_off import CutRun, cut_run, is_cut_off
from treadwell.recording.file import NAME as RECORDING
from treadwell.recording.map_file import PICTURE
from treadwell.recording.observation_log import NAME as OBSERVATIONS
from treadwell.recording.observation_log import read_header
from treadwell.recording.trajectory import ESTIMATE, TRUTH, headings, read_trajectory

RESULT: Final = "result.json"
KNOWN: Final = (
    RESULT, ESTIMATE, TRUTH, PICTURE, RECORDING, OBSERVATIONS, "model.mjb", "physics.npz",
    "map.npz", "scenario.toml",
)  # fmt: skip
"""Files of a run."""
_OPTIONAL: Final = (RECORDING, OBSERVATIONS)
"""What `--no-record` leaves out, both together."""
_AS_IT_RUNS: Final = (RECORDING, OBSERVATIONS, MODEL, "scenario.toml")
"""What is written as a run goes on."""


@dataclass(frozen=True, slots=True, eq=False)
class RunData:
    """A run as far as its folder tells.

    Attributes:
        folder: the run's.
        result: None where the run was cut off before it was written.
        header: scenario, robot, seed and version as the observations say; for a run without result.
        problems: a sentence for each thing that is missing or broken.
        estimate: (n, 8) the believed trajectory; without rows where it is missing.
        truth: (n, 8) the true one.
        cut: what is known of a run that was cut off; None of one that has a result.
    """

    folder: Path
    result: Result | None
    header: dict[str, str]
    problems: list[str]
    estimate: NDArray[np.float64]
    truth: NDArray[np.float64]
    cut: CutRun | None = None

    @property
    def passed(self) -> bool:
        """Whether it met its expectations; a run without a result did not."""
        return self.result is not None and self.result.passed

    @property
    def configuration(self) -> dict[str, Any]:
        """The scenario as it was run; empty where nothing says it."""
        told = self.result or self.cut
        return {} if told is None else told.configuration

    @property
    def scale(self) -> float:
        """What the lengths in the configuration were multiplied by."""
        told = self.result or self.cut
        return 1.0 if told is None else told.scale

    @property
    def behaviour(self) -> Sequence[StateEntry]:
        """The states, each with the time at which it began."""
        told = self.result or self.cut
        return () if told is None else told.behaviour

    def name(self, key: str) -> str:
        """Return `scenario`, `robot`, `seed` or `version` as text; a dash where nothing says it."""
        if self.result is not None:
            return str(getattr(self.result, key))
        return self.header.get(key, "–")


def read_run(folder: Path) -> RunData:
    """Read a run's folder.

    Raises:
        InputError: there is no such folder, nothing in it is a run's, or its result is broken.
    """
    if not folder.is_dir():
        raise InputError(f"{folder}: there is no such run")
    if not any((folder / name).is_file() for name in KNOWN):
        raise InputError(f"{folder}: no run's folder: it has none of {', '.join(KNOWN)}")
    problems = _missing(folder)
    cut = cut_run(folder)
    if cut is not None:
        problems.insert(0, f"the run was {cut.sentence()}; `treadwell replay` makes its map")
        header = _header(folder / OBSERVATIONS, problems)
        return RunData(folder, None, header, problems, cut.estimate, cut.truth, cut)
    result = read_result(folder / RESULT) if (folder / RESULT).is_file() else None
    ways = []
    for name in (ESTIMATE, TRUTH):
        try:
            ways.append(read_trajectory(folder / name))
        except InputError as error:
            if (folder / name).is_file():
                problems.append(str(error))
            ways.append(np.empty((0, 8)))
    return RunData(folder, result, {}, problems, ways[0], ways[1])


def _missing(folder: Path) -> list[str]:
    gone = [name for name in KNOWN if not (folder / name).is_file()]
    if set(_OPTIONAL) <= set(gone):
        gone = [name for name in gone if name not in _OPTIONAL]
    if is_cut_off(folder):
        # The others are written in the end.
        gone = [name for name in gone if name in _AS_IT_RUNS]
    return [f"{name} is missing" for name in gone]


def _header(path: Path, problems: list[str]) -> dict[str, str]:
    """Return what a log says was run."""
    if not path.is_file():
        return {}
    try:
        return read_header(path)
    except InputError as error:
        problems.append(str(error))
        return {}


def pose_errors(run: RunData) -> tuple[NDArray[np.float64], ...]:
    """Return times (n,) s, errors of place (n,) m and of heading (n,) rad; empty without both.

    As in `result.json`: the distance in three dimensions, and the turn about the upright axis.
    """
    common, ours, theirs = np.intersect1d(run.estimate[:, 0], run.truth[:, 0], return_indices=True)
    believed, true = run.estimate[ours], run.truth[theirs]
    with np.errstate(over="ignore", invalid="ignore"):
        place = np.linalg.norm(believed[:, 1:4] - true[:, 1:4], axis=1)
        turn = headings(believed) - headings(true)
        return common, place, np.abs(np.arctan2(np.sin(turn), np.cos(turn)))
