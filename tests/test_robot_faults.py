"""Claims about models that no walker can walk with: `robot check` says why, a line each."""

import json
import re
from pathlib import Path

import pytest
from biped_builders import (
    BACKWARDS,
    BOX_FOOT,
    HEAD,
    PITCH_FIRST,
    SIX,
    biped,
    leg,
    robot_folder,
)

from treadwell.cli.app import execute
from treadwell.robot.report import report_on
from treadwell.robot.template import write_template

WHEEL = '<geom type="cylinder" size="0.05 0.01" quat="0.7071 0.7071 0 0"/>'
POINT = '<geom type="sphere" size="0.02" pos="0 0 -0.02"/>'
LINE = (
    '<geom type="sphere" size="0.005" pos="0.05 0 -0.03"/>'
    '<geom type="sphere" size="0.005" pos="-0.05 0 -0.03"/>'
)
BALL = '<geom type="sphere" size="0.03"/>'
ROLLING = re.sub(
    r'(_5_pitch" axis="0 1 0") range="\S+ \S+"', r"\1", biped((*SIX[:5], "pitch"), WHEEL)
)
FOUR = ("pitch", "knee", "pitch", "roll")
THIRD = leg("left", SIX, BOX_FOOT).replace("left", "third").replace("0 0.05 -0.05", "-.1 0 -0.05")
BOTH = leg("left", SIX, BOX_FOOT) + leg("right", SIX, BOX_FOOT)
UNLIKE = leg("left", SIX, BOX_FOOT) + leg("right", ("yaw", *SIX), BOX_FOOT)
WHEELED = "".join(
    f'<body name="{side}_wheel" pos="0 {y} -0.05"><joint name="{side}" axis="0 1 0"/>{WHEEL}</body>'
    for side, y in (("left", 0.1), ("right", -0.1))
)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (biped(FOUR), "the left leg has 4 hinges (left_0_pitch, left_1_knee"),
        (biped(SIX, legs=BOTH + THIRD), "stands on 3 feet (left_5_roll_link, third_5_roll_link"),
        (biped(SIX, legs=leg("left", SIX, BOX_FOOT)), "stands on 1 foot (left_5_roll_link)"),
        (biped(SIX, legs=UNLIKE), "the left leg has 6 hinges, the right one 7: as many are needed"),
        (biped(SIX, legs=WHEELED), "stands on wheels (left_wheel, right_wheel)"),
        (ROLLING, "stands on wheels (left_5_pitch_link"),
        (biped((*SIX[:5], "pitch"), WHEEL), "the left leg has no sole: 'left_5_pitch_link'"),
        (biped(SIX, BALL), "the left leg has no sole: 'left_5_roll_link' touches the ground in a"),
        (biped(foot=POINT), "the left leg has no sole: 'left_5_roll_link' touches the ground in a"),
        (biped(foot=LINE), "the left leg has no sole: 'left_5_roll_link' touches the ground in a"),
        (biped(("yaw", "roll", "yaw", "roll", "yaw")), "the left leg has no knee"),
    ],
)
def test_each_reason_is_a_line_and_the_status_is_2(
    tmp_path: Path, text: str, line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = robot_folder(tmp_path, text)
    assert execute(["robot", "check", str(folder), "--write-template"]) == 2
    told = capsys.readouterr().err
    assert line in told
    assert "Traceback" not in told
    assert not (folder / "robot.toml").exists()
    report = report_on(folder)
    assert any(line in fault for fault in report["leg_faults"])
    assert not report["unlike"]
    assert not report["mirrored"]


def test_a_model_without_inertia_is_told_what_to_give_which_link(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = biped().replace('<geom type="sphere" size="0.02"/>', "", 1)
    folder = robot_folder(tmp_path, text)
    assert execute(["robot", "check", str(folder)]) == 2
    told = capsys.readouterr().err
    assert "mass and inertia" in told
    assert "<inertial" in told


def test_a_camera_that_looks_backwards_is_not_taken_and_said(tmp_path: Path) -> None:
    folder = robot_folder(tmp_path, biped(SIX, head=HEAD.format(camera=BACKWARDS)))
    path = write_template(folder)
    text = path.read_text(encoding="utf-8")
    assert 'name = "depth"' in text
    begin, end = text.index("[camera.mount]"), text.index("[camera.stereo]")
    taken = text[:begin].replace('name = "depth"', 'name = "eye"') + text[end:]
    path.write_text(taken, encoding="utf-8")
    problems = report_on(folder)["problems"]
    assert any("camera.name: camera 'eye' looks backwards" in line for line in problems), problems


def test_motors_that_cannot_bear_the_weight_are_named_with_what_they_bear(tmp_path: Path) -> None:
    motors = '<motor name="{0}" joint="{0}" ctrlrange="-0.3 0.3"/>'
    folder = robot_folder(tmp_path, biped(SIX, motors=motors))
    write_template(folder)
    problems = report_on(folder)["problems"]
    weak = [line for line in problems if "cannot bear the weight" in line]
    assert len(weak) == 1
    assert "to stand on one leg" in weak[0]
    assert "its peak is 0.3" in weak[0]


def test_a_joint_that_carries_needs_a_motor_and_one_of_an_arm_does_not(tmp_path: Path) -> None:
    arm = (
        '<body name="arm" pos="0 0.12 0.15"><joint name="swings" axis="0 1 0" range="-1 1"/>'
        '<geom type="box" size="0.02 0.02 0.1" pos="0 0 -0.1" mass="0.2"/></body></body>'
        "</worldbody>"
    )
    folder = robot_folder(tmp_path, biped(SIX).replace("</body></worldbody>", arm))
    path = write_template(folder)
    assert "swings" not in path.read_text(encoding="utf-8").split("[motors")[1]
    assert report_on(folder)["fits"], report_on(folder)["problems"]
    before, motors = path.read_text(encoding="utf-8").split("[motors", 1)
    assert '"left_3_knee", ' in motors
    without = motors.replace('"left_3_knee", ', "")
    path.write_text(f"{before}[motors{without}", encoding="utf-8")
    mjcf = folder / "biped.xml"
    motor = '<motor name="left_3_knee" joint="left_3_knee" ctrlrange="-12 12"/>'
    model = mjcf.read_text(encoding="utf-8")
    assert motor in model
    mjcf.write_text(model.replace(motor, ""), encoding="utf-8")
    problems = report_on(folder)["problems"]
    assert any("legs.left.joints: joint 'left_3_knee' is in no table" in line for line in problems)


def test_a_report_of_any_order_of_joints_is_whole_as_json(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = robot_folder(tmp_path, biped(PITCH_FIRST))
    write_template(folder)
    execute(["robot", "check", str(folder), "--json"])
    document = json.loads(capsys.readouterr().out)
    assert [leg["role"] for leg in document["legs"]["left"]["joints"]] == [
        "hip pitch",
        "hip roll",
        "hip yaw",
        "knee",
        "ankle pitch",
        "ankle roll",
    ]
