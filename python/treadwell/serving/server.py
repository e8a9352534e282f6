"""The server: one client after the other, each with a core of its own; what goes wrong is one line.

Every message of a client gets one answer: hello for hello, targets for an observation, goodbye for
goodbye, and an error, with which the connection ends, for everything else.
"""

import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final

from treadwell.errors import TreadwellError
from treadwell.guard import GuardedCore
from treadwell.scenario.messages import shown
from treadwell.serving.connection import Address, Connection, listener_of
from treadwell.serving.framing import Message, ProtocolError
from treadwell.serving.protocol import (
    GOODBYE,
    OBSERVATION,
    check_keys,
    kind_of,
    observation_of,
    targets_message,
)
from treadwell.serving.served import ServedRobot

TIMEOUT_S: Final = 10.0
"""Within this a client's next message must have come, where nobody says otherwise."""

Say = Callable[[str], None]


@dataclass(slots=True)
class Attended:
    """How it went with a client.

    Attributes:
        ticks: observations that were answered.
        time_ns: of the last one.
        state: the behaviour's, at the last one.
        outcome: what the core declared.
        reason: why it refused.
        error: what ended it; None: the client said goodbye.
    """

    ticks: int = 0
    time_ns: int = 0
    state: str | None = None
    outcome: str | None = None
    reason: str | None = None
    error: TreadwellError | None = None

    def document(self) -> dict[str, Any]:
        """Return it as plain data."""
        return {
            "ticks": self.ticks,
            "time": 1e-9 * self.time_ns,
            "state": self.state,
            "outcome": self.outcome,
            "reason": self.reason,
            "error": None if self.error is None else str(self.error),
        }

    def sentence(self) -> str:
        """Return it in one line."""
        after = f"{self.ticks} ticks ({1e-9 * self.time_ns:.2f} s, {self.state or 'no state'})"
        if self.error is not None:
            return f"error: {self.error} (after {after})"
        return f"goodbye after {after}: {self.reason or self.outcome or 'nothing declared'}"


@contextmanager
def listening(address: Address) -> Iterator[tuple[socket.socket, Address]]:
    """Give a listening socket, and where it listens; its file is removed at the end.

    Raises:
        InputError: it cannot listen there.
    """
    with listener_of(address) as listener:
        if isinstance(address, int):
            yield listener, int(listener.getsockname()[1])
            return
        path = Path(address).absolute()
        own = path.stat().st_ino
        try:
            yield listener, address
        finally:
            with suppress(OSError):  # somebody was quicker
                if path.stat().st_ino == own:
                    path.unlink()


def attend_all(
    listener: socket.socket, served: ServedRobot, timeout_s: float, say: Say, *, once: bool
) -> Attended:
    """Attend to one client after the other, without end, or to the first one alone.

    Who connects and leaves without a word is no client: so another server looks whether one is
    there.

    Args:
        listener: listens.
        served: the robot.
        timeout_s: s, within which a client's next message must have come.
        say: is told a line for the user.
        once: return how it went with the first one.
    """
    number = 1
    while True:
        try:
            opened, _ = listener.accept()
        except ConnectionAbortedError:
            continue
        with Connection(opened, timeout_s) as connection:
            attended = attend(connection, served, partial(_say, say, number))
        if attended is not None:
            if once:
                return attended
            number += 1


def _say(say: Say, number: int, line: str) -> None:
    say(f"client {number}: {line}")


def attend(connection: Connection, served: ServedRobot, say: Say) -> Attended | None:
    """Attend to a client until it ends.

    Args:
        connection: to the client.
        served: the robot.
        say: is told a line for the user.

    Returns:
        How it went; None of one that left without a word.
    """
    attended = Attended()
    try:
        first = connection.receive()
        if first is None:
            return None
        core = served.core(first)
        connection.send(served.hello())
        say(f"hello, {served.robot.name}")
        while _answer(connection, served, core, attended):
            pass
    except TreadwellError as error:
        attended.error = error
        connection.send_error(str(error))
    except KeyboardInterrupt:
        connection.send_error("the server was ended")
        raise
    say(attended.sentence())
    return attended


def _answer(
    connection: Connection, served: ServedRobot, core: GuardedCore, attended: Attended
) -> bool:
    """Answer the next message, and return whether there may be another."""
    message = connection.receive()
    if message is None:
        raise ProtocolError("the connection ended without a goodbye")
    kind = kind_of(message)
    if kind == GOODBYE:
        check_keys(message, (), ())
        connection.send({"type": GOODBYE})
        return False
    if kind != OBSERVATION:
        raise ProtocolError(
            f"a message's type: found {shown(kind)}; must be {OBSERVATION} or {GOODBYE} now"
        )
    _tick(connection, message, served, core, attended)
    return True


def _tick(
    connection: Connection,
    message: Message,
    served: ServedRobot,
    core: GuardedCore,
    attended: Attended,
) -> None:
    observation = observation_of(message, served.shapes)
    now = observation.time_ns
    if attended.ticks and now <= attended.time_ns:
        raise ProtocolError(
            f"{OBSERVATION}: time_ns: found {now}; must be later than {attended.time_ns}"
        )
    tick = core.tick(observation)
    attended.ticks, attended.time_ns, attended.state = attended.ticks + 1, now, tick.state
    attended.outcome, attended.reason = tick.outcome, tick.reason
    connection.send(*targets_message(now, tick, core.pilot.goals_passed))
