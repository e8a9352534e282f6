"""Short bevels are walked over as the slopes they are, or refused before a foot meets one."""

from pathlib import Path

import pytest

from treadwell.experiments.drawn import write_scenario
from treadwell.experiments.world.courses import door_sill_ramps, ramp_edge
from treadwell.experiments.world.parts import Part
from treadwell.runner import run

pytestmark = pytest.mark.scenario


@pytest.mark.parametrize(
    ("robot", "course"),
    [("qrio", ramp_edge()), pytest.param("nao", door_sill_ramps(), marks=pytest.mark.long)],
    ids=lambda one: str(one)[:4],
)
def test_a_bevel_of_eleven_degrees_is_crossed_or_refused_as_too_steep(
    tmp_path: Path, robot: str, course: Part
) -> None:
    file = write_scenario(tmp_path / "bevel.toml", course)
    came = run(file, robot=robot, seed=0, record=False, out=tmp_path / "run").result
    reason = came.reason or ""
    assert came.outcome == "goal_reached" or reason.startswith("too_steep"), reason
    assert (came.falls, came.collisions) == (0, [])
