"""Stands between the core and a component of the user's: times its calls, remembers its failure."""

import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from treadwell._core import Pilot, Tick
from treadwell.call_limit import CallLimit, CallTimeoutError
from treadwell.errors import CoreError
from treadwell.observation import Observation
from treadwell.plugins import METHODS, OPTIONAL


class Guard:
    """A component in whose place the core calls this.

    Attributes:
        slot: what the component is.
        name: what it is called in an error.
        component: the user's object.
        error: what its last call raised; None while all is well.
    """

    def __init__(self, slot: str, name: str, component: object, limit_s: float) -> None:
        """Take a component that has its protocol's methods, and seconds that a call may take."""
        self.slot = slot
        self.name = name
        self.component = component
        self.error: BaseException | None = None
        limit = CallLimit(limit_s)
        # An attribute of that name which is no method is the component's own affair.
        asked = OPTIONAL.get(slot, ())
        own = (method for method in asked if callable(getattr(component, method, None)))
        for method in (*METHODS[slot], *own):
            setattr(self, method, self._guarded(getattr(component, method), limit))

    def _guarded(self, method: Callable[..., Any], limit: CallLimit) -> Callable[..., Any]:
        def call(*arguments: object) -> object:
            try:
                with limit:
                    return method(*arguments)
            except BaseException as error:
                self.error = error
                raise

        return call

    def blame(self, error: CoreError) -> CoreError:
        """Return the core's error with the component's name, and the place in the user's file.

        Raises:
            KeyboardInterrupt: it was Ctrl-C that came amid a call.
        """
        if isinstance(self.error, KeyboardInterrupt):
            raise self.error
        sentence = str(error).removeprefix(f"{self.slot}: ")
        if isinstance(self.error, CallTimeoutError):
            sentence = f"{self.error} (navigation.call_limit)"
        return CoreError(f"{self.slot}: {self.name}: {sentence}{self._place()}")

    def _place(self) -> str:
        """Return where the exception was raised: the innermost line of it."""
        trace = None if self.error is None else self.error.__traceback__
        frames = [f for f in traceback.extract_tb(trace) if f.filename not in _OWN]
        return f", {Path(frames[-1].filename).name}:{frames[-1].lineno}" if frames else ""


_OWN = frozenset({__file__, CallLimit.__exit__.__code__.co_filename})
"""The harness's own files, which are not to blame."""


@dataclass(frozen=True, slots=True, eq=False)
class GuardedCore:
    """A core, and what stands between it and the user's components."""

    pilot: Pilot
    guards: dict[str, Guard]

    def tick(self, observation: Observation) -> Tick:
        """Return the core's answer; an error has the name of the component that is its cause."""
        try:
            return self.pilot.tick(observation)
        except CoreError as error:
            raise blamed(error, self.guards) from error


def blamed(error: CoreError, guards: dict[str, Guard]) -> CoreError:
    """Return the core's error; with a name, where a component of the user's is its cause."""
    guard = guards.get(str(error).partition(":")[0])
    if guard is None:
        return error
    named = guard.blame(error)
    named.__cause__ = guard.error
    return named
