"""How large a robot is, and what follows of it for what nobody said."""

import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest
from robot_builders import qrio_copy

from treadwell.reference.parameters import find_parameters
from treadwell.robot.anatomy import Anatomy
from treadwell.robot.load import Robot, load_folder, load_robot
from treadwell.robot.size import Upright

LENGTHS = ("pos", "size", "fromto")
CROSSED_HIP = """
<mujoco>
  <worldbody>
    <body name="pelvis" pos="0 0 1">
      <freejoint name="base"/>
      <inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
      <body name="hip" pos="0 0.1 -0.05">
        <joint name="pitch" axis="0 1 0"/>
        <inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
        <body name="across" pos="0 0 -0.02">
          <joint name="roll" axis="1 0 0"/>
          <inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
          <body name="thigh">
            <joint name="yaw" axis="0 0 1"/>
            <inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
            <body name="shank" pos="0.03 0 -0.4">
              <joint name="knee" axis="0 1 0"/>
              <inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
              <body name="foot" pos="0 0 -0.3">
                <joint name="ankle" axis="0 1 0"/>
                <inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
              </body>
            </body>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def larger_qrio(folder: Path, times: float) -> Robot:
    """Return qrio with all lengths of its model so many times as large."""
    copy = qrio_copy(folder)

    def product(found: re.Match[str]) -> str:
        values = " ".join(repr(float(value) * times) for value in found[2].split())
        return f'{found[1]}"{values}"'

    path = copy / "qrio.xml"
    text = path.read_text()
    for name in LENGTHS:
        text = re.sub(rf'(\s{name}=)"([^"]+)"', product, text)
    height = float(re.findall(r'qpos="0 0 (\S+) ', text)[0])
    path.write_text(text.replace(f'qpos="0 0 {height} ', f'qpos="0 0 {height * times} '))
    path = copy / "robot.toml"
    text = path.read_text()
    text = text.replace("position = [0.0, 0.0, -0.045]", f"position = [0.0, 0.0, {-0.045 * times}]")
    text = re.sub(r"(?m)^(eye_\w+|foot_side) = .*$", "", text)
    path.write_text(text)
    return load_folder(copy)


def test_the_shipped_robots_have_the_defaults_as_they_are() -> None:
    for name in ("qrio", "nao"):
        robot = load_robot(name)
        told = robot.description()
        assert robot.scale == told["scale"] == 1.0
        assert (told["head"]["eye_height"], told["head"]["eye_ahead"]) == (0.45, 0.04)
        assert told["body"]["foot_side"] == 0.06
        plain = {row.key: row.default for row in find_parameters()}
        own = {row.key: row.default for row in find_parameters(robot=robot)}
        changed = {key for key in plain if plain[key] != own[key]}
        assert all(_said(robot, key) is not None for key in changed)


def _said(robot: Robot, key: str) -> Any:  # noqa: ANN401
    table: Any = {"gait": robot.file.gait, "navigation": robot.file.navigation}
    for word in key.split("."):
        table = table.get(word, {})
    return table


@pytest.mark.parametrize("times", [0.5, 2.3])
def test_a_robot_as_much_larger_as_its_legs(tmp_path: Path, times: float) -> None:
    robot = larger_qrio(tmp_path, times)
    assert robot.scale == pytest.approx(times)
    told = robot.description()
    assert told["scale"] == robot.scale
    assert told["head"]["eye_height"] == pytest.approx(0.498 * times, abs=1e-3)
    assert told["head"]["eye_ahead"] == pytest.approx(0.048 * times, abs=1e-3)
    assert told["body"]["foot_side"] == pytest.approx(0.75 * (0.0425 * times + 0.0375))
    rows = {row.key: row for row in find_parameters(robot=robot)}
    assert rows["navigation.fog.cell"].default == pytest.approx(0.04 * times)
    assert rows["navigation.walking.forward_speed"].default == pytest.approx(0.1 * times**0.5)
    assert rows["navigation.walking.tuning.turn.gain"].default == pytest.approx(1.5 / times**0.5)
    assert rows["navigation.fog.max_range"].default == 4.0
    assert rows["navigation.fog.max_range"].owner == "camera"
    # Its camera is qrio's, baseline and all.
    noise = rows["navigation.stairs.tuning.view.height_noise"].default
    assert noise == pytest.approx(0.025, rel=2e-3)
    # What its file says goes over what follows from its size.
    assert rows["gait.step_time"].default == robot.file.gait["step_time"]
    assert rows["gait.climb_rise"].default == pytest.approx(0.055 * times)


def test_a_file_may_say_the_scale(tmp_path: Path) -> None:
    copy = qrio_copy(tmp_path)
    path = copy / "robot.toml"
    path.write_text(path.read_text().replace("[body]", "scale = 1.25\n\n[body]", 1))
    assert load_folder(copy).scale == 1.25


def test_a_leg_is_thigh_shank_and_ankle_whatever_the_order_of_its_joints() -> None:
    found = Anatomy.of(mujoco.MjModel.from_xml_string(CROSSED_HIP))
    stance = Upright(found.model, found.data)
    sole = SimpleNamespace(link="foot", position=(0.02, 0.0, -0.06))
    leg: Any = SimpleNamespace(joints=("pitch", "roll", "yaw", "knee", "ankle"), sole=sole)
    # The pitch axis passes 2 cm above the point in which the other two meet.
    thigh = np.hypot(0.03, 0.41)
    assert stance.leg_length(leg) == pytest.approx(thigh + 0.3 + 0.06, abs=1e-6)
    # The same with the knee bent.
    found.data.qpos[10:12] = 0.6, -0.6
    mujoco.mj_kinematics(found.model, found.data)
    assert stance.leg_length(leg) == pytest.approx(thigh + 0.3 + 0.06, abs=1e-6)
