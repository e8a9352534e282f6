"""What is too near to be seen: who sees nothing looks elsewhere and turns before it gives up."""

from pathlib import Path

import pytest

import treadwell

pytestmark = pytest.mark.scenario

FACING_WALL = """
schema = 1
name = "facing_wall"
time_limit = 120.0
[start]
position = [0.0, 0.0]
yaw = {yaw}
[goal]
position = [-1.5, 0.3]
radius = 0.15
[[course]]
kind = "wall"
name = "wall"
from = [0.325, -1.5]
to = [0.325, 1.5]
height = 0.6
thickness = 0.05
"""


@pytest.mark.parametrize(
    ("robot", "yaw"),
    [
        ("qrio", -0.1),
        ("nao", 0.08),
        pytest.param("qrio", 0.08, marks=pytest.mark.long),
        pytest.param("nao", -0.1, marks=pytest.mark.long),
    ],
)
def test_who_starts_a_foot_before_a_wall_turns_about_and_goes(
    tmp_path: Path, robot: str, yaw: float
) -> None:
    scenario = tmp_path / "facing_wall.toml"
    scenario.write_text(FACING_WALL.format(yaw=yaw), encoding="utf-8")
    result = treadwell.run(scenario, robot=robot, record=False, out=tmp_path / "run").result
    assert (result.outcome, result.falls, result.collisions) == ("goal_reached", 0, []), (
        result.reason
    )
