"""Claims about the draft of a robot.toml: it fits its model, and goes over nothing."""

import tomllib
from pathlib import Path

import mujoco
import numpy as np
import pytest
from biped_builders import BOX_FOOT, HEAD, SIX, biped, leg, robot_folder
from robot_builders import foreign_mjcf, qrio_copy

from treadwell.cli.app import execute
from treadwell.errors import InputError
from treadwell.robot.anatomy import Anatomy
from treadwell.robot.load import load_folder, load_robot
from treadwell.robot.report import report_on
from treadwell.robot.template import draft, write_template


@pytest.mark.slow
def test_the_draft_for_a_foreign_model_fits_it(tmp_path: Path) -> None:
    folder = qrio_copy(tmp_path)
    told = tomllib.loads((folder / "robot.toml").read_text(encoding="utf-8"))
    (folder / "robot.toml").unlink()
    mjcf = folder / "qrio.xml"
    mjcf.write_text(foreign_mjcf(mjcf.read_text(encoding="utf-8")), encoding="utf-8")
    path = write_template(folder)
    guessed = tomllib.loads(path.read_text(encoding="utf-8"))
    report = report_on(folder)
    assert report["fits"], report["problems"]
    for side in ("left", "right"):
        assert guessed["legs"][side]["joints"] == told["legs"][side]["joints"]
    for joint in ("pan", "tilt"):
        assert guessed["head"][joint] == told["head"][joint]
    assert report["stand"]["mass_ahead_of_soles"] == pytest.approx(0.0, abs=2e-3)
    robot = load_folder(folder)
    data = mujoco.MjData(robot.nominal)
    data.qpos[:] = robot.stand_qpos
    mujoco.mj_forward(robot.nominal, data)
    assert data.site("left_sole").xpos[2] == pytest.approx(0.0, abs=1e-4)


def test_a_keyframe_and_ranges_of_the_model_are_not_drafted_again() -> None:
    model = load_robot("qrio").nominal
    guessed = tomllib.loads(draft("qrio", "qrio.xml", model))
    assert "stand" not in guessed
    assert "ranges" not in guessed
    torques = {motors["peak_torque"] for motors in guessed["motors"].values()}
    assert torques == {6.0, 4.0, 1.5, 1.0}


def test_a_draft_does_not_go_over_a_robot_toml(tmp_path: Path) -> None:
    folder = qrio_copy(tmp_path)
    before = (folder / "robot.toml").read_bytes()
    with pytest.raises(InputError, match="is there already"):
        write_template(folder)
    assert (folder / "robot.toml").read_bytes() == before


def test_a_model_without_two_legs_has_no_draft() -> None:
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>"
    )
    with pytest.raises(InputError, match=r"stands on 1 foot \(body 1\): two legs"):
        draft("ball", "ball.xml", model)


CORNERS = "".join(
    f'<geom type="sphere" size="0.005" pos="{x} {y} -0.03"/>'
    for x in (-0.04, 0.07)
    for y in (-0.03, 0.03)
)


@pytest.mark.parametrize(("foot", "plate"), [(CORNERS, 0.01), (BOX_FOOT, None)])
def test_a_foot_on_points_gets_the_plate_that_they_stand_for(
    tmp_path: Path, foot: str, plate: float | None
) -> None:
    folder = robot_folder(tmp_path, biped(SIX, foot))
    sole = tomllib.loads(write_template(folder).read_text(encoding="utf-8"))["legs"]["left"]["sole"]
    assert sole.get("plate") == (None if plate is None else pytest.approx(plate))
    model = load_folder(folder).nominal
    boxes = [
        geom
        for geom in range(model.ngeom)
        if model.geom_bodyid[geom] == model.body(sole["link"]).id
        and model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_BOX
    ]
    assert len(boxes) == 1
    if plate is not None:
        half = model.geom_size[boxes[0]]
        assert half == pytest.approx([0.055, 0.03, 0.005])
        bottom = model.geom_pos[boxes[0]] - (0.0, 0.0, half[2])
        assert bottom == pytest.approx(sole["position"], abs=1e-9)
        # What touches the ground now is the sole that was drafted.
        seen = Anatomy.of(model).legs()["left"].sole
        assert (seen.length, seen.width) == pytest.approx((sole["length"], sole["width"]))
        assert seen.plate == 0.0


