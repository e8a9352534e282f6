"""The other side, for robots whose software is Python: `Client`."""

from collections.abc import Mapping
from types import TracebackType
from typing import Any, Final, Self

import numpy as np

from treadwell.errors import InputError
from treadwell.observation import Observation
from treadwell.scenario.messages import shown
from treadwell.serving.connection import Address, connected
from treadwell.serving.framing import Message, ProtocolError
from treadwell.serving.protocol import (
    ERROR,
    GOODBYE,
    HELLO,
    STATIC_MAP,
    TARGETS,
    VERSION,
    Targets,
    kind_of,
    observation_message,
    targets_of,
)

TIMEOUT_S: Final = 30.0
"""Within this the server must have answered, where nobody says otherwise: a plan may take long."""


class Client:
    """A connection to `treadwell serve`: say hello, then hand over one observation a tick.

    >>> with Client(Path("core.sock"), goal={"position": [2.0, 0.0]}) as core:
    ...     targets = core.tick(observation)

    Attributes:
        robot: what the server says of the robot: the header of its hello.
    """

    def __init__(
        self,
        address: Address,
        *,
        goal: Mapping[str, Any],
        start: Mapping[str, Any] | None = None,
        navigation: Mapping[str, Any] | None = None,
        robot: str | None = None,
        static_map: bytes | None = None,
        timeout_s: float = TIMEOUT_S,
    ) -> None:
        """Connect and say hello.

        Args:
            address: the server's socket file, or its port.
            goal: as a scenario's table `[goal]`.
            start: as `[start]`; height is that of the ground, m, and 0 where it is not said.
            navigation: as `[navigation]`.
            robot: the robot's name; None: whichever is served.
            static_map: the bytes of an OctoMap file, where a component has to be told a map.
            timeout_s: s, within which the server must have answered.

        Raises:
            InputError: no server answers there, or it refuses.
        """
        hello: dict[str, Any] = {"type": HELLO, "protocol": VERSION, "goal": dict(goal)}
        hello |= {} if start is None else {"start": dict(start)}
        hello |= {} if navigation is None else {"navigation": dict(navigation)}
        hello |= {} if robot is None else {"robot": robot}
        maps = {} if static_map is None else {STATIC_MAP: np.frombuffer(static_map, np.uint8)}
        self._connection = connected(address, timeout_s)
        try:
            self.robot: dict[str, Any] = self._asked(HELLO, hello, maps).header
            self._joints = len(self.robot["joints"])
        except (KeyError, TypeError):
            self._connection.close()
            raise ProtocolError(f"{HELLO}: joints: must be a list of names") from None
        except InputError:
            self._connection.close()
            raise

    def tick(self, observation: Observation) -> Targets:
        """Hand over the measurements of a tick, and return what the core answers.

        Raises:
            ProtocolError: the server refuses it, does not answer in time, or has gone.
        """
        return targets_of(self._asked(TARGETS, *observation_message(observation)), self._joints)

    def close(self) -> None:
        """Say goodbye, and end the connection.

        Raises:
            ProtocolError: the server does not answer.
        """
        with self._connection:
            self._asked(GOODBYE, {"type": GOODBYE}, {})

    def abandon(self) -> None:
        """End the connection without a word."""
        self._connection.close()

    def __enter__(self) -> Self:
        """Begin."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Say goodbye where all went well, and end the connection."""
        if kind is None:
            self.close()
        else:
            self.abandon()

    def _asked(self, wanted: str, header: Mapping[str, Any], arrays: Mapping[str, Any]) -> Message:
        """Send a message and return its answer."""
        fault = None
        try:
            self._connection.send(header, arrays)
        except ProtocolError as error:
            fault = error  # the server may have said why it took no more
        answer = self._connection.receive()
        if answer is None:
            raise ProtocolError("the server has gone") from fault
        kind = kind_of(answer)
        if kind == ERROR:
            raise ProtocolError(f"the server: {answer.header.get('message')}")
        if kind != wanted:
            raise ProtocolError(f"the server answered {shown(kind)} where {wanted} was due")
        return answer
