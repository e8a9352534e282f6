"""What came of a piece of work that was done in another process."""

from dataclasses import dataclass
from typing import Any

from treadwell.errors import TreadwellError


@dataclass(frozen=True, slots=True)
class Done:
    """It was done.

    Attributes:
        value: what the work returned.
    """

    value: Any


@dataclass(frozen=True, slots=True)
class Raised:
    """It raised; the process lives on.

    Attributes:
        reason: the error's type and text, one line.
        error: itself, where it is one of treadwell's.
    """

    reason: str
    error: TreadwellError | None = None


@dataclass(frozen=True, slots=True)
class Died:
    """Its process ended, or was ended because it took too long.

    Attributes:
        reason: how, one line, with the last that it wrote.
        timed_out: whether it took too long.
    """

    reason: str
    timed_out: bool = False


Answer = Done | Raised | Died
