"""How well an image is segmented: the classification of Hoover et al. 1996 (PAMI 18(7), section 3).

Regions of a machine's segmentation are compared with true ones, pixel by pixel. At a tolerance of
0.8, a true region is found correctly when a machine's region and it share 80 % of either.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

TOLERANCE = 0.8
"""Share of its pixels that a region has to have in common with another."""


@dataclass(frozen=True, slots=True)
class RegionCounts:
    """How many regions were found in which way; sums of frames may be added.

    Attributes:
        true: regions that there are.
        correct: true regions that one region of the machine's matches.
        over: true regions that several of the machine's make up.
        under: regions of the machine's that cover several true ones.
        merged: true regions that such a one covers.
        missed: true regions with none of these.
        noise: regions of the machine's with none of these.
    """

    true: int = 0
    correct: int = 0
    over: int = 0
    under: int = 0
    merged: int = 0
    missed: int = 0
    noise: int = 0

    def __add__(self, other: "RegionCounts") -> "RegionCounts":
        """Return the counts of both."""
        return RegionCounts(
            self.true + other.true,
            self.correct + other.correct,
            self.over + other.over,
            self.under + other.under,
            self.merged + other.merged,
            self.missed + other.missed,
            self.noise + other.noise,
        )


@dataclass(frozen=True, slots=True)
class _Instance:
    """One classification: regions of either side, how many pixels they share, and how well."""

    kind: str
    true: tuple[int, ...]
    found: tuple[int, ...]
    quality: float


def compare_regions(
    truth: NDArray[np.integer],
    found: NDArray[np.integer],
    *,
    tolerance: float = TOLERANCE,
    least_true: int = 1,
    least_found: int = 1,
) -> RegionCounts:
    """Sort every region into correct, over-segmented, under-segmented, missed or noise.

    Args:
        truth: (...) region of each pixel, 0 for none, below 0 for pixels that do not count.
        found: the same shape, the machine's; 0 for none.
        tolerance: more than 0.5, at most 1.
        least_true: pixels of the smallest true region that counts; smaller ones do not count
            either way.
        least_found: pixels of the smallest region of the machine's that can be noise.

    Raises:
        ValueError: the shapes differ or the tolerance is out of range.
    """
    if truth.shape != found.shape:
        raise ValueError(f"shapes must agree, got {truth.shape} and {found.shape}")
    if not 0.5 < tolerance <= 1.0:
        raise ValueError(f"tolerance must be > 0.5 and <= 1, got {tolerance}")
    sizes = np.unique(truth[truth > 0], return_counts=True)
    small = sizes[0][sizes[1] < least_true]
    counts = (truth >= 0) & ~np.isin(truth, small)
    true_ids, true_of = np.unique(truth[counts], return_inverse=True)
    found_ids, found_of = np.unique(found[counts], return_inverse=True)
    shared = np.zeros((len(true_ids), len(found_ids)), dtype=np.int64)
    np.add.at(shared, (true_of.ravel(), found_of.ravel()), 1)
    true_sizes, found_sizes = shared.sum(axis=1)[true_ids > 0], shared.sum(axis=0)[found_ids > 0]
    shared = shared[np.ix_(true_ids > 0, found_ids > 0)]
    chosen = _without_conflicts(_instances(shared, true_sizes, found_sizes, tolerance))
    found_list = found_sizes.tolist()
    explained = {index for one in chosen for index in one.true}
    used = {index for one in chosen for index in one.found}
    return RegionCounts(
        true=len(true_sizes),
        correct=sum(one.kind == "correct" for one in chosen),
        over=sum(one.kind == "over" for one in chosen),
        under=sum(one.kind == "under" for one in chosen),
        merged=sum(len(one.true) for one in chosen if one.kind == "under"),
        missed=len(true_sizes) - len(explained),
        noise=sum(size >= least_found and i not in used for i, size in enumerate(found_list)),
    )


def _instances(
    shared: NDArray[np.int64],
    true_sizes: NDArray[np.int64],
    found_sizes: NDArray[np.int64],
    tolerance: float,
) -> list[_Instance]:
    """Return every classification that the definitions allow, though two may share a region."""
    of_true = shared / true_sizes[:, None]
    of_found = shared / found_sizes[None, :]
    instances = [
        _Instance("correct", (int(t),), (int(f),), float(of_true[t, f] + of_found[t, f]) / 2)
        for t, f in np.argwhere((of_true >= tolerance) & (of_found >= tolerance))
    ]
    for t in range(len(true_sizes)):
        parts = np.flatnonzero(of_found[t] >= tolerance)
        # One division of whole numbers: a sum of shares would depend on the order of the parts.
        covered = float(shared[t, parts].sum() / true_sizes[t])
        if len(parts) > 1 and covered >= tolerance:
            purity = float(shared[t, parts].sum() / found_sizes[parts].sum())
            members = tuple(int(part) for part in parts)
            instances.append(_Instance("over", (t,), members, (covered + purity) / 2))
    for f in range(len(found_sizes)):
        parts = np.flatnonzero(of_true[:, f] >= tolerance)
        covered = float(shared[parts, f].sum() / found_sizes[f])
        if len(parts) > 1 and covered >= tolerance:
            purity = float(shared[parts, f].sum() / true_sizes[parts].sum())
            members = tuple(int(part) for part in parts)
            instances.append(_Instance("under", members, (f,), (covered + purity) / 2))
    return instances


def _without_conflicts(instances: list[_Instance]) -> list[_Instance]:
    """Keep the better one of two that speak of the same region, as the paper asks."""
    chosen: list[_Instance] = []
    true: set[int] = set()
    found: set[int] = set()
    for one in sorted(instances, key=lambda i: (-i.quality, i.kind, i.true, i.found)):
        if true.isdisjoint(one.true) and found.isdisjoint(one.found):
            chosen.append(one)
            true.update(one.true)
            found.update(one.found)
    return chosen
