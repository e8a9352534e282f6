"""Claims about recorded depth images: PNG files that others read, exact to half a unit."""

from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from treadwell.recording.depth_picture import UNIT_M, depth_png, png


@pytest.mark.parametrize("shape", [(1, 1), (72, 88), (3, 7)])
def test_another_reader_finds_the_same_greys(shape: tuple[int, int]) -> None:
    greys = np.random.default_rng(1).integers(0, 65536, shape).astype(np.uint16)
    with Image.open(BytesIO(png(greys))) as picture:
        assert np.array_equal(np.asarray(picture).astype(np.uint16), greys)


def test_depths_are_within_half_a_unit_and_what_was_not_seen_is_black() -> None:
    depth = np.random.default_rng(1).uniform(0.1, 4.0, (72, 88)).astype(np.float32)
    depth[:3] = np.nan
    with Image.open(BytesIO(depth_png(depth))) as picture:
        back = np.asarray(picture).astype(np.float32) * UNIT_M
    assert not back[:3].any()
    assert np.abs(back - depth)[3:].max() < UNIT_M / 2 + 1e-6


def test_what_is_further_than_the_last_grey_has_the_last_grey() -> None:
    depth = np.array([[np.inf, 1e6, -1.0]], np.float32)
    with Image.open(BytesIO(depth_png(depth))) as picture:
        assert np.asarray(picture).tolist() == [[0, 65535, 0]]
