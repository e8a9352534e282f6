"""A server in a thread, and what tests send to it."""

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import numpy as np

from treadwell.observation import Observation
from treadwell.physics.simulation import TICK_NS
from treadwell.serving.connection import Address, connected
from treadwell.serving.framing import Message, pack
from treadwell.serving.protocol import observation_message
from treadwell.serving.served import ServedRobot
from treadwell.serving.server import attend_all, listening

GOAL: dict[str, Any] = {"position": [2.0, 0.0]}
HELLO = pack({"type": "hello", "protocol": 1, "goal": GOAL})


class Running:
    """A server in a thread, and what it said."""

    def __init__(self, address: Address, said: list[str]) -> None:
        self.address, self.said = address, said

    def last(self, number: int) -> str:
        """What it said of its client `number` at the end."""
        for _ in range(500):
            lines = [line for line in self.said if line.startswith(f"client {number}: ")]
            if lines and not lines[-1].endswith("hello, qrio"):
                return lines[-1]
            time.sleep(0.01)
        raise AssertionError(self.said)


@contextmanager
def running(robot: ServedRobot, address: Address, timeout_s: float = 20.0) -> Iterator[Running]:
    said: list[str] = []
    with listening(address) as (listener, found):

        def attend() -> None:
            with suppress(OSError):
                attend_all(listener, robot, timeout_s, said.append, once=False)

        thread = threading.Thread(target=attend)
        thread.start()
        try:
            yield Running(found, said)
        finally:
            listener.shutdown(socket.SHUT_RDWR)
            thread.join(20)
            assert not thread.is_alive()


def observation(served: ServedRobot, tick: int = 0, **changes: object) -> Observation:
    stand = served.robot.stand
    rest: dict[str, Any] = {
        "time_ns": tick * TICK_NS,
        "joint_positions": stand,
        "joint_velocities": np.zeros(len(stand)),
        "angular_velocity": np.zeros(3),
        "specific_force": np.array([0.0, 0.0, 9.81]),
        "foot_forces": np.full((2, 4), 8.0),
        "depth": None,
    }
    return Observation(**{**rest, **changes})


def answers(here: Running, data: bytes) -> list[Message]:
    """What comes back for bytes that are sent, until the server ends the connection."""
    with connected(here.address, 20.0) as connection:
        connection._socket.sendall(data)
        found = []
        while (message := connection.receive()) is not None:
            found.append(message)
            if message.header["type"] in ("error", "goodbye"):
                break
    return found


def told(served: ServedRobot, header: dict[str, Any] | None = None, **arrays: object) -> bytes:
    """An observation with another header, or other arrays; None leaves one out."""
    own, given = observation_message(observation(served))
    both = {name: array for name, array in {**given, **arrays}.items() if array is not None}
    return pack({**own, **(header or {})}, both)
