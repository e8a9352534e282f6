"""Outlines seen from above: their hulls, clips and distances."""

import math

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

from treadwell.course.outlines import clipped, convex_outline, near, rectangle, signed_distance

POINTS = st.lists(st.tuples(st.floats(-5, 5), st.floats(-5, 5)), min_size=3, max_size=12)


@given(points=POINTS)
def test_an_outline_contains_every_point_it_is_made_of(points: list[tuple[float, float]]) -> None:
    array = np.array(points)
    outline = convex_outline(array)
    if len(outline) >= 3:
        assert (signed_distance(outline, array) < 1e-6).all()


@given(angle=st.floats(-3, 3), offset=st.floats(-0.9, 0.9))
def test_what_is_clipped_lies_behind_the_line(angle: float, offset: float) -> None:
    square = rectangle((0.0, 0.0), 0.0, (-1.0, 1.0), 2.0)
    normal = np.array([math.cos(angle), math.sin(angle)])
    kept = clipped(square, normal * offset, normal)
    assert ((kept - normal * offset) @ normal < 1e-9).all()
    assert (signed_distance(square, kept) < 1e-9).all()


@given(
    st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=3, max_size=8),
    st.lists(st.tuples(st.floats(-2, 2), st.floats(-2, 2)), min_size=1, max_size=30),
    st.floats(0, 0.5),
)
def test_what_is_not_near_an_outline_is_farther_from_it_than_the_margin(
    corners: list[tuple[float, float]], places: list[tuple[float, float]], margin: float
) -> None:
    outline, points = convex_outline(np.array(corners)), np.array(places)
    assume(len(outline) >= 3)
    close = near(outline, points, margin)
    far = np.setdiff1d(np.arange(len(points)), close)
    assert (signed_distance(outline, points[far]) > margin - 1e-12).all()
    # And what is near lies in the box around it.
    aside = np.abs(points[close] - (outline.min(axis=0) + outline.max(axis=0)) / 2)
    assert (aside <= np.ptp(outline, axis=0) / 2 + margin + 1e-12).all()
