"""Plots keep their peaks, survive every number, and hold text as text."""

import numpy as np
import pytest
from defusedxml import ElementTree
from hypothesis import given
from hypothesis import strategies as st

from treadwell.reporting.charts import HEIGHT, WIDTH, Line, plot, state_lane, ticks

NUMBERS = st.floats(allow_nan=True, allow_infinity=True)


def line(values: list[float], name: str = "line") -> Line:
    return Line(name, np.arange(len(values), dtype=float), np.array(values, float))


def points(svg: str) -> np.ndarray:
    places = [
        [float(number) for number in place.split(",")]
        for each in ElementTree.fromstring(svg).iter("polyline")
        for place in (each.get("points") or "").split()
    ]
    return np.array(places).reshape(-1, 2)


def test_a_line_goes_from_left_to_right_and_up_with_its_values() -> None:
    found = points(plot("title", "m", [line([0.0, 1.0, 2.0])], 2.0))
    assert (np.diff(found[:, 0]) > 100).all()
    assert (np.diff(found[:, 1]) < -20).all()


def test_a_long_line_keeps_its_peak() -> None:
    values = [0.0] * 10_000
    values[4321] = 5.0
    found = points(plot("title", "m", [line(values)], 10_000.0))
    assert len(found) <= 1000
    assert found[:, 1].min() < 20


@given(st.lists(NUMBERS, max_size=30), NUMBERS)
def test_no_number_leaves_the_picture(values: list[float], end: float) -> None:
    found = points(plot("title", "m", [line(values)], end if np.isfinite(end) else 1.0))
    assert np.isfinite(found).all()
    if len(found):
        assert found[:, 0].min() >= 0
        assert found[:, 0].max() <= WIDTH
        assert found[:, 1].min() >= -1
        assert found[:, 1].max() <= HEIGHT + 1


@given(st.floats(-1e9, 1e9), st.floats(1e-9, 1e9), st.integers(1, 10))
def test_ticks_are_few_and_within(low: float, span: float, about: int) -> None:
    found = ticks(low, low + span, about)
    assert 1 <= len(found) <= about + 2
    slack = 1e-6 * max(span, abs(low))
    assert all(low - slack <= mark <= low + span + slack for mark in found)


def test_noise_is_not_blown_up() -> None:
    small = points(plot("title", "mm", [line([0.0, 0.1, 0.0])], 2.0, least=20.0))
    assert np.ptp(small[:, 1]) < 2


def test_every_state_has_its_stretch() -> None:
    svg = state_lane([(0.0, "walk"), (4.0, "climb"), (6.0, "walk")], 10.0)
    boxes = list(ElementTree.fromstring(svg).iter("rect"))
    widths = [float(box.get("width") or 0) for box in boxes]
    assert widths == pytest.approx([0.4 * 656, 0.2 * 656, 0.4 * 656], abs=0.2)
    assert boxes[0].get("class") == boxes[2].get("class") != boxes[1].get("class")


@given(st.text(max_size=20), st.text(max_size=20))
def test_text_stays_text(name: str, title: str) -> None:
    hostile = f'<script>"{name}</svg>'
    for svg in (
        state_lane([(0.0, hostile), (0.1, title)], 10.0),
        plot(hostile, title, [line([1.0], hostile)], 1.0),
    ):
        assert "<script" not in svg
        assert svg.count("<svg") == svg.count("</svg") == 1
