"""A stated limit (IROS 2004, section III): what looks like a step and is soft is stepped on."""

from pathlib import Path

import pytest

from treadwell.episode import Episode

pytestmark = pytest.mark.scenario

SOFT_BOX = """
<mujoco model="soft_box">
  <worldbody>
    <geom name="soft" type="box" pos="0.85 0 0.015" size="0.25 0.5 0.015" priority="1"
          friction="0.8 0.005 0.0001" solref="-1000 -60" solimp="0.5 0.5 0.001"/>
  </worldbody>
</mujoco>
"""
COURSE = """
schema = 1
name = "stair_soft"
[start]
position = [0.1, 0.0]
[goal]
position = [1.6, 0.0]
[[course]]
kind = "mjcf"
name = "soft box"
file = "soft_box.xml"
[[course]]
kind = "wall"
from = [-0.7, 0.525]
to = [2.0, 0.525]
height = 0.6
[[course]]
kind = "wall"
from = [-0.7, -0.525]
to = [2.0, -0.525]
height = 0.6
"""
TOP = 0.03
ON_IT = ((0.62, 1.08), (0.002, 0.026))
"""Metres: x of a sole's middle on the box, and its height once it has sunk by 4 mm or more."""


def test_a_soft_box_looks_like_a_step_and_the_feet_sink_into_it(tmp_path: Path) -> None:
    (tmp_path / "soft_box.xml").write_text(SOFT_BOX)
    (tmp_path / "stair_soft.toml").write_text(COURSE)
    episode = Episode(tmp_path / "stair_soft.toml", seed=0)
    taken_for: list[float] = []
    sunk = None
    while episode.verdict is None and sunk is None:
        episode.tick()
        for climb in episode.pilot.climbs() or []:
            taken_for.append(climb.steps[0].rise)
        (near, far), (low, high) = ON_IT
        touching = (episode.judge.touch.left, episode.judge.touch.right)
        for sole, touches in zip(episode.judge.soles or (), touching, strict=False):
            if touches and near < sole.x < far and low < sole.z < high:
                sunk = TOP - sole.z
    assert taken_for[0] == pytest.approx(TOP, abs=0.004)
    assert sunk is not None, episode.verdict
