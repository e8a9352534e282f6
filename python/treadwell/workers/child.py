"""The side of a worker process: it does what it is sent, within its limits, and says what came."""

import ctypes
import faulthandler
import os
import pickle
import resource
import signal
import sys
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Final

from treadwell.errors import TreadwellError
from treadwell.workers.answers import Done, Raised
from treadwell.workers.log import WorkerLog

BEGUN: Final = "begun"
"""What is sent before the work begins: from then on its time counts."""
LOST: Final = 4
"""Exit status of a worker whose parent is gone."""
_DEATH_SIGNAL: Final = 1  # PR_SET_PDEATHSIG of Linux
_LONGEST_REASON: Final = 500


def serve(connection: Connection, work: Callable[[Any], Any], log: WorkerLog, parent: int) -> None:
    """Do one piece of work after the other until the connection ends.

    Args:
        connection: brings pairs (item, bytes of memory that it may take on top, or None), and
            takes `BEGUN` and an answer for each.
        work: what is done with an item.
        log: takes what anything in this process writes to its standard output and error.
        parent: the process's id that started this one.
    """
    _leave_with(parent)
    log.take_output()
    faulthandler.enable(2)
    while True:
        try:
            item, memory = connection.recv()
        except (EOFError, OSError):
            return
        log.clear()
        connection.send(BEGUN)
        _limit_memory(memory)
        answer = _answer(work, item)
        _limit_memory(None)
        try:
            connection.send(answer)
        except (pickle.PicklingError, TypeError, AttributeError) as error:
            connection.send(Raised(one_line(error)))


def one_line(error: BaseException) -> str:
    """Return an error's type and text on one line."""
    text = " ".join(str(error).split())[:_LONGEST_REASON]
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def _answer(work: Callable[[Any], Any], item: object) -> Done | Raised:
    try:
        return Done(work(item))
    except TreadwellError as error:
        return Raised(" ".join(str(error).split()), error)
    except MemoryError as error:
        return Raised(f"out of memory: {one_line(error)}")
    except (Exception, SystemExit) as error:
        return Raised(one_line(error))


def _leave_with(parent: int) -> None:
    """Make sure that this process does not outlive the one that started it, kill -9 or not."""
    # A group of its own: Ctrl-C is the parent's, and a kill reaches what a user's part started.
    os.setsid()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_DEATH_SIGNAL, signal.SIGKILL, 0, 0, 0)
    if os.getppid() != parent:  # it went before that was arranged
        os._exit(LOST)


def _limit_memory(more: int | None) -> None:
    """Let this process's address space grow by so many bytes and no more; None: without limit."""
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    limit = hard
    if more is not None:
        limit = _address_space() + more
        if hard != resource.RLIM_INFINITY:
            limit = min(limit, hard)
    resource.setrlimit(resource.RLIMIT_AS, (limit, hard))


def _address_space() -> int:
    """Return the bytes of address space that this process has; 0 where it cannot be known."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[0])
    except OSError:
        return 0
    return pages * resource.getpagesize()
