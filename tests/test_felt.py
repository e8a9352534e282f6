"""What a foot met is known: the way goes around it, or is refused with what and where."""

import re
from pathlib import Path

import pytest

from treadwell.experiments.drawn import write_scenario
from treadwell.experiments.world.courses import cable_across, cable_open
from treadwell.experiments.world.parts import Part
from treadwell.judging.result import Result
from treadwell.runner import run

pytestmark = pytest.mark.scenario


def result(folder: Path, course: Part) -> Result:
    """Return what comes of a walk over a course."""
    file = write_scenario(folder / "cable.toml", course)
    return run(file, seed=0, record=False, out=folder / "run").result


def test_a_cable_on_an_open_floor_is_walked_around_after_a_foot_met_it(tmp_path: Path) -> None:
    came = result(tmp_path, cable_open())
    assert (came.outcome, came.reason, came.falls) == ("goal_reached", None, 0)


@pytest.mark.long
def test_a_cable_across_a_corridor_is_refused_with_where_a_foot_met_it(tmp_path: Path) -> None:
    came = result(tmp_path, cable_across())
    assert (came.outcome, came.falls) == ("refused", 0)
    met = re.match(r"blocked: a foot met something at \(([\d.]+), -?[\d.]+\)", came.reason or "")
    assert met is not None, came.reason
    assert abs(float(met[1]) - 1.0) < 0.05, came.reason
