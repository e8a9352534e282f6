"""Intervals of paired differences: Newcombe's of shares, typical values of everything else."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from treadwell.comparing.statistics import DRAWS, EXACT_UP_TO, LEVEL, subsets, wilson


def share_interval(
    both: int, only_first: int, only_second: int, neither: int
) -> tuple[float, float]:
    """Return the 95 % interval of a paired difference of shares, second minus first.

    The square-and-add interval of Newcombe (1998), his method 10: Wilson's intervals of the two
    shares, joined with how far the two go together.

    Args:
        both: pairs of which both had it.
        only_first: pairs of which only the first had it.
        only_second: pairs of which only the second had it.
        neither: pairs of which none had it.

    Returns:
        The lower and the upper limit, -1 to 1; (-1, 1) of no pairs.
    """
    count = both + only_first + only_second + neither
    if not count:
        return -1.0, 1.0
    first, second = both + only_first, both + only_second
    step = (second - first) / count
    (low1, high1), (low2, high2) = wilson(first, count), wilson(second, count)
    below1, above1 = first / count - low1, high1 - first / count
    below2, above2 = second / count - low2, high2 - second / count
    alike = _correlation(both, only_first, only_second, neither)
    down = below2**2 - 2 * alike * below2 * above1 + above1**2
    up = above2**2 - 2 * alike * above2 * below1 + below1**2
    # Rounding alone can lead beyond what is possible.
    low, high = step - math.sqrt(max(0.0, down)), step + math.sqrt(max(0.0, up))
    return max(-1.0, low), min(1.0, high)


def _correlation(both: int, only_first: int, only_second: int, neither: int) -> float:
    """Return how far two shares go together, with the continuity correction of the method."""
    margins = (
        (both + only_first)
        * (only_second + neither)
        * (both + only_second)
        * (only_first + neither)
    )
    if not margins:
        return 0.0
    product = both * neither - only_first * only_second
    half = (both + only_first + only_second + neither) / 2
    corrected = product if product < 0 else max(0.0, product - half)
    return corrected / math.sqrt(margins)


def mean_interval(differences: Sequence[float]) -> tuple[float, float]:
    """Return the 95 % interval of the mean of paired differences.

    It holds what the permutation test would not contradict: the test of `differences` less a value
    has a p of 0.05 or more just where the value is in the interval. By Hartigan (1969) its limits
    are among the means of all subsets: the k-th from either end.

    Returns:
        The lower and the upper limit; infinite where so few pairs can contradict nothing, which is
        below six.
    """
    values = np.array(differences, dtype=np.float64)
    count = len(values)
    if not count:
        return -math.inf, math.inf
    chosen = subsets(count)
    sums, sizes = chosen @ values, chosen.sum(axis=1)
    rest_sums, rest_sizes = float(values.sum()) - sums, count - sizes
    means = _means(np.concatenate([sums, rest_sums]), np.concatenate([sizes, rest_sizes]))
    draws = 2**count if count <= EXACT_UP_TO else 1 + DRAWS
    # The empty subset, and for random ones the data themselves, are at least as extreme as any.
    certain = int((sizes == 0).sum() + (rest_sizes == 0).sum()) + (count > EXACT_UP_TO)
    rank = math.ceil(LEVEL * draws - certain - 1e-9)
    if rank <= 0:
        return -math.inf, math.inf
    means.sort()
    return float(means[rank - 1]), float(means[-rank])


def _means(sums: NDArray[np.float64], sizes: NDArray[np.float64]) -> NDArray[np.float64]:
    some = sizes > 0
    means: NDArray[np.float64] = sums[some] / sizes[some]
    return means
