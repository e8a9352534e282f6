"""Worker processes that are used again and replaced when they die: isolation without the price."""

import os
import signal
import sys
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass, field
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from typing import Any, Final, Self

from treadwell.workers.answers import Answer, Died
from treadwell.workers.child import BEGUN, serve
from treadwell.workers.log import WorkerLog

START_SECONDS: Final = 300.0
"""Within which a new process has to be ready to work, on however busy a machine."""
_LONGEST_WAIT: Final = 1.0
_JOIN_SECONDS: Final = 5.0
_TAIL: Final = 300


@dataclass(frozen=True, slots=True)
class Limits:
    """What one piece of work may take.

    Attributes:
        seconds: of the clock; None: as many as it likes.
        memory: bytes of address space on top of what the process has; None: as many as it likes.
    """

    seconds: float | None = None
    memory: int | None = None


@dataclass(slots=True)
class _Task:
    item: Any
    limits: Limits
    fresh: bool


@dataclass(slots=True)
class _Worker:
    """One process, and what it is doing."""

    process: SpawnProcess
    connection: Connection
    log: WorkerLog
    task: _Task | None = None
    used: bool = False
    begun: bool = False
    deadline: float | None = field(default=None)

    def give(self, task: _Task) -> None:
        """Send a task."""
        self.task, self.used, self.begun = task, True, False
        self.deadline = time.monotonic() + START_SECONDS
        with suppress(OSError):  # it died: found out by who waits for it
            self.connection.send((task.item, task.limits.memory))

    def listen(self) -> Answer | None:
        """Return the answer where there is one; None when it goes on."""
        try:
            while self.connection.poll():
                heard = self.connection.recv()
                if heard != BEGUN:
                    return heard  # type: ignore[no-any-return]
                self.begun = True
                seconds = self.task.limits.seconds if self.task else None
                self.deadline = None if seconds is None else time.monotonic() + seconds
        except (EOFError, OSError):
            return self._death()
        if self.process.exitcode is not None:
            return self._death()
        if self.deadline is not None and time.monotonic() > self.deadline:
            self.end()
            seconds = self.task.limits.seconds if self.task and self.begun else None
            return Died(f"took longer than {seconds or START_SECONDS:g} s", timed_out=True)
        return None

    def end(self) -> None:
        """End the process, and all that it started, at once."""
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self.process.pid or 0, signal.SIGKILL)
        self.process.kill()
        self.process.join()
        self.connection.close()
        self.log.close()

    def _death(self) -> Died:
        self.process.join(_JOIN_SECONDS)
        how = _how(self.process.exitcode) + _tail(self.log)
        self.end()
        return Died(how)


