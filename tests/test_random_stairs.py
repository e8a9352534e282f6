"""Courses with stairs that are drawn: what may be drawn, and that each is a scenario."""

from pathlib import Path

import pytest

from treadwell.experiments.drawn import write_scenario
from treadwell.experiments.experiment import Draw
from treadwell.experiments.random_stairs import HIGHEST, RISES, low, ordinary, single
from treadwell.scenario.elements import Stairs
from treadwell.scenario.loading import load_scenario

WITHIN = {ordinary: (0.020, 0.050), low: (0.015, 0.020)}


@pytest.mark.parametrize("draw", [ordinary, low, single])
def test_what_is_drawn_is_a_scenario_and_the_same_for_the_same_seed(
    draw: Draw, tmp_path: Path
) -> None:
    for seed in range(20):
        made = load_scenario(write_scenario(tmp_path / f"{seed}.toml", draw(seed)))
        assert made.goal.position != made.start.position
        assert draw(seed) == draw(seed)
        assert draw(seed) != draw(seed + 1)


@pytest.mark.parametrize("draw", [ordinary, low])
def test_steps_are_as_high_and_deep_as_asked_for_up_and_down(draw: Draw, tmp_path: Path) -> None:
    ways = set()
    for seed in range(30):
        made = load_scenario(write_scenario(tmp_path / f"{seed}.toml", draw(seed)))
        stairs = next(element for element in made.course if isinstance(element, Stairs))
        least, most = WITHIN[draw]
        assert all(least - 1e-12 <= rise <= most + 1e-12 for rise in stairs.rises())
        assert all(0.11 <= tread <= 0.20 for tread in stairs.treads()[:-1])
        assert stairs.width >= 0.33
        ways.add(made.goal.height == 0.0)
    assert ways == {True, False}


def test_a_single_step_has_every_rise_in_turn_and_more_than_the_limit_is_refused() -> None:
    drawn = [single(seed) for seed in range(len(RISES))]
    rises = [table["course"][0]["size"][2] for table in drawn]
    assert rises == list(RISES)
    for rise, table in zip(rises, drawn, strict=True):
        assert (table["expect"]["outcome"] == "refused") == (rise > HIGHEST)
