"""Intervals and tests against published figures, and against what must hold of any."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from treadwell.comparing.statistics import holm, mcnemar, permutation, wilson


@pytest.mark.parametrize(
    ("successes", "of", "low", "high"),
    [
        (0, 10, 0.0, 0.2775),
        (10, 10, 0.7225, 1.0),
        (50, 100, 0.4038, 0.5962),
        (81, 263, 0.2553, 0.3662),
    ],
)
def test_wilsons_interval_is_as_published(successes: int, of: int, low: float, high: float) -> None:
    """Newcombe 1998 has 81 of 263; the rest by the formula's closed ends."""
    assert wilson(successes, of) == pytest.approx((low, high), abs=5e-5)


@given(st.integers(0, 500), st.integers(1, 500))
def test_the_interval_holds_the_share(successes: int, of: int) -> None:
    low, high = wilson(min(successes, of), of)
    assert 0.0 <= low <= min(successes, of) / of <= high <= 1.0
    assert wilson(0, 0) == (0.0, 1.0)


def test_mcnemars_test_is_the_binomial_one() -> None:
    assert mcnemar(0, 0) == mcnemar(1, 0) == mcnemar(3, 3) == 1.0
    assert mcnemar(0, 5) == pytest.approx(2 / 2**5)
    assert mcnemar(1, 9) == mcnemar(9, 1) == pytest.approx(2 * 11 / 2**10)


def test_the_permutation_test_counts_signs() -> None:
    values = [1.0, 2.0, 3.0, -0.5]
    sums = [
        abs(sum(s * v for s, v in zip(signs, values, strict=True)))
        for signs in itertools.product((1, -1), repeat=4)
    ]
    assert permutation(values) == sum(one >= 5.5 - 1e-9 for one in sums) / 16
    assert permutation([0.0, 0.0]) == permutation([]) == 1.0
    assert permutation([0.3] * 10) == 2 / 2**10


def test_of_many_pairs_the_permutation_test_is_near_the_normal_one() -> None:
    generator = np.random.default_rng(5)
    none, some = generator.normal(0.0, 1.0, 200), generator.normal(0.4, 1.0, 200)
    assert permutation(list(none - none.mean())) == 1.0
    assert permutation(list(some)) < 1e-3
    assert permutation(list(some)) == permutation(list(-some))


def test_where_nothing_differs_one_test_in_twenty_says_so() -> None:
    generator = np.random.default_rng(6)
    ps = np.array([permutation(list(generator.normal(size=10))) for _ in range(400)])
    assert 0.02 < (ps < 0.05).mean() < 0.085


def test_holms_correction() -> None:
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([]) == []
    assert holm([0.9, 0.8]) == [1.0, 1.0]
