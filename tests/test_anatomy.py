"""Claims about what a model shows by itself: legs, soles, what turns a camera."""

import mujoco
import pytest

from treadwell.robot.anatomy import Anatomy
from treadwell.robot.load import Robot, load_robot, robot_names


@pytest.fixture(scope="module", params=robot_names())
def robot(request: pytest.FixtureRequest) -> Robot:
    return load_robot(request.param)


def test_legs_are_found_without_being_told(robot: Robot) -> None:
    found = Anatomy.of(robot.nominal).legs()
    for side, told in (("left", robot.file.legs.left), ("right", robot.file.legs.right)):
        assert found[side].joints == told.joints
        assert found[side].foot == told.sole.link


def test_a_sole_is_what_touches_the_ground(robot: Robot) -> None:
    told = robot.file.legs.left.sole
    seen = Anatomy.of(robot.nominal).legs()["left"].sole
    assert seen.position == pytest.approx(told.position, abs=5e-3)
    assert (seen.length, seen.width) == pytest.approx((told.length, told.width), abs=8e-3)
    assert seen.orientation is None


def test_the_legs_that_ship_are_mirror_images(robot: Robot) -> None:
    left, right = robot.file.legs.left.joints, robot.file.legs.right.joints
    assert Anatomy.of(robot.nominal).differences(left, right) == []


def test_a_joint_with_another_place_axis_or_range_is_named() -> None:
    for change, word in (
        (('name="right_shank" pos="0 0 -0.1"', 'name="right_shank" pos="0 0 -0.11"'), "10.0 mm"),
        (('"right_hip_yaw" class="leg_joint" axis="0 0 1"',
          '"right_hip_yaw" class="leg_joint" axis="0 1 0"'), "axes"),
        (('axis="0 0 1" range="-0.9 0.7"', 'axis="0 0 1" range="-0.7 0.7"'), "ranges"),
    ):  # fmt: skip
        robot = load_robot("qrio")
        text = (robot.folder / "qrio.xml").read_text(encoding="utf-8")
        assert change[0] in text
        model = mujoco.MjModel.from_xml_string(text.replace(*change))
        legs = robot.file.legs
        found = Anatomy.of(model).differences(legs.left.joints, legs.right.joints)
        assert any(word in line and "right_" in line for line in found), found
