"""Claims about a robot's first metre."""

from pathlib import Path

import pytest
from robot_builders import foreign_robot, qrio_copy

from treadwell.robot_trial import refused, walk_a_metre


@pytest.mark.slow
def test_a_robot_that_servos_of_mujoco_drove_walks_a_metre(tmp_path: Path) -> None:
    walked = walk_a_metre(foreign_robot(tmp_path))
    assert walked["passed"], walked
    assert walked["falls"] == 0
    assert walked["walked"] == pytest.approx(1.0, abs=0.15)
    assert 0.05 < walked["speed"] < 0.2


@pytest.mark.slow
def test_what_the_navigation_refuses_is_said_in_lines(tmp_path: Path) -> None:
    folder = qrio_copy(tmp_path)
    assert refused(folder) == []
    path = folder / "robot.toml"
    path.write_text(path.read_text(encoding="utf-8") + "\n[navigation.fog]\ncel = 1\n", "utf-8")
    assert any("cel" in line for line in refused(folder))
