"""The behaviour that turns on the spot."""

import math
from types import SimpleNamespace
from typing import Any

import pytest

from treadwell.experiments.turner import Turner
from treadwell.judging.ground_truth import wrapped


def at(yaw: float, *, standing: bool = False) -> Any:  # noqa: ANN401
    return SimpleNamespace(estimate=(0.0, 0.0, 0.0, wrapped(yaw)), standing=standing)


def test_it_turns_as_often_as_it_is_told_then_stands_and_is_done() -> None:
    turner = Turner(turns=2.0, rate=0.25)
    yaw, ticks = 2.0, 0
    while turner.next(at(yaw)).velocity == (0.0, 0.0, 0.25):
        yaw, ticks = yaw + 0.1, ticks + 1
    assert 0.1 * ticks == pytest.approx(2.0 * math.tau, abs=0.11)
    assert turner.next(at(yaw)).outcome is None, "it does not stand yet"
    assert turner.next(at(yaw, standing=True)).outcome == "goal_reached"


def test_turning_back_is_made_up_for() -> None:
    turner = Turner(turns=0.5)
    for yaw in (0.0, 1.0, 0.5, 2.0, 3.0):
        assert turner.next(at(yaw)).velocity is not None
    assert turner.next(at(3.2)).velocity is None


@pytest.mark.parametrize("settings", [{"turns": 0.0}, {"turns": math.inf}, {"rate": -0.3}])
def test_no_turn_and_no_rate_are_refused(settings: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="must be > 0"):
        Turner(**settings)
