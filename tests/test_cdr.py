"""Claims about the messages of observations.mcap: there and back bit for bit."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from treadwell.observation import Frame, Observation
from treadwell.recording import cdr


def observation(joints: int = 26, seed: int = 0, time_ns: int = 10_000_000) -> Observation:
    random = np.random.default_rng(seed)
    return Observation(
        time_ns=time_ns,
        joint_positions=random.normal(size=joints),
        joint_velocities=random.normal(size=joints),
        angular_velocity=random.normal(size=3),
        specific_force=random.normal(size=3),
        foot_forces=random.random((2, 4)),
        depth=None,
    )


def test_a_time_that_no_run_has_is_refused() -> None:
    late = observation(time_ns=cdr.LATEST_NS + 1)
    with pytest.raises(ValueError, match=r"a time of 1e\+06 s"):
        cdr.decode(cdr.encode(late))


@given(st.integers(0, 60), st.integers(0, cdr.LATEST_NS))
def test_an_observation_comes_back_bit_for_bit(joints: int, time_ns: int) -> None:
    sent = observation(joints, joints, time_ns)
    back = cdr.decode(cdr.encode(sent))
    assert back.time_ns == time_ns
    for name in ("joint_positions", "joint_velocities", "angular_velocity", "specific_force"):
        assert np.array_equal(getattr(back, name), getattr(sent, name))
    assert np.array_equal(back.foot_forces, sent.foot_forces)


@given(st.integers(1, 40), st.integers(1, 40), st.integers(0, 10**12))
def test_a_frame_comes_back_bit_for_bit(rows: int, cols: int, exposure: int) -> None:
    depth = np.random.default_rng(rows).random((rows, cols)).astype(np.float32)
    depth[0, 0] = np.nan
    sent = Frame(exposure_ns=exposure, arrival_ns=exposure + 5, depth=depth)
    back = cdr.decode_image(cdr.encode_image(sent), exposure, exposure + 5)
    assert (back.exposure_ns, back.arrival_ns) == (exposure, exposure + 5)
    assert back.depth.dtype == np.float32
    assert back.depth.tobytes() == depth.tobytes()


@given(st.binary(max_size=200))
def test_anything_else_is_refused(data: bytes) -> None:
    with pytest.raises(ValueError, match=r"CDR|length"):
        cdr.decode(data)
    with pytest.raises(ValueError, match=r"CDR|length|buffer"):
        cdr.decode_image(data, 0, 0)


@given(st.integers(0, 700))
def test_half_a_message_is_refused(length: int) -> None:
    data = cdr.encode(observation())
    if length < len(data):
        with pytest.raises(ValueError, match=r"CDR|length"):
            cdr.decode(data[:length])
