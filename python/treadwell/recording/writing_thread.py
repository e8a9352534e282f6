"""A thread that writes what a run hands over, in order; a slow disk makes the run wait for it."""

from collections.abc import Callable
from queue import Queue
from threading import Thread
from typing import Final

_MOST_JOBS: Final = 2
"""Jobs that may wait: more would be lost where the process is killed, and take memory."""


class WritingThread:
    """Does one job after the other. The first error of a job is raised once, where the run asks."""

    def __init__(self) -> None:
        """Start it; it keeps no process from ending."""
        self._jobs: Queue[Callable[[], None] | None] = Queue(_MOST_JOBS)
        self._error: Exception | None = None
        self._told = False
        self._thread = Thread(target=self._work, name="recording", daemon=True)
        self._thread.start()

    def do(self, job: Callable[[], None]) -> None:
        """Hand over a job; wait where too many wait already.

        Raises:
            Exception: what an earlier job raised, if nobody was told; this one is done, too.
        """
        self._jobs.put(job)
        self._tell()

    def close(self) -> None:
        """Wait until all jobs are done, and end the thread.

        Raises:
            Exception: what a job raised, if nobody was told.
        """
        if self._thread.is_alive():
            self._jobs.put(None)
            self._thread.join()
        self._tell()

    def _tell(self) -> None:
        if self._error is not None and not self._told:
            self._told = True
            raise self._error

    def _work(self) -> None:
        while (job := self._jobs.get()) is not None:
            try:
                job()
            except Exception as error:  # whatever it is, the run is to end by it
                # The jobs to come are done all the same: one file may be whole, another not.
                self._error = self._error or error