def _stance(folder: Path) -> tuple[dict[str, float], float]:
    """Return the drafted angles, and how far the feet stand apart, m."""
    told = tomllib.loads(write_template(folder).read_text(encoding="utf-8"))
    robot = load_folder(folder)
    data = mujoco.MjData(robot.nominal)
    data.qpos[:] = robot.stand_qpos
    mujoco.mj_kinematics(robot.nominal, data)
    places = []
    for side in ("left", "right"):
        sole = told["legs"][side]["sole"]
        body = data.body(sole["link"])
        places.append(body.xpos + body.xmat.reshape(3, 3) @ np.array(sole["position"]))
    return told["stand"], float(places[0][1] - places[1][1])


def test_feet_far_wider_than_the_hips_come_together_and_others_stay(tmp_path: Path) -> None:
    _, near = _stance(robot_folder(tmp_path, biped(SIX), "near"))
    assert near == pytest.approx(0.1, abs=1e-3)
    legs = [
        leg(side, SIX, BOX_FOOT).replace('pos="0 0 -0.12"', f'pos="0 {aside} -0.12"')
        for side, aside in (("left", 0.02), ("right", -0.02))
    ]
    _, apart = _stance(robot_folder(tmp_path, biped(SIX, legs="".join(legs)), "wide"))
    assert apart == pytest.approx(near, abs=5e-3)


def test_the_knees_bend_less_where_an_ankle_leaves_no_room_to_lift_the_foot(
    tmp_path: Path,
) -> None:
    bent, _ = _stance(robot_folder(tmp_path, biped(SIX), "free"))
    stiff = biped(SIX)
    for side in ("left", "right"):
        joint = f'name="{side}_4_pitch" axis="0 1 0" range="-2 1.2"'
        assert joint in stiff
        stiff = stiff.replace(joint, f'name="{side}_4_pitch" axis="0 1 0" range="-0.5 1.2"')
    straight, _ = _stance(robot_folder(tmp_path, stiff, "stiff"))
    assert 0.3 < straight["left_3_knee"] < 0.8 < bent["left_3_knee"]


def test_a_bound_of_all_controls_is_no_torque_and_the_draft_fits(tmp_path: Path) -> None:
    motors = '<motor name="{0}" joint="{0}" ctrlrange="-100 100"/>'
    folder = robot_folder(tmp_path, biped(SIX, motors=motors))
    told = tomllib.loads(write_template(folder).read_text(encoding="utf-8"))
    assert all(group["peak_torque"] < 20.0 for group in told["motors"].values())
    report = report_on(folder)
    assert report["fits"], report["problems"]


@pytest.mark.parametrize(("most", "down"), [("1.3", 0.0), ("0.5", 0.54)])
def test_a_camera_looks_down_as_far_as_the_head_cannot_nod(
    tmp_path: Path, most: str, down: float
) -> None:
    head = HEAD.format(camera="").replace('range="-0.9 1"', f'range="-0.9 {most}"')
    folder = robot_folder(tmp_path, biped(SIX, head=head))
    told = tomllib.loads(write_template(folder).read_text(encoding="utf-8"))
    assert told["camera"]["mount"]["down"] == pytest.approx(down, abs=0.01)
    assert load_folder(folder).file.head.tilt == "head.tilt"


def test_of_several_models_one_can_be_named_and_they_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = robot_folder(tmp_path, biped())
    whole = folder / "biped.xml"
    (folder / "plain.xml").write_text(whole.read_text())
    whole.write_text(whole.read_text().replace("<worldbody>", "<worldbody><no_such_thing/>"))
    drafted = ["robot", "check", str(folder), "--write-template"]
    assert execute(drafted) == 2
    assert "has biped.xml, plain.xml; --model FILE says which" in capsys.readouterr().err
    assert execute([*drafted, "--model", "plan.xml"]) == 2
    assert "there are biped.xml, plain.xml; did you mean 'plain.xml'?" in capsys.readouterr().err
    assert execute([*drafted, "--model", "plain.xml"]) in (0, 2)  # a biped of boxes need not fit
    told = tomllib.loads((folder / "robot.toml").read_text())
    assert told["robot"]["model"] == "plain.xml"


def test_the_model_that_was_taken_of_several_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = robot_folder(tmp_path, biped())
    (folder / "other.xml").write_text((folder / "biped.xml").read_text())
    execute(["robot", "check", str(folder), "--write-template"])
    assert "of biped.xml; --model takes another: other.xml" in capsys.readouterr().err
    assert execute(["robot", "check", str(folder), "--model", "other.xml"]) == 2
    assert "goes with --write-template" in capsys.readouterr().err
