"""Intervals of paired differences: as published, and the same as the tests say."""

import itertools
import math
from statistics import fmean

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadwell.comparing.intervals import mean_interval, share_interval
from treadwell.comparing.statistics import LEVEL, permutation

COUNTS = st.tuples(*[st.integers(0, 60)] * 4)
STEPS = st.lists(st.integers(-50, 50), min_size=1, max_size=11)


@pytest.mark.parametrize(
    ("table", "low", "high"),
    [((20, 12, 2, 16), 0.0562, 0.3292), ((14, 5, 0, 22), 0.011, 0.226)],
)
def test_newcombes_interval_is_as_published(
    table: tuple[int, int, int, int], low: float, high: float
) -> None:
    """Newcombe 1998, table III, method 10; Altman 2000, table 6.2. They have first minus second."""
    found = share_interval(*table)
    assert found == pytest.approx((-high, -low), abs=6e-4)


@given(COUNTS)
def test_the_interval_of_shares_holds_the_difference_and_turns_with_it(
    counts: tuple[int, int, int, int],
) -> None:
    both, first, second, neither = counts
    low, high = share_interval(both, first, second, neither)
    step = (second - first) / max(1, sum(counts))
    assert -1.0 <= low <= step + 1e-12
    assert step - 1e-12 <= high <= 1.0
    turned = share_interval(both, second, first, neither)
    assert turned == pytest.approx((-high, -low), abs=1e-12)


@settings(deadline=None, max_examples=150)
@given(STEPS, st.integers(-60, 60))
def test_the_interval_holds_what_the_test_would_not_contradict(steps: list[int], at: int) -> None:
    low, high = mean_interval([float(step) for step in steps])
    inside = low <= at <= high
    assert inside == (permutation([float(step - at) for step in steps]) >= LEVEL)


def test_the_limits_are_means_of_subsets_and_fewer_than_six_pairs_have_none() -> None:
    assert mean_interval([]) == mean_interval([1.0, 2.0, 3.0, 4.0, 5.0]) == (-math.inf, math.inf)
    values = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0]
    means = sorted(
        fmean(chosen) for size in range(1, 9) for chosen in itertools.combinations(values, size)
    )
    # 0.05 of 256 sign patterns are 12.8: six subsets from either end, with the empty one.
    assert mean_interval(values) == pytest.approx((means[5], means[-6]))


def test_of_many_pairs_it_is_near_the_normal_one() -> None:
    steps = [math.sin(7.0 * k) + 0.2 for k in range(200)]
    half = 1.96 * math.sqrt(sum((x - fmean(steps)) ** 2 for x in steps) / 200 / 200)
    low, high = mean_interval(steps)
    assert (low, high) == pytest.approx((fmean(steps) - half, fmean(steps) + half), abs=0.01)
    assert (permutation(steps) < LEVEL) == (not low <= 0.0 <= high)
