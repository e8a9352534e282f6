"""Claims about what a model shows by itself: legs, soles, what turns a camera."""

import mujoco
import pytest
from biped_builders import BOX_FOOT, PITCH_FIRST, SIX, biped, leg

from treadwell.robot.anatomy import Anatomy, nearest_to_zero
from treadwell.robot.load import Robot, load_robot, robot_names

BOTH = leg("left", SIX, BOX_FOOT) + leg("right", SIX, BOX_FOOT)


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


def test_a_joint_whose_range_does_not_hold_zero_is_at_its_nearest_end() -> None:
    model = mujoco.MjModel.from_xml_string(biped(SIX).replace("-0.05 2.3", "0.2 2.3"))
    qpos = nearest_to_zero(model)
    assert qpos[model.joint("left_3_knee").qposadr[0]] == 0.2
    assert qpos[model.joint("left_0_yaw").qposadr[0]] == 0.0


@pytest.mark.parametrize(
    ("joints", "roles"),
    [
        (SIX, ["hip yaw", "hip roll", "hip pitch", "knee", "ankle pitch", "ankle roll"]),
        (PITCH_FIRST, ["hip pitch", "hip roll", "hip yaw", "knee", "ankle pitch", "ankle roll"]),
        (
            ("roll", "yaw", "pitch", "knee", "roll", "pitch"),
            ["hip roll", "hip yaw", "hip pitch", "knee", "ankle roll", "ankle pitch"],
        ),
        (SIX[:5], ["hip yaw", "hip roll", "hip pitch", "knee", "ankle pitch"]),
        (("roll", "pitch", "knee", "pitch", "roll"), ["hip roll", "hip pitch", "knee", "ankle "]),
        ((*SIX, "yaw"), ["hip yaw", "hip roll", "hip pitch", "knee", "ankle pitch", "ankle roll"]),
    ],
)
def test_joints_are_known_by_what_they_do(joints: tuple[str, ...], roles: list[str]) -> None:
    legs = Anatomy.of(mujoco.MjModel.from_xml_string(biped(joints))).legs()
    for side in ("left", "right"):
        found = legs[side]
        assert [name.split("_")[1] for name in found.joints] == [str(n) for n in range(len(joints))]
        for role, wanted in zip(found.roles, roles, strict=False):
            assert role.startswith(wanted)


def test_joints_of_what_both_legs_hang_on_are_no_legs() -> None:
    waist = '<body name="waist"><joint name="waist" axis="0 0 1" range="-1 1"/>'
    waist += f'<geom size="0.02"/>{BOTH}</body>'
    legs = Anatomy.of(mujoco.MjModel.from_xml_string(biped(SIX, legs=waist))).legs()
    assert len(legs["left"].joints) == 6
