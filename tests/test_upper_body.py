"""Claims about what is above the legs: torso, trunk, arms, head, and a camera."""

import mujoco
import pytest
from biped_builders import BACKWARDS, CAMERA, HEAD, SIX, biped

from treadwell.robot.anatomy import Anatomy
from treadwell.robot.load import Robot, load_robot, robot_names
from treadwell.robot.upper_body import UpperBody


@pytest.fixture(scope="module", params=robot_names())
def robot(request: pytest.FixtureRequest) -> Robot:
    return load_robot(request.param)


def upper_body(text: str) -> UpperBody:
    return UpperBody(Anatomy.of(mujoco.MjModel.from_xml_string(text)))


def test_the_joints_above_the_camera_turn_and_nod_it(robot: Robot) -> None:
    head = UpperBody(Anatomy.of(robot.nominal)).head()
    assert (head.pan, head.tilt) == (robot.file.head.pan, robot.file.head.tilt)
    assert head.camera == robot.file.camera.name


def test_torso_and_trunk_are_found_without_being_told(robot: Robot) -> None:
    upper = UpperBody(Anatomy.of(robot.nominal))
    assert robot.nominal.body(upper.torso).name == robot.file.body.torso
    assert tuple(upper.trunk) == robot.file.trunk.joints
    assert len(upper.arms) == 2


def test_a_camera_counts_only_where_it_looks_ahead() -> None:
    head = upper_body(biped(SIX, head=HEAD.format(camera=CAMERA))).head()
    assert (head.camera, head.pan, head.tilt) == ("eye", "head pan", "head.tilt")
    head = upper_body(biped(SIX, head=HEAD.format(camera=BACKWARDS))).head()
    assert head.camera is None
    assert head.lens[0] > 0.04
    assert "its name says so" in head.how


def test_a_robot_without_a_head_has_its_camera_in_front_of_its_top() -> None:
    head = upper_body(biped(SIX, head="")).head()
    assert (head.pan, head.tilt) == (None, None)
    assert head.lens[0] == pytest.approx(0.055)
    assert 0.1 < head.lens[2] < 0.2
    assert "no head" in head.how


def test_arms_hang_down_and_touch_nothing() -> None:
    arms = "".join(
        f'<body name="{side} arm" pos="0 {0.09 * sign} 0.18"><joint name="{side}" axis="1 0 0" '
        f'range="-1.6 1.6"/><geom type="capsule" size="0.015" fromto="0 0 0 0 {0.2 * sign} 0" '
        f'mass="0.2"/></body>'
        for side, sign in (("left", 1), ("right", -1))
    )
    upper = upper_body(biped(SIX, head=HEAD.format(camera="") + arms))
    rest = upper.resting_arms({})
    assert rest["left"] < -1.0
    assert rest["right"] == pytest.approx(-rest["left"])
