"""The statistics of a comparison: Wilson's interval, paired tests, Holm's correction."""

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

Z95: Final = 1.959963984540054
"""Two-sided 95 % quantile of the normal distribution."""
LEVEL: Final = 0.05
"""Of all tests together: a p below it, after Holm's correction, is a difference."""
EXACT_UP_TO: Final = 14
"""Pairs up to which all signs are tried; above, `DRAWS` random ones."""
DRAWS: Final = 20_000
_TIE: Final = 1e-12


def wilson(successes: int, of: int) -> tuple[float, float]:
    """Return Wilson's 95 % interval of a share; (0, 1) of nothing."""
    if of == 0:
        return 0.0, 1.0
    share, square = successes / of, Z95**2
    middle: float = (share + square / (2 * of)) / (1 + square / of)
    half = Z95 / (1 + square / of) * math.sqrt(share * (1 - share) / of + square / (4 * of**2))
    low = 0.0 if successes == 0 else max(0.0, middle - half)
    high = 1.0 if successes == of else min(1.0, middle + half)
    return low, high


def mcnemar(only_first: int, only_second: int) -> float:
    """Return the exact two-sided p of pairs of which only one had it (McNemar, binomial)."""
    count = only_first + only_second
    if count == 0:
        return 1.0
    tail = sum(math.comb(count, k) for k in range(min(only_first, only_second) + 1))
    return min(1.0, float(2 * tail / 2**count))


def permutation(differences: Sequence[float]) -> float:
    """Return the two-sided p of paired differences: how often random signs give such a mean.

    All signs up to 14 pairs that differ, else 20,000 draws, the same every time.
    """
    values = np.array([value for value in differences if value != 0.0], dtype=np.float64)
    count = len(values)
    if count == 0:
        return 1.0
    least = abs(float(values.sum())) * (1 - _TIE)
    extreme = int((np.abs((1.0 - 2.0 * subsets(count)) @ values) >= least).sum())
    if count <= EXACT_UP_TO:
        return extreme / float(2**count)
    return (1 + extreme) / (1 + DRAWS)


@lru_cache(maxsize=1)  # of ten thousand pairs it is a gigabyte
def subsets(count: int) -> NDArray[np.float64]:
    """Return subsets of so many pairs, a row each: 1 for what is in it, else 0.

    All of them up to `EXACT_UP_TO`, else `DRAWS` random ones, the same every time.
    """
    if count <= EXACT_UP_TO:
        bits = np.arange(2**count)[:, None] >> np.arange(count)[None, :] & 1
        return bits.astype(np.float64)
    generator = np.random.default_rng(0)
    signs = generator.integers(0, 2, (DRAWS, count), dtype=np.int8)
    return 1.0 - signs.astype(np.float64)


def holm(ps: Sequence[float]) -> list[float]:
    """Return p-values of several tests at once, corrected after Holm, in the same order."""
    order = sorted(range(len(ps)), key=lambda i: ps[i])
    corrected, most = [1.0] * len(ps), 0.0
    for rank, i in enumerate(order):
        most = max(most, min(1.0, (len(ps) - rank) * ps[i]))
        corrected[i] = most
    return corrected
