"""How many pairs a difference takes: against what the tests themselves say of the pairs."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadwell.comparing.power import (
    MOST_PAIRS,
    POWER,
    Test,
    fewest_pairs,
    least_p,
    pairs_for_power,
    threshold,
)
from treadwell.comparing.statistics import DRAWS, LEVEL, holm, mcnemar, permutation

PS = st.lists(st.floats(0.0, 1.0) | st.floats(0.0, 0.01), max_size=12)


@pytest.mark.parametrize("pairs", range(9))
def test_no_outcome_of_so_many_pairs_has_a_smaller_p(pairs: int) -> None:
    shares = min(mcnemar(a, b) for a in range(pairs + 1) for b in range(pairs + 1 - a))
    assert least_p("mcnemar", pairs) == shares
    signs = itertools.product((-1.0, 0.0, 1.0), repeat=min(pairs, 6))
    means = min(permutation([*some, *[1.0] * (pairs - 6)]) for some in signs)
    assert least_p("permutation", pairs) == means


def test_of_many_pairs_the_draws_are_the_limit() -> None:
    assert permutation([1.0] * 15) >= least_p("permutation", 15) == 1 / (1 + DRAWS)
    assert permutation([1.0] * 40) == least_p("permutation", 40)
    assert fewest_pairs("permutation", 1e-5) is None
    assert fewest_pairs("mcnemar", 1e-5) == 18


@settings(deadline=None)
@given(st.floats(1e-4, 1.0))
def test_the_fewest_pairs_are_enough_and_one_less_is_not(below: float) -> None:
    fewest = fewest_pairs("mcnemar", below)
    assert fewest is not None
    assert mcnemar(fewest, 0) < below
    assert fewest == 1 or mcnemar(fewest - 1, 0) >= below
    assert fewest_pairs("permutation", below) == fewest
    assert permutation([1.0] * fewest) < below


def test_six_pairs_can_show_a_difference_alone_and_nine_beside_ten_other_tests() -> None:
    assert fewest_pairs("permutation", threshold([])) == 6
    assert fewest_pairs("permutation", threshold([1.0] * 10)) == 9
    assert fewest_pairs("permutation", threshold([1e-9] * 9 + [1.0])) == 7


@given(PS, st.floats(0.0, 1.0) | st.floats(0.0, 0.02))
def test_below_the_threshold_is_what_holm_would_show(others: list[float], p: float) -> None:
    limit = threshold(others)
    for asked in (p, limit * (1 - 1e-9), limit * (1 + 1e-9)):
        if abs(asked - limit) > 1e-12:  # at the limit itself rounding decides
            assert (holm([*others, asked])[-1] < LEVEL) == (asked < limit)


@pytest.mark.parametrize("test", ["mcnemar", "permutation"])
def test_so_many_pairs_show_it_about_four_times_in_five(test: Test) -> None:
    generator = np.random.default_rng(3)

    def drawn(count: int) -> list[float]:
        if test == "mcnemar":
            return list(generator.choice([-1.0, 0.0, 1.0], count, p=[0.1, 0.5, 0.4]))
        return list(generator.normal(0.7, 1.0, count))

    many = drawn(20_000)
    about = pairs_for_power(test, many, LEVEL)
    assert about is not None
    shown = 0
    for _ in range(300):
        steps = drawn(about)
        lost, won = sum(s < 0 for s in steps), sum(s > 0 for s in steps)
        p = mcnemar(lost, won) if test == "mcnemar" else permutation(steps)
        shown += p < LEVEL
    assert shown / 300 == pytest.approx(POWER, abs=0.09)


def test_what_cannot_be_estimated_is_not() -> None:
    assert pairs_for_power("permutation", [1.0, -1.0, 1.0, -1.0], LEVEL) is None
    assert pairs_for_power("permutation", [1.0, 2.0], LEVEL) is None
    assert pairs_for_power("permutation", [1.0] * 3, LEVEL) == fewest_pairs("permutation", LEVEL)
    assert pairs_for_power("permutation", [1.0, -1.0] * 50 + [0.01], LEVEL) is None
    assert MOST_PAIRS > 1e5