class Pool:
    """Does pieces of work in processes of its own, so many at a time; a context manager.

    A process is used again after its work; one that died, took too long or was asked to be fresh
    is replaced. Nothing that a piece of work does, short of filling the disk, reaches this process
    or the others. To be made in the main thread: the processes end with the thread that made them.
    """

    def __init__(self, work: Callable[[Any], Any], count: int, *, program: bool = True) -> None:
        """Start nothing yet.

        Args:
            work: a function of a module, called with each item in another process.
            count: processes at a time.
            program: whether each process imports the program that runs, which has to be where work
                or items are of its; a script would then need `if __name__ == "__main__":`.
        """
        self._work, self._count, self._program = work, count, program
        # A fresh interpreter each: a fork would copy the threads of the simulator's libraries half.
        self._context = get_context("spawn")
        self._waiting: deque[_Task] = deque()
        self._workers: list[_Worker] = []

    def __enter__(self) -> Self:
        """Begin."""
        return self

    def __exit__(self, *raised: object) -> None:
        """End all processes, whatever they are doing."""
        for worker in self._workers:
            worker.end()
        self._workers.clear()

    def submit(
        self,
        item: object,
        limits: Limits | None = None,
        *,
        fresh: bool = False,
        next_: bool = False,
    ) -> None:
        """Ask for a piece of work; it is begun when `answers` is gone through.

        Args:
            item: what the work is done with; goes by pickle.
            limits: what it may take.
            fresh: in a process that did nothing before, and does nothing after.
            next_: before all that waits already.
        """
        task = _Task(item, limits or Limits(), fresh)
        if next_:
            self._waiting.appendleft(task)
        else:
            self._waiting.append(task)

    def answers(self) -> Iterator[tuple[Any, Answer]]:
        """Yield each item with what came of it, as it comes, until nothing is left to do.

        More may be submitted meanwhile.
        """
        while True:
            self._hand_out()
            busy = [worker for worker in self._workers if worker.task is not None]
            if not busy:
                return
            heard = self._heard(busy)
            # All that ended leave before anything is handed out: one that is on its way out, and
            # looks idle, would be given work that ends with it.
            for worker, task, answer in heard:
                if isinstance(answer, Died):
                    self._workers.remove(worker)
                elif task.fresh:
                    self._retire(worker)
            self._hand_out()
            for _, task, answer in heard:
                yield task.item, answer

    def _heard(self, busy: list[_Worker]) -> list[tuple[_Worker, _Task, Answer]]:
        """Wait for something to happen; return who has finished."""
        watched: list[Any] = [one for w in busy for one in (w.connection, w.process.sentinel)]
        wait(watched, self._patience(busy))
        found = []
        for worker in busy:
            answer = worker.listen()
            if answer is not None and worker.task is not None:
                found.append((worker, worker.task, answer))
                worker.task, worker.deadline = None, None
        return found

    @staticmethod
    def _patience(busy: list[_Worker]) -> float:
        deadlines = [worker.deadline for worker in busy if worker.deadline is not None]
        least = min(deadlines, default=float("inf")) - time.monotonic()
        return min(_LONGEST_WAIT, max(0.0, least))

    def _hand_out(self) -> None:
        """Give what waits to who is free."""
        while self._waiting:
            worker = self._free(fresh=self._waiting[0].fresh)
            if worker is None:
                return
            worker.give(self._waiting.popleft())

    def _free(self, *, fresh: bool) -> _Worker | None:
        """Return a process that can take work, a new one where there is room; None where not."""
        for worker in [w for w in self._workers if w.task is None and not w.process.is_alive()]:
            self._retire(worker)  # it ended between two pieces of work, which is nobody's fault
        idle = [worker for worker in self._workers if worker.task is None]
        fitting = [worker for worker in idle if not (fresh and worker.used)]
        if fitting:
            return fitting[0]
        if len(self._workers) >= self._count:
            if not idle:
                return None
            self._retire(idle[0])
        return self._start()

    def _start(self) -> _Worker:
        ours, theirs = self._context.Pipe()
        log = WorkerLog()
        process = self._context.Process(
            target=serve, args=(theirs, self._work, log, os.getpid()), daemon=False
        )
        with nullcontext() if self._program else _without_program():
            process.start()
        theirs.close()
        worker = _Worker(process, ours, log)
        self._workers.append(worker)
        return worker

    def _retire(self, worker: _Worker) -> None:
        if worker in self._workers:
            self._workers.remove(worker)
        worker.end()


@contextmanager
def _without_program() -> Iterator[None]:
    """Let a process that is started meanwhile not import the program that runs."""
    main = sys.modules["__main__"]
    names = vars(main)
    kept: dict[str, Any] = {one: names[one] for one in ("__spec__", "__file__") if one in names}
    try:
        names.pop("__file__", None)
        names["__spec__"] = None
        yield
    finally:
        names.update(kept)


def _how(status: int | None) -> str:
    """Return how a process ended, by its exit code."""
    if status is None:
        return "its connection ended"
    if status >= 0:
        return f"its process ended with status {status}"
    try:
        name = signal.Signals(-status).name
    except ValueError:
        name = "?"
    hint = ", out of memory?" if -status == signal.SIGKILL else ""
    return f"its process was ended by signal {-status} ({name}{hint})"


def _tail(log: WorkerLog) -> str:
    """Return the last that a process wrote that tells something, with a colon before it."""
    telling = [" ".join(line.split()) for line in log.tail() if line.strip()]
    # Of faulthandler's lines the first says what, the others where.
    fatal = [line for line in telling if line.startswith(("Fatal", "memory allocation"))]
    chosen = fatal[-1:] or telling[-1:]
    return f": {chosen[0][:_TAIL]}" if chosen else ""
