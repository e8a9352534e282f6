"""What so many pairs can show: the fewest with which a test can, and about how many it takes."""

import math
from collections.abc import Sequence
from statistics import NormalDist, fmean, stdev
from typing import Final, Literal

from treadwell.comparing.statistics import DRAWS, EXACT_UP_TO, LEVEL

Test = Literal["mcnemar", "permutation"]
POWER: Final = 0.8
"""How probable it is that a difference as large as the one seen is shown by so many pairs."""
FEWEST_FOR_SPREAD: Final = 3
"""Pairs of which the spread of the differences is estimated at least."""
MOST_PAIRS: Final = 1_000_000
"""More are not asked for: then there is hardly a difference."""


def least_p(test: Test, pairs: int) -> float:
    """Return the p of the most extreme outcome of so many pairs: all differ, and all one way."""
    if test == "permutation" and pairs > EXACT_UP_TO:
        return 1.0 / (1 + DRAWS)
    return min(1.0, 2.0 ** (1 - pairs))


def fewest_pairs(test: Test, below: float) -> int | None:
    """Return the smallest number of pairs whose most extreme outcome has a p below a threshold.

    Returns:
        The number; None where no number has one, since random draws tell no smaller p apart.
    """
    # Beyond, 2 ** (1 - pairs) is no number any more; thresholds are far above.
    for pairs in range(1, 1000):
        if least_p(test, pairs) < below:
            return pairs
    return None


def threshold(others: Sequence[float]) -> float:
    """Return the p below which one more test is shown beside others, all corrected after Holm.

    Args:
        others: the p of all other tests, as they are.
    """
    tests, passed = len(others) + 1, 0
    for p in sorted(others):
        if (tests - passed) * p >= LEVEL:
            break
        passed += 1
    return LEVEL / (tests - passed)


def pairs_for_power(test: Test, steps: Sequence[float], below: float) -> int | None:
    """Estimate how many pairs show a difference as the one seen in four cases of five.

    By the normal approximation: for McNemar's test that of Connor (1987), for the mean that of
    Guenther (1981). Of few pairs it is as uncertain as what they show.

    Args:
        test: which one.
        steps: the paired differences.
        below: the threshold of p.

    Returns:
        The number; None where nothing differs, nothing can be estimated, or it is beyond
        `MOST_PAIRS`.
    """
    least = fewest_pairs(test, below)
    if least is None or len(steps) < FEWEST_FOR_SPREAD or not fmean(steps):
        return None
    mean = abs(fmean(steps))
    chance, power = NormalDist().inv_cdf(1 - below / 2), NormalDist().inv_cdf(POWER)
    if test == "mcnemar":
        differ = fmean(abs(step) for step in steps)
        spread = chance * math.sqrt(differ) + power * math.sqrt(max(0.0, differ - mean**2))
        about = (spread / mean) ** 2
    else:
        about = ((chance + power) * stdev(steps) / mean) ** 2 + chance**2 / 2
    return max(least, math.ceil(about)) if about <= MOST_PAIRS else None
