"""Claims about the draft of a robot.toml: it fits its model, and goes over nothing."""

import tomllib
from pathlib import Path

import mujoco
import pytest
from robot_builders import foreign_mjcf, qrio_copy

from treadwell.errors import InputError
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
