"""`treadwell verify`: a run's files are whole, belong together, and plain MuJoCo agrees."""

import math
import os
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from treadwell.errors import InputError
from treadwell.files import read_content
from treadwell.judging.result import Result, read_result
from treadwell.physics.parts import AUDIT, TICK_SECONDS
from treadwell.physics.recorded_audit import in_parts, replay_limited
from treadwell.processor import likely_reason
from treadwell.recording.cut_off import RESULT, CutRun, cut_run
from treadwell.recording.file import NAME as RECORDING
from treadwell.recording.file import begins_right, whole_length
from treadwell.recording.log_file import BrokenLogError, read_front, read_messages
from treadwell.recording.map_file import NAME as MAP
from treadwell.recording.map_file import PICTURE, read_map
from treadwell.recording.observation_log import CORE, hash_of, header_of, read_observations
from treadwell.recording.observation_log import NAME as OBSERVATIONS
from treadwell.recording.scenario_file import NAME as SCENARIO
from treadwell.recording.scenario_file import without_nothing
from treadwell.recording.trajectory import ESTIMATE, TRUTH, read_trajectory
from treadwell.scenario.loading import read_toml
from treadwell.version import __version__

_PNG: Final = b"\x89PNG\r\n\x1a\n"
_LARGEST_PICTURE: Final = 100_000_000
"""Bytes."""
_TICK: Final = TICK_SECONDS
_BESIDE: Final = ("/command", "/estimate", "/truth")
"""Topics that have one message for each observation."""


@dataclass(frozen=True, slots=True)
class Verification:
    """What was found in a run's folder.

    Attributes:
        folder: the run's.
        problems: a sentence for each thing that is wrong, with the file's name.
        steps: physics steps that plain MuJoCo repeated bit for bit.
        first_difference: the first physics step after which the states differ, None if none does.
        cut: what is known of a run that was cut off; None of one that has a result.
    """

    folder: Path
    problems: tuple[str, ...]
    steps: int
    first_difference: int | None
    cut: CutRun | None = None

    @property
    def passed(self) -> bool:
        """Whether nothing is wrong, and the run came to its end."""
        return not self.problems and self.cut is None


@dataclass(frozen=True, slots=True)
class _Slack:
    """What the files of a run may lack at their end because of how it ended.

    Attributes:
        ticks: control ticks by which two files may differ.
        may_break_off: whether a file may end amid a record.
    """

    ticks: float = 0
    may_break_off: bool = False


_OF_A_CUT_RUN: Final = _Slack(math.inf, may_break_off=True)
_BY_OUTCOME: Final = {
    # A tick was cut short, or the disk took no more of what waited, a second at most.
    "interrupted": _Slack(1),
    "error": _Slack(round(1.0 / TICK_SECONDS), may_break_off=True),
}


def verify(run_dirs: Iterable[Path]) -> list[Verification]:
    """Verify the folders of runs, one after the other. Nothing in them can make it fail.

    Raises:
        ShellLimitError: the shell allows too little memory to step the physics.
    """
    return [verify_run(Path(folder)) for folder in run_dirs]


def verify_run(folder: Path) -> Verification:
    """Verify the folder of one run. Of one that was cut off, what it left is looked at.

    Raises:
        ShellLimitError: the shell allows too little memory to step the physics.
    """
    if not folder.is_dir():
        return Verification(folder, (f"{folder}: there is no such run",), 0, None)
    problems: list[str] = []
    cut = cut_run(folder)
    result = _result(folder, problems) if cut is None else None
    slack = _Slack() if result is None else _BY_OUTCOME.get(result.outcome, _Slack())
    slack = slack if cut is None else _OF_A_CUT_RUN
    rows = [] if _unwritten(folder, ESTIMATE, cut) else _trajectories(folder, problems)
    begun = cut is None or in_parts(folder) or (folder / AUDIT).exists()
    ticks, difference, steps_a_tick = _audit(folder, result, problems) if begun else (None, None, 0)
    if result is not None and ticks is not None:
        simulated = round(result.simulated_seconds / _TICK)
        if abs(ticks - simulated) > slack.ticks:
            problems.append(
                f"physics.npz: {ticks} control ticks, but result.json has {simulated}: "
                "they are of different runs"
            )
    if rows and result is not None and rows[-1] > result.simulated_seconds + 1e-6:
        problems.append(f"{ESTIMATE}: goes on after the end of the run")
    if not _unwritten(folder, PICTURE, cut):
        _picture(folder, problems)
    if not _unwritten(folder, MAP, cut):
        _map(folder, problems)
    _scenario(folder, result, problems)
    _recordings(folder, result, ticks, problems, slack)
    steps = (ticks or 0) * steps_a_tick if difference is None else difference
    return Verification(folder, tuple(problems), steps, difference, cut)


def _unwritten(folder: Path, name: str, cut: CutRun | None) -> bool:
    """Say whether a file is missing because the run was cut off before it was written."""
    return cut is not None and not os.path.lexists(folder / name)


def _result(folder: Path, problems: list[str]) -> Result | None:
    try:
        result = read_result(folder / RESULT)
    except InputError as error:
        problems.append(str(error))
        return None
    named = {key: result.configuration.get(key) for key in ("name", "seed")}
    if named != {"name": result.scenario, "seed": result.seed}:
        problems.append(f"{RESULT}: scenario and seed are not those of its configuration")
    return result


