"""Where the episodes of a sweep are done: what every engine can, and the one of this machine."""

from collections.abc import Iterator
from typing import Any, Protocol, Self

from treadwell.sweeps.job import do
from treadwell.workers.answers import Answer
from treadwell.workers.pool import Limits, Pool


class Engine(Protocol):
    """Does jobs side by side; see `Pool`, whose verbs these are."""

    def __enter__(self) -> Self:
        """Begin."""
        ...

    def __exit__(self, *raised: object) -> None:
        """End all that is being done."""
        ...

    def submit(
        self,
        item: object,
        limits: Limits | None = None,
        *,
        fresh: bool = False,
        next_: bool = False,
    ) -> None:
        """Ask for a job."""
        ...

    def answers(self) -> Iterator[tuple[Any, Answer]]:
        """Yield each job with what came of it, as it comes, until nothing is left to do."""
        ...


def local_engine(workers: int) -> Engine:
    """Return the engine that does the jobs in processes of this machine."""
    return Pool(do, workers, program=False)
