"""What the shell that started this process lets it take: `ulimit`."""

import resource
from typing import Final

RECORDED_RUN: Final = 3_000_000_000
"""Bytes of address space, most of it the unused stacks of rerun's threads."""


def address_space() -> int | None:
    """Return the bytes of address space that this process may have; None: without limit."""
    return _least(resource.RLIMIT_AS)


def within(limit: int, wanted: int) -> int:
    """Return what is wanted of a resource of this process, or as much as may be had.

    Args:
        limit: the resource, one of Python's `RLIMIT_...`.
        wanted: bytes or seconds.
    """
    least = _least(limit)
    return wanted if least is None else min(wanted, least)


def tightness(memory_bytes: int) -> str:
    """Return a clause that says that less memory is allowed than is needed; empty where it is not.

    Args:
        memory_bytes: of address space, that are enough.
    """
    allowed = address_space()
    if allowed is None or allowed >= memory_bytes:
        return ""
    return (
        f"this shell allows {allowed / 1e9:.1f} GB of memory (ulimit -v), "
        f"and {memory_bytes / 1e9:.1f} GB may be needed"
    )


def _least(limit: int) -> int | None:
    """Return the lower of a resource's soft and hard limit."""
    finite = [one for one in resource.getrlimit(limit) if one != resource.RLIM_INFINITY]
    return min(finite, default=None)
