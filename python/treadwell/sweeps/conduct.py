"""Conducts a sweep: every episode once, its row in the journal, its recording where it failed."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final, Protocol

from treadwell.errors import InputError, RecordingError
from treadwell.sweeps.engine import Engine
from treadwell.sweeps.folder import SweepFolder
from treadwell.sweeps.job import Job
from treadwell.sweeps.request import Key, Line, Request
from treadwell.sweeps.row import Row, error_row
from treadwell.sweeps.summary import results_document
from treadwell.workers.answers import Answer, Died, Done, Raised
from treadwell.workers.pool import Limits

GIGABYTE: Final = 10**9
RECORDING_MEMORY: Final = 4 * GIGABYTE
"""Address space that the recorder's threads reserve, and do not use."""
CHECKS: Final = 3
"""Seeds of a line of which one at least has to give an episode that can be built."""


class Progress(Protocol):
    """Is told how a sweep gets on."""

    def update(self, done: int, successes: int, row: Row | None) -> None:
        """Show it: episodes done and successes so far, and the last row."""
        ...


@dataclass(frozen=True, slots=True)
class Care:
    """How a sweep treats its episodes.

    Attributes:
        seconds: of the clock that one may take.
        memory: bytes that one may take.
        keep: so many of each line's first seeds are recorded, and kept where they succeed.
    """

    seconds: float = 600.0
    memory: int = 4 * GIGABYTE
    keep: int = 3

    def limits(self, job: Job) -> Limits:
        """Return a job's limits."""
        more = RECORDING_MEMORY if job.folder is not None else 0
        return Limits(self.seconds, self.memory + more)


def conduct(
    request: Request,
    out: Path,
    engine: Callable[[], Engine],
    *,
    care: Care | None = None,
    progress: Progress | None = None,
    command: str = "",
    told: Callable[[str], None] | None = None,
) -> dict[str, Any]:
    """Do what is left of a sweep, write its results, and return them.

    Args:
        request: what is asked for.
        out: the folder; of a sweep that was stopped, it goes on where it was.
        engine: makes what does the episodes; it is only made where something is left to do.
        care: limits, and what is kept.
        progress: is told of each episode.
        command: what asks for the same again; stands in the results.
        told: is given a sentence on each class in Python that was edited since the sweep began.

    Raises:
        InputError: the folder cannot be taken, or no episode of a line can be built.
        RecordingError: the folder cannot be written; what was done before is kept.
        KeyboardInterrupt: interrupted; the same call goes on.
    """
    with SweepFolder(out, request) as folder:
        for edited in folder.edited:
            if told is not None:
                told(edited.sentence)
        sweep = _Sweep(request, folder, care or Care(), progress)
        if sweep.todo:
            with engine() as made:
                sweep.check(made)
                sweep.run(made)
        document = results_document(request, folder.ordered(), command)
        folder.finish(document)
    return document


class _Sweep:
    """One sweep that is being done."""

    def __init__(
        self, request: Request, folder: SweepFolder, care: Care, progress: Progress | None
    ) -> None:
        self._request, self._folder = request, folder
        self._care, self._progress = care, progress
        done, asked = {row.key for row in folder.rows}, request.keys()
        self.todo = [key for key in asked if key not in done]
        self._first: dict[Key, Row] = {}  # rows that wait for their recording
        self._tell(None)

    def check(self, engine: Engine) -> None:
        """Find out whether what the user gave can be built, before much is run.

        Raises:
            InputError: of some line nothing can.
        """
        # Of a line that has a row it was found out when that was done.
        known = {self._request.line_of(row.key) for row in self._folder.rows}
        for number in dict.fromkeys(self._request.line_of(key) for key in self.todo):
            if number in known:
                continue
            self._submit(engine, self._checked(self._request.lines[number], 0))
        for job, answer in engine.answers():
            number = self._request.line_of(job.key)
            line = self._request.lines[number]
            bad = answer.error if isinstance(answer, Raised) else None
            if not isinstance(bad, InputError):
                continue
            tried = line.seeds.index(job.key.seed) + 1
            if tried >= min(CHECKS, len(line.seeds)):
                raise bad
            self._submit(engine, self._checked(line, tried), next_=True)

    def run(self, engine: Engine) -> None:
        """Do every episode that is left.

        Raises:
            RecordingError: the folder cannot be written.
        """
        for key in self.todo:
            self._submit(engine, self._job(key, record=self._in_sample(key)))
        for job, answer in engine.answers():
            again = self._settle(job, answer)
            if again is not None:
                self._submit(engine, again, next_=True)

    def _settle(self, job: Job, answer: Answer) -> Job | None:
        """Take what came of a job; return the job that records what failed, where it is needed."""
        key = job.key
        before = self._first.pop(key, None)
        if before is not None:
            if isinstance(answer, Raised) and isinstance(answer.error, RecordingError):
                raise answer.error
            self._finish(_compared(before, answer), keep=True)
            return None
        row = _row(key, answer)
        if row.success or job.folder is not None or not _worth_recording(answer):
            self._finish(row, keep=job.folder is not None)
            return None
        # Episodes are the same every time: only what failed is recorded, by running it again.
        self._first[key] = row
        return self._job(key, record=True)

    def _finish(self, row: Row, *, keep: bool) -> None:
        if keep:
            row = replace(row, folder=self._folder.keep(row.key))
        self._folder.append(row)
        self._tell(row)

    def _tell(self, row: Row | None) -> None:
        if self._progress is not None:
            rows = self._folder.rows
            self._progress.update(len(rows), sum(one.success for one in rows), row)

    def _in_sample(self, key: Key) -> bool:
        line = self._request.lines[self._request.line_of(key)]
        return key.seed in line.seeds[: self._care.keep]

    def _job(self, key: Key, *, record: bool) -> Job:
        line = self._request.lines[self._request.line_of(key)]
        place = self._folder.place(key) if record else None
        return Job(key, line.file, line.robot_given, line.settings, place)

    @staticmethod
    def _checked(line: Line, number: int) -> Job:
        return Job(line.keys()[number], line.file, line.robot_given, line.settings, check=True)

    def _submit(self, engine: Engine, job: Job, *, next_: bool = False) -> None:
        # What a user's class keeps from one episode to the next must not change a result.
        foreign = bool(self._request.lines[self._request.line_of(job.key)].parts)
        engine.submit(job, self._care.limits(job), fresh=foreign, next_=next_)


def _row(key: Key, answer: Answer) -> Row:
    """Return the row of what came of an episode.

    Raises:
        RecordingError: it could not be written, which is no fault of the episode.
    """
    if isinstance(answer, Done):
        row: Row = answer.value
        return row
    if isinstance(answer, Raised) and isinstance(answer.error, RecordingError):
        raise answer.error
    return error_row(key, f"error: {answer.reason}")


def _worth_recording(answer: Answer) -> bool:
    """Say whether a failure would leave a recording: not what hangs, nor what cannot be built."""
    if isinstance(answer, Raised):
        return not isinstance(answer.error, InputError)
    return not (isinstance(answer, Died) and answer.timed_out)


def _compared(before: Row, answer: Answer) -> Row:
    """Return the row with whether the run for the recording went the same way."""
    again = answer.value.digest if isinstance(answer, Done) else None
    if again is None and before.digest is None:
        return before  # both came to no result
    return replace(before, reproduced=again == before.digest)
