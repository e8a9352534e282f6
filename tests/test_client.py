"""The client, of servers that are none; and what the messages say, there and back."""

import io
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from serving_builders import GOAL, observation

from treadwell.observation import Frame, Observation
from treadwell.serving.client import Client
from treadwell.serving.framing import Message, ProtocolError, pack, read_message
from treadwell.serving.protocol import (
    Shapes,
    observation_message,
    observation_of,
    targets_of,
)
from treadwell.serving.served import ServedRobot


@pytest.fixture(scope="module")
def served() -> ServedRobot:
    return ServedRobot("qrio")


@settings(deadline=None, max_examples=50)
@given(st.integers(0, 10**15), st.booleans(), st.integers(0, 2**32 - 1))
def test_an_observation_arrives_as_it_was(time_ns: int, seen: bool, seed: int) -> None:
    random = np.random.default_rng(seed)
    depth = random.normal(size=(4, 5)).astype(np.float32)
    depth[0, :3] = np.nan, np.inf, -0.0
    now = Observation(
        time_ns,
        *(random.normal(size=6) for _ in range(2)),
        *(random.normal(size=3) for _ in range(2)),
        random.normal(size=(2, 4)),
        Frame(time_ns // 2, time_ns, depth) if seen else None,
    )
    data = pack(*observation_message(now))
    message = read_message(io.BytesIO(data).read)
    assert message is not None
    then = observation_of(message, Shapes(6, (4, 5)))
    for name in ("joint_positions", "joint_velocities", "specific_force", "foot_forces"):
        assert getattr(then, name).tobytes() == getattr(now, name).tobytes()
    assert (then.time_ns, then.depth is None) == (time_ns, not seen)
    if then.depth is not None:
        assert (then.depth.exposure_ns, then.depth.arrival_ns) == (time_ns // 2, time_ns)
        assert then.depth.depth.tobytes() == depth.tobytes()


@contextmanager
def answering(path: Path, *data: bytes) -> Iterator[None]:
    """Something that is no server: it answers each message with given bytes, then ends."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as listener:
        listener.bind(str(path))
        listener.listen()

        def answer() -> None:
            opened, _ = listener.accept()
            with opened:
                for each in data:
                    opened.recv(1 << 20)
                    opened.sendall(each)

        thread = threading.Thread(target=answer)
        thread.start()
        yield
        thread.join(20)


WELCOME = pack({"type": "hello", "protocol": 1, "joints": ["a"]})


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ((), "the server has gone"),
        ((b"SSH-2.0-OpenSSH\r\n",), "a message begins with the length"),
        ((pack({"type": "targets"}),), 'the server answered "targets" where hello'),
        ((pack({"type": "hello"}),), "joints: must be a list"),
        ((WELCOME, WELCOME), 'the server answered "hello" where'),
        ((WELCOME, pack({"type": "targets"})), "targets: position: is missing"),
        ((WELCOME, WELCOME[:10]), "the connection ended within a header"),
    ],
)
def test_a_client_of_something_else_gets_the_named_error(
    served: ServedRobot, tmp_path: Path, data: tuple[bytes, ...], message: str
) -> None:
    with (
        answering(tmp_path / "s", *data),
        pytest.raises(ProtocolError, match=message),
        Client(tmp_path / "s", goal=GOAL, timeout_s=5.0) as core,
    ):
        core.tick(observation(served))


def test_targets_without_a_state_are_refused() -> None:
    arrays = {name: np.zeros(2) for name in ("position", "velocity", "torque")}
    arrays |= {name: np.zeros(4) for name in ("estimate", "odometry")}
    with pytest.raises(ProtocolError, match="state, outcome and reason: must be texts"):
        targets_of(Message({"type": "targets", "time_ns": 0}, arrays), 2)
