"""A sweep's folder: whose it is, what is thrown away, and what its rows say of the recordings."""

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Self

import pytest
from sweep_builders import short

from treadwell.errors import RecordingError
from treadwell.sweeps.conduct import Care, conduct
from treadwell.sweeps.job import Job
from treadwell.sweeps.request import Request, crossed
from treadwell.sweeps.row import Row
from treadwell.workers.answers import Answer, Died, Done, Raised


class Told:
    """An engine that is told what comes of a job, without a recording and with one."""

    def __init__(self, plain: Callable[[Job], Answer], recorded: Callable[[Job], Answer]) -> None:
        self._how, self._jobs = (plain, recorded), deque[Job]()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def submit(self, item: Any, *_: object, **__: object) -> None:  # noqa: ANN401
        self._jobs.append(item)

    def answers(self) -> Iterator[tuple[Job, Answer]]:
        while self._jobs:
            job = self._jobs.popleft()
            yield job, Done(None) if job.check else self._how[job.folder is not None](job)


def passed(job: Job) -> Done:
    if job.folder is not None:
        job.folder.mkdir()
    key = job.key
    row = Row(key.scenario, key.robot, key.variant, key.seed, "goal_reached", digest="good")
    return Done(replace(row, passed=True, success=True))


def fell(job: Job) -> Done:
    return Done(replace(passed(job).value, outcome="fell", success=False, digest="bad"))


def died(_: Job) -> Died:
    return Died("out of memory?")


def full(_: Job) -> Raised:
    return Raised("no space", RecordingError("no space"))


def asked(tmp_path: Path, seeds: int = 1) -> Request:
    return crossed([short(tmp_path)], seeds=range(seeds))


def first_row(
    tmp_path: Path, plain: Callable[[Job], Answer], recorded: Callable[[Job], Answer]
) -> dict[str, Any]:
    told = conduct(
        asked(tmp_path), tmp_path / "out", lambda: Told(plain, recorded), care=Care(keep=0)
    )
    row: dict[str, Any] = told["episodes"][0]
    return row


@pytest.mark.parametrize(
    ("plain", "recorded", "reproduced"),
    [
        (passed, fell, None),
        (fell, fell, True),
        (fell, passed, False),
        (fell, died, False),
        (died, passed, False),
        (died, died, None),
    ],
)
def test_a_recording_that_went_another_way_is_complained_of(
    tmp_path: Path,
    plain: Callable[[Job], Answer],
    recorded: Callable[[Job], Answer],
    reproduced: bool | None,
) -> None:
    assert first_row(tmp_path, plain, recorded)["reproduced"] is reproduced


def test_a_disk_that_is_full_for_the_recording_stops_the_sweep_and_loses_nothing(
    tmp_path: Path,
) -> None:
    with pytest.raises(RecordingError, match="no space"):
        first_row(tmp_path, fell, full)
    assert first_row(tmp_path, fell, fell)["reproduced"]


def test_what_is_not_the_sweeps_stays_when_it_goes_on(tmp_path: Path) -> None:
    out, engine = tmp_path / "out", lambda: Told(passed, passed)
    conduct(asked(tmp_path), out, engine, care=Care(keep=1))
    mine = out / "episodes" / "short-qrio-0-replay"
    mine.mkdir()
    half_done = out / "episodes" / "short-qrio-1"
    half_done.mkdir()
    (half_done / "half").write_text("")
    conduct(asked(tmp_path, seeds=2), out, engine, care=Care(keep=1))
    assert mine.is_dir()
    assert (out / "episodes" / "short-qrio-0").is_dir()
    assert not half_done.exists()
