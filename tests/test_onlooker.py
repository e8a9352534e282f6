"""The behaviour that stands and looks."""

from types import SimpleNamespace
from typing import Any

import pytest

from treadwell.experiments.onlooker import Onlooker


def at(seconds: float) -> Any:  # noqa: ANN401
    return SimpleNamespace(time_ns=round(1e9 * seconds))


def test_it_looks_at_one_direction_after_the_other_and_is_done() -> None:
    onlooker = Onlooker(seconds=4.0, gazes=[[0.0, 0.8], [0.5, 0.4]])
    decided = [onlooker.next(at(t)) for t in (0.0, 1.99, 2.0, 3.99, 4.0, 9.0)]
    assert [one.gaze for one in decided] == [(0.0, 0.8)] * 2 + [(0.5, 0.4)] * 4
    assert [one.outcome for one in decided] == [None] * 4 + ["goal_reached"] * 2
    assert all(one.velocity is None and not one.footsteps for one in decided)


@pytest.mark.parametrize("seconds", [0.0, -1.0, float("nan"), float("inf")])
def test_no_time_to_look_is_refused(seconds: float) -> None:
    with pytest.raises(ValueError, match="seconds must be > 0"):
        Onlooker(seconds=seconds)


@pytest.mark.parametrize("gazes", [[], [[0.1]], [[0.0, 0.5], [0.0, 0.5, 0.5]]])
def test_gazes_are_pairs(gazes: list[list[float]]) -> None:
    with pytest.raises(ValueError, match="gazes must be pairs"):
        Onlooker(gazes=gazes)
