"""Pieces of work in processes of their own, with what came of them in the order of the pieces."""

import sys
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

from treadwell.errors import SimulationError
from treadwell.workers.answers import Answer, Done, Raised
from treadwell.workers.pool import Pool


def side_by_side(
    work: Callable[[Any], Any],
    items: Sequence[Any],
    workers: int,
    told: Callable[[int, Any], str],
    *,
    fresh: bool = False,
) -> Iterator[Any]:
    """Yield what came of each piece, in order, up to an interruption.

    Args:
        work: a function of a module.
        items: what it is called with; they go by pickle.
        workers: processes at a time.
        told: makes the line that is told of a piece, of its number and what came of it.
        fresh: each piece in a process that did nothing before.

    Raises:
        TreadwellError: a piece could not be done.
        SimulationError: a process died.
    """
    waiting: dict[int, Any] = {}
    following = 0
    with Pool(partial(_numbered, work), workers) as pool:
        for numbered in enumerate(items):
            pool.submit(numbered, fresh=fresh)
        try:
            for (number, _), answer in pool.answers():
                waiting[number] = _value(answer)
                while following in waiting:
                    done = waiting.pop(following)
                    tell(told(following, done))
                    following += 1
                    yield done
        except KeyboardInterrupt:
            pass


def tell(line: str) -> None:
    """Write a line to standard error at once."""
    sys.stderr.write(line.rstrip() + "\n")
    sys.stderr.flush()


def _numbered(work: Callable[[Any], Any], numbered: tuple[int, Any]) -> Any:  # noqa: ANN401
    return work(numbered[1])


def _value(answer: Answer) -> Any:  # noqa: ANN401 - whatever the work returns
    if isinstance(answer, Done):
        return answer.value
    if isinstance(answer, Raised):
        raise answer.error or SimulationError(answer.reason)
    raise SimulationError(f"a process of the experiment failed: {answer.reason}")
