"""Tests of the comparison of segmentations, after Hoover et al. 1996."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from treadwell.measuring.regions import RegionCounts, compare_regions

LABELS = arrays(np.int64, (6, 8), elements=st.integers(0, 4))


def bands(*widths: int) -> np.ndarray:
    """Ten rows of bands one beside the other, numbered from 1; a negative width has no region."""
    row = [label * (width > 0) for label, width in enumerate(widths, 1) for _ in range(abs(width))]
    return np.tile(np.array(row), (10, 1))


def test_a_segmentation_is_all_correct_against_itself() -> None:
    assert compare_regions(bands(5, 7, 3), bands(5, 7, 3)) == RegionCounts(true=3, correct=3)


def test_eight_tenths_are_enough_and_less_is_not() -> None:
    assert compare_regions(bands(10), bands(8, -2)) == RegionCounts(true=1, correct=1)
    assert compare_regions(bands(10), bands(7, -3)) == RegionCounts(true=1, missed=1, noise=1)


def test_two_parts_of_one_region_are_over_segmented() -> None:
    assert compare_regions(bands(10, 6), bands(5, 5, 6)) == RegionCounts(true=2, correct=1, over=1)


def test_one_region_over_two_is_under_segmented() -> None:
    counts = compare_regions(bands(5, 5, 6), bands(10, 6))
    assert counts == RegionCounts(true=3, correct=1, under=1, merged=2)


def test_of_a_match_and_an_over_segmentation_the_better_one_counts() -> None:
    # One part covers 85 % of the region, both together all of it.
    assert compare_regions(bands(20), bands(17, 3)) == RegionCounts(true=1, over=1)
    assert compare_regions(bands(20), bands(17, -3)) == RegionCounts(true=1, correct=1)


def test_what_is_not_there_is_noise_and_what_is_not_found_is_missed() -> None:
    counts = compare_regions(bands(5, -5, 5), bands(-5, 5, -5))
    assert counts == RegionCounts(true=2, missed=2, noise=1)


def test_small_regions_and_pixels_that_do_not_count_are_left_out() -> None:
    truth = bands(10, 2, 3)
    truth[truth == 3] = -1
    found = bands(10, 2, 3)
    assert compare_regions(truth, found, least_true=50) == RegionCounts(true=1, correct=1)
    assert compare_regions(bands(-10), bands(1, -9), least_found=20) == RegionCounts()


TIED = np.ones((6, 8), dtype=np.int64)
TIED[0] = [3, 1, 1, 3, 1, 1, 0, 3]
FOUND_TIED = np.full((6, 8), 3)
FOUND_TIED[0] = [3, 2, 0, 3, 1, 1, 3, 3]


@given(LABELS, LABELS)
@example(TIED, FOUND_TIED)  # as good over-segmented as under-segmented
def test_every_region_has_one_fate_and_names_do_not_matter(
    truth: np.ndarray, found: np.ndarray
) -> None:
    counts = compare_regions(truth, found)
    assert counts.true == len(np.unique(truth[truth > 0]))
    assert counts.correct + counts.over + counts.merged + counts.missed == counts.true
    renamed = np.where(found > 0, 7 - found, 0)
    assert compare_regions(truth, renamed) == counts
    assert compare_regions(truth, truth) == RegionCounts(counts.true, counts.true)


def test_what_cannot_be_compared_is_refused() -> None:
    with pytest.raises(ValueError, match="shapes must agree"):
        compare_regions(bands(4), bands(5))
    with pytest.raises(ValueError, match=r"> 0\.5 and <= 1, got 0\.5"):
        compare_regions(bands(4), bands(4), tolerance=0.5)
