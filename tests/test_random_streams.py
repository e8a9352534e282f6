"""Tests of the seeded generators."""

from hypothesis import given
from hypothesis import strategies as st

from treadwell.random_streams import RandomStreams, stream

SEEDS = st.integers(0, 2**63)


@given(SEEDS, st.text(max_size=20))
def test_a_stream_repeats(seed: int, name: str) -> None:
    assert stream(seed, name).random(4).tolist() == stream(seed, name).random(4).tolist()


@given(SEEDS, st.sampled_from(["sensors.imu", "course", ""]))
def test_another_name_or_seed_gives_other_numbers(seed: int, name: str) -> None:
    numbers = stream(seed, name).random(4).tolist()
    assert numbers != stream(seed, name + "2").random(4).tolist()
    assert numbers != stream(seed + 1, name).random(4).tolist()


def test_an_episodes_streams_do_not_depend_on_what_was_drawn_before() -> None:
    first, second = RandomStreams(7), RandomStreams(7)
    first("a").random(1000)
    assert first("b").random() == second("b").random() == stream(7, "b").random()