def _trajectories(folder: Path, problems: list[str]) -> list[float]:
    """Return the times of the believed trajectory, s."""
    times: dict[str, list[float]] = {}
    for name in (ESTIMATE, TRUTH):
        try:
            times[name] = read_trajectory(folder / name)[:, 0].tolist()
        except InputError as error:
            problems.append(str(error))
    if len(times) == 2 and times[ESTIMATE] != times[TRUTH]:
        found = ", ".join(f"{len(rows)} poses in {name}" for name, rows in times.items())
        problems.append(f"{TRUTH}: its times are not those of {ESTIMATE} ({found})")
    return times.get(ESTIMATE, [])


def _audit(
    folder: Path, result: Result | None, problems: list[str]
) -> tuple[int | None, int | None, int]:
    """Return the control ticks in the audit, the first step that differs, and a tick's steps."""
    try:
        ticks, row, steps = replay_limited(folder)
    except InputError as error:
        problems.append(str(error))
        return None, None, 0
    if row is None:
        return ticks, None, steps
    step = (row + 1) * steps
    same_version = result is not None and result.version == __version__
    reason = likely_reason(result.processor) if result is not None and same_version else ""
    problems.append(
        f"physics.npz: plain MuJoCo comes to another state; the first that differs is after "
        f"step {step} ({(row + 1) * _TICK:.2f} s){reason and ', ' + reason}"
    )
    return ticks, step, steps


def _picture(folder: Path, problems: list[str]) -> None:
    try:
        content = read_content(folder / PICTURE, _LARGEST_PICTURE)
    except InputError as error:
        problems.append(str(error))
        return
    if not content.startswith(_PNG) or b"IEND" not in content[-12:]:
        problems.append(f"{folder / PICTURE}: is no whole PNG file")


def _map(folder: Path, problems: list[str]) -> None:
    try:
        read_map(folder / MAP)
    except InputError as error:
        problems.append(str(error))


def _scenario(folder: Path, result: Result | None, problems: list[str]) -> None:
    try:
        table = read_toml(folder / SCENARIO)
    except InputError as error:
        problems.append(str(error))
        return
    if result is not None and table != without_nothing(result.configuration):
        problems.append(f"{folder / SCENARIO}: is not the configuration in {RESULT}")


def _recordings(
    folder: Path, result: Result | None, ticks: int | None, problems: list[str], slack: _Slack
) -> None:
    """Look at what `--no-record` leaves out: both files or none."""
    observations, recording = folder / OBSERVATIONS, folder / RECORDING
    there = [os.path.lexists(path) for path in (observations, recording)]
    if not any(there):
        return
    for path, is_there in zip((observations, recording), there, strict=True):
        if not is_there and slack is not _OF_A_CUT_RUN:
            problems.append(f"{path}: is missing, though the run was recorded")
    if there[1]:
        _recording(recording, problems, slack)
    if there[0]:
        _observations(observations, result, ticks, problems, slack)


def _recording(path: Path, problems: list[str], slack: _Slack) -> None:
    try:
        whole, size = whole_length(path), path.stat().st_size
    except InputError as error:
        problems.append(str(error))
        return
    if slack.may_break_off and begins_right(path):
        return  # it may break off amid a message: what came before is read
    if whole < size or whole == 0:
        problems.append(
            f"{path}: breaks off amid a message or is no rerun recording "
            f"({whole} bytes of it are whole)"
        )


def _observations(
    path: Path, result: Result | None, ticks: int | None, problems: list[str], slack: _Slack
) -> None:
    early = slack.may_break_off
    try:
        front = read_front(path)
        header = header_of(front, path)
        count = _count(read_observations(path), early=early)
        others = Counter(m.topic for m in _whole(read_messages(path, _BESIDE), early=early))
    except BrokenLogError as error:
        if not early:  # else it was cut off before the first message
            problems.append(str(error))
        return
    except InputError as error:
        problems.append(str(error))
        return
    fewest = count - 1 if slack.ticks else count  # a tick's messages follow one another
    if CORE in front.attachments and any(not fewest <= others[t] <= count for t in _BESIDE):
        found = ", ".join(f"{others[topic]} of {topic}" for topic in _BESIDE)
        problems.append(f"{path}: {count} observations, but {found}")
    if result is not None:
        if hash_of(result.configuration) != header.get("scenario_hash"):
            problems.append(f"{path}: its scenario is not the configuration in {RESULT}")
        of_result: dict[str, Any] = {
            "scenario": result.scenario,
            "robot": result.robot,
            "seed": str(result.seed),
            "version": result.version,
            "processor": result.processor,
        }
        wrong = [key for key, value in of_result.items() if header.get(key) != value]
        if wrong:
            problems.append(f"{path}: {', '.join(wrong)} not as in {RESULT}")
    if ticks is not None and abs(count - ticks) > slack.ticks:
        problems.append(f"{path}: {count} observations, but {ticks} control ticks")


def _count(some: Iterator[object], *, early: bool) -> int:
    return sum(1 for _ in _whole(some, early=early))


def _whole(some: Iterator[Any], *, early: bool) -> Iterator[Any]:
    """Yield what a log has up to where it breaks off, which only an early end explains.

    Raises:
        InputError: the log breaks off, and nothing explains it.
    """
    try:
        yield from some
    except BrokenLogError:
        if not early:
            raise
