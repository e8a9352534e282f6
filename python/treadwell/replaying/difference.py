"""At which tick two runs first differ, and in what."""

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Final

import numpy as np

from treadwell.observation import Floats
from treadwell.recording import cdr
from treadwell.recording.log_file import BrokenLogError, Message, read_messages
from treadwell.recording.messages import (
    Belief,
    Command,
    decode_command,
    decode_estimate,
    decode_truth,
)

Answer = tuple[bytes, bytes]
"""The messages `COMMAND` and `ESTIMATE` of one tick."""
_TOPICS: Final = ("/observation", "/depth", "/command", "/estimate", "/truth")
"""In the order in which a tick writes them: that of cause and effect."""
_POSE: Final = ("x", "y", "z", "yaw")
_TRUTH: Final = ("x", "y", "z", "qx", "qy", "qz", "qw")


@dataclass(frozen=True, slots=True)
class Difference:
    """Where two runs part.

    Attributes:
        tick: the first control tick that is not the same, counted from 0.
        time_s: its time, simulated seconds.
        what: which number, what it is, and what it was; one phrase.
    """

    tick: int
    time_s: float
    what: str

    def sentence(self) -> str:
        """Return it as one sentence."""
        return f"first difference at tick {self.tick} ({self.time_s:.2f} s): {self.what}"


def between_answers(now: Answer, recorded: Answer, joints: Sequence[str]) -> str | None:
    """Return what differs between two answers to one observation, None where no bit does.

    Args:
        now: the new answer.
        recorded: the one that is compared with.
        joints: their names, in the order of the command's numbers.
    """
    if now == recorded:
        return None
    try:
        beliefs = decode_estimate(now[1]), decode_estimate(recorded[1])
        commands = decode_command(now[0]), decode_command(recorded[0])
    except (ValueError, struct.error):
        return "the recorded answer cannot be read"
    return _beliefs(*beliefs) or _commands(*commands, joints) or "the encoding"


def between_logs(first: Path, second: Path, joints: Sequence[str]) -> Difference | None:
    """Return where the second log first differs from the first, None where it does not.

    Args:
        first: `observations.mcap` of a run.
        second: the same of another.
        joints: the first one's.

    Raises:
        InputError: a file is missing.
    """
    tick, time_ns = -1, 0
    pairs = zip_longest(_until_break(first), _until_break(second))
    for one, other in pairs:
        if one is None or other is None:
            shorter, ends = (first, one) if one is None else (second, other)
            assert ends is None
            return Difference(max(tick, 0), 1e-9 * time_ns, f"{shorter} ends here, the other not")
        if one.topic == "/observation":
            tick, time_ns = tick + 1, one.log_ns
        if one != other:
            return Difference(max(tick, 0), 1e-9 * time_ns, _messages(one, other, joints))
    return None


def _until_break(path: Path) -> Iterator[Message]:
    try:
        yield from read_messages(path, _TOPICS)
    except BrokenLogError:
        return


def _messages(one: Message, other: Message, joints: Sequence[str]) -> str:
    """Say how the second message differs from the first."""
    if one.topic != other.topic:
        return f"{other.topic} instead of {one.topic}"
    try:
        found = _contents(other, one, joints)
    except (ValueError, struct.error):
        found = None
    return found or f"{one.topic}: its times or its encoding"


def _contents(now: Message, was: Message, joints: Sequence[str]) -> str | None:
    if now.topic == "/command":
        return _commands(decode_command(now.data), decode_command(was.data), joints)
    if now.topic == "/estimate":
        return _beliefs(decode_estimate(now.data), decode_estimate(was.data))
    if now.topic == "/truth":
        return _numbers("truth", decode_truth(now.data), decode_truth(was.data), _TRUTH)
    return _frames(now, was) if now.topic == "/depth" else _observations(now, was, joints)


def _frames(now: Message, was: Message) -> str | None:
    images = [cdr.decode_image(m.data, m.publish_ns, m.log_ns).depth for m in (now, was)]
    if images[0].shape != images[1].shape:
        return f"depth: {images[0].shape} pixels instead of {images[1].shape}"
    changed = int((images[0].view(np.uint32) != images[1].view(np.uint32)).sum())
    return f"depth: {changed} pixels" if changed else None


def _observations(now: Message, was: Message, joints: Sequence[str]) -> str | None:
    a, b = cdr.decode(now.data), cdr.decode(was.data)
    for name, names in (
        ("joint_positions", joints),
        ("joint_velocities", joints),
        ("angular_velocity", "xyz"),
        ("specific_force", "xyz"),
        ("foot_forces", ()),
    ):
        found = _arrays(f"observation.{name}", getattr(a, name), getattr(b, name), names)
        if found:
            return found
    return None


def _beliefs(now: Belief, was: Belief) -> str | None:
    return (
        _numbers("estimate", now.pose, was.pose, _POSE)
        or _numbers("odometry", now.odometry, was.odometry, _POSE)
        or next(
            (
                f"{name}: {getattr(now, name)!r} instead of {getattr(was, name)!r}"
                for name in ("state", "outcome", "reason")
                if getattr(now, name) != getattr(was, name)
            ),
            None,
        )
    )


def _commands(now: Command, was: Command, joints: Sequence[str]) -> str | None:
    return (
        _arrays("command.position", now.positions, was.positions, joints)
        or _arrays("command.velocity", now.velocities, was.velocities, joints)
        or _arrays("command.torque", now.torques, was.torques, joints)
    )


def _arrays(word: str, now: Floats, was: Floats, names: Sequence[str]) -> str | None:
    return _numbers(word, now.ravel().tolist(), was.ravel().tolist(), names)


def _numbers(
    word: str, now: Sequence[float], was: Sequence[float], names: Sequence[str]
) -> str | None:
    """Say which of some numbers differs first, None where no bit of any does."""
    if len(now) != len(was):
        return f"{word}: {len(now)} numbers instead of {len(was)}"
    for i, (a, b) in enumerate(zip(now, was, strict=True)):
        if struct.pack("<d", a) != struct.pack("<d", b):
            name = names[i] if i < len(names) else str(i)
            return f"{word}.{name} is {a!r} instead of {b!r}"
    return None
