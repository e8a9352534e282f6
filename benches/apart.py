"""A piece of work in a process of its own, bounded: what crashes or hangs ends nothing else."""

import os
import resource
import signal
from collections.abc import Callable
from pathlib import Path

MOST_MEMORY = 1 << 30
FAULT = "FAULT"


def apart(work: Callable[[], str], seconds: int, memory: int = MOST_MEMORY) -> str:
    """Return what a piece of work says of itself; what ended it, behind FAULT, where it cannot.

    Args:
        work: done in a child.
        seconds: of the processor's time that it may take; of the wall clock twenty times as many.
        memory: bytes that it may take beyond what this process has.
    """
    there, here = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(there)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
        # What the package starts with a limit of its own may raise this one again.
        hard = resource.getrlimit(resource.RLIMIT_AS)[1]
        resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + memory, hard))
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
        signal.alarm(20 * seconds)  # who waits for nothing uses no time either
        os.write(here, work().encode(errors="replace")[:60_000])
        os._exit(0)
    os.close(here)
    with os.fdopen(there, "rb") as said:
        text = said.read().decode(errors="replace")
    _, status = os.waitpid(child, 0)
    return text or f"{FAULT} ended by signal {-os.waitstatus_to_exitcode(status)}"
