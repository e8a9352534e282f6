"""Claims about commands, estimates and truths as messages: read back bit for bit, or refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from treadwell.recording.messages import (
    decode_command,
    decode_estimate,
    decode_truth,
    encode_command,
    encode_estimate,
    encode_truth,
)

NUMBER = st.floats(allow_nan=False)
POSE = st.tuples(NUMBER, NUMBER, NUMBER, NUMBER)


@given(time=st.integers(0, 2**63), rows=st.lists(st.tuples(NUMBER, NUMBER, NUMBER), max_size=30))
def test_a_command_is_read_back(time: int, rows: list[tuple[float, float, float]]) -> None:
    arrays = np.array(rows).reshape(-1, 3).T.copy()
    back = decode_command(encode_command(time, *arrays))
    assert back.time_ns == time
    for sent, found in zip(arrays, (back.positions, back.velocities, back.torques), strict=True):
        assert np.array_equal(sent, found)


@given(
    pose=POSE, odometry=POSE, state=st.text(max_size=20), reason=st.text(max_size=50) | st.none()
)
def test_an_estimate_is_read_back(
    pose: tuple[float, float, float, float],
    odometry: tuple[float, float, float, float],
    state: str,
    reason: str | None,
) -> None:
    back = decode_estimate(encode_estimate(7, pose, odometry, state, None, reason))
    assert (back.time_ns, back.pose, back.odometry) == (7, pose, odometry)
    assert (back.state, back.outcome, back.reason) == (state, "", reason or "")


def test_a_truth_is_read_back() -> None:
    row = (0.1, -2.0, 3.5, 0.0, 0.0, 0.6, 0.8)
    message = encode_truth(1_234_567_890, row[:3], row[3:])
    assert decode_truth(message) == row
    assert (len(message) - 4 - 16) % 8 == 0


@given(content=st.binary(max_size=120), keep=st.integers(0, 120))
def test_other_bytes_are_refused(content: bytes, keep: int) -> None:
    whole = encode_estimate(1, (0.0,) * 4, (0.0,) * 4, "walk", None, None)
    command = encode_command(1, *np.zeros((3, 2)))
    for decode, message in ((decode_estimate, whole), (decode_command, command)):
        bad = message[: min(keep, len(message) - 1)]
        with pytest.raises(ValueError, match=r"length|CDR"):
            decode(bad)
    with pytest.raises(ValueError, match="pose"):
        decode_truth(content)
