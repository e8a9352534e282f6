"""Claims about `treadwell robot check`: what it finds, what it misses, and the exit status."""

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from biped_builders import BOX_FOOT, SIX, biped, leg, robot_folder
from robot_builders import foreign_robot, qrio_copy

from treadwell.cli.app import execute
from treadwell.cli.robot import check
from treadwell.errors import InputError
from treadwell.robot.reach import Rise, what_ends
from treadwell.robot.report import report_on
from treadwell.robot.template import write_template

BALL = '<geom type="sphere" size="0.03"/>'
TABLES = ("robot", "body", "legs", "camera", "motors")


@pytest.fixture(scope="module")
def qrio(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    return report_on(qrio_copy(tmp_path_factory.mktemp("report")))


def test_a_folder_that_fits_is_said_to_fit_with_what_is_known_of_qrio(qrio: dict[str, Any]) -> None:
    assert qrio["fits"]
    assert not qrio["problems"]
    assert not qrio["notes"]
    assert qrio["mass"]["total"] == pytest.approx(7.0)
    assert qrio["gait"]["thigh"] == pytest.approx(0.1)
    assert qrio["gait"]["shank"] == pytest.approx(0.105)
    assert qrio["camera"]["height"] == pytest.approx(0.5, abs=0.01)
    assert qrio["soles"]["left"]["length"] == pytest.approx(0.105)
    assert qrio["mirrored"]
    # Published: steps of 50 mm.
    assert qrio["gait"]["up"]["highest"] >= 0.05
    assert qrio["gait"]["down"]["highest"] >= 0.05
    assert json.loads(json.dumps(qrio, allow_nan=False)) == qrio


def test_a_bare_model_is_reported_with_what_a_robot_toml_needs(tmp_path: Path) -> None:
    folder = qrio_copy(tmp_path)
    (folder / "robot.toml").unlink()
    report = report_on(folder)
    assert not report["fits"]
    assert "is missing" in report["problems"][0]
    assert f"`treadwell robot check {folder} --write-template` drafts it" in report["problems"][0]
    assert [line.split(":")[0] for line in report["problems"][1:]] == list(TABLES)
    assert report["legs"]["left"]["joints"][3]["name"] == "left_knee_pitch"
    assert report["mass"]["total"] == pytest.approx(7.0)


def test_legs_without_names_are_no_legs_and_each_joint_of_them_has_its_line(tmp_path: Path) -> None:
    legs = ""
    for y in (0.05, -0.05):
        chain = "<geom size='.02'/>"
        for axis in ("0 0 1", "1 0 0", "0 1 0", "0 1 0", "0 1 0", "1 0 0"):
            hinge = f"<joint axis='{axis}'/><geom size='.02'/>"
            chain = f"<body pos='0 0 -.05'>{hinge}{chain}</body>"
        legs += f"<body pos='0 {y} 0'><geom size='.02'/>{chain}</body>"
    root = f"<body><freejoint/><geom size='.1'/>{legs}</body>"
    folder = tmp_path / "robot"
    folder.mkdir()
    text = f"<mujoco><worldbody>{root}</worldbody></mujoco>"
    (folder / "robot.xml").write_text(text, encoding="utf-8")
    report = report_on(folder)
    assert report["legs"] == {}
    assert sum("joint" in line and "has no name" in line for line in report["problems"]) == 12
    assert "two legs of named hinges" in report["leg_faults"][0]
    with pytest.raises(InputError, match="two legs of named hinges"):
        write_template(folder)


def test_the_title_above_what_is_wrong_with_legs_says_what_it_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    balls = robot_folder(tmp_path, biped(SIX, BALL), "balls")
    execute(["robot", "check", str(balls)])
    shown = capsys.readouterr().out
    assert "no two legs to walk on" in shown
    (fault,) = [line for line in report_on(balls)["leg_faults"] if "the left leg" in line]
    assert fault in " ".join(shown.split())
    assert "mirror" not in shown
    unlike = leg("left", SIX, BOX_FOOT) + leg("right", SIX, BOX_FOOT).replace("-0.7 0.7", "-1 0.2")
    execute(["robot", "check", str(robot_folder(tmp_path, biped(SIX, legs=unlike), "askew"))])
    shown = capsys.readouterr().out
    assert "the legs are no mirror images" in shown
    assert "no two legs" not in shown


@pytest.mark.parametrize(
    ("share", "told"),
    [
        (4.0, "the knee needs 4 times its peak torque"),
        (1.04, "the knee needs 1.04 times its peak torque"),
        (0.95, "the knee needs 95 % of its peak torque, of which 90 % may be used"),
    ],
)
def test_a_step_that_is_too_much_for_a_motor_says_how_much_it_takes(
    share: float, told: str
) -> None:
    assert what_ends(Rise(0.01, True, 0.2, share, "knee", 1.0)) == told


def test_a_pipe_in_a_robot_tomls_place_is_not_waited_for(tmp_path: Path) -> None:
    folder = qrio_copy(tmp_path)
    (folder / "robot.toml").unlink()
    os.mkfifo(folder / "robot.toml")
    assert any("it is no file" in line for line in report_on(folder)["problems"])


def test_every_unknown_and_missing_key_has_its_line(tmp_path: Path) -> None:
    folder = qrio_copy(tmp_path)
    path = folder / "robot.toml"
    text = path.read_text(encoding="utf-8").replace("height = 0.58", "tall = 0.58")
    path.write_text(text, encoding="utf-8")
    problems = report_on(folder)["problems"]
    assert any("body.height: is missing" in line for line in problems)
    assert any(
        "body.tall: unknown key; allowed are torso, radius, height" in line for line in problems
    )


def test_a_sole_that_is_not_where_the_foot_touches_is_noted(tmp_path: Path) -> None:
    folder = qrio_copy(tmp_path)
    path = folder / "robot.toml"
    text = path.read_text(encoding="utf-8").replace("length = 0.105", "length = 0.14")
    path.write_text(text, encoding="utf-8")
    notes = report_on(folder)["notes"]
    assert any("legs.left.sole: differs by 18 mm" in line for line in notes), notes


@pytest.mark.slow
def test_the_verb_ends_with_0_where_it_fits_and_with_2_where_not(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = foreign_robot(tmp_path)
    assert execute(["robot", "check", str(folder)]) == 0
    shown = capsys.readouterr().out
    for word in ("qrio: fits", "7.000 kg", "left_knee_pitch", "highest step up", "105 x 75 mm"):
        assert word in shown
    path = folder / "robot.toml"
    path.write_text(path.read_text(encoding="utf-8") + "\n[fly]\n", encoding="utf-8")
    assert execute(["robot", "check", str(folder), "--json"]) == 2
    document = json.loads(capsys.readouterr().out)
    assert any("fly: unknown key" in line for line in document["problems"])
    assert document["mass"]["total"] == pytest.approx(7.0)


@pytest.mark.slow
def test_what_only_the_core_refuses_is_a_problem_too(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for wrong in ("[navigation.fog]\ncel = 0.04\n", ""):
        folder = qrio_copy(tmp_path / ("fog" if wrong else "gait"))
        path = folder / "robot.toml"
        text = path.read_text(encoding="utf-8")
        text = text.replace("[gait]", wrong + "[gait]" + ("" if wrong else "\nstep_tme = 1.0"))
        path.write_text(text, encoding="utf-8")
        assert check(folder, walk=False, template=False, as_json=True) == 2
        problems = json.loads(capsys.readouterr().out)["problems"]
        assert any(("cel" if wrong else "step_tme") in line for line in problems), problems


@pytest.mark.parametrize(
    ("prepare", "word"),
    [
        (lambda _: None, "no such folder"),
        (lambda folder: folder.mkdir(), "no MJCF"),
        (lambda folder: [folder.mkdir(), *((folder / f"{n}.xml").touch() for n in "ab")], "2 MJCF"),
        (
            lambda folder: [folder.mkdir(), (folder / "a.xml").write_text("<mujoco><x/></mujoco>")],
            "MuJoCo cannot",
        ),
    ],
)
def test_a_folder_without_a_model_is_bad_input(
    tmp_path: Path, prepare: Callable[[Path], object], word: str, capsys: pytest.CaptureFixture[str]
) -> None:
    prepare(tmp_path / "robot")
    assert execute(["robot", "check", str(tmp_path / "robot"), "--json"]) == 2
    captured = capsys.readouterr()
    assert word in json.loads(captured.out)["error"]
    assert "Traceback" not in captured.err


def test_a_robot_that_ships_is_checked_by_its_name_from_anywhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert execute(["robot", "check", "nao", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["fits"]
    assert execute(["robot", "check", "noa"]) == 2
    assert "noa: there is no such folder" in capsys.readouterr().err
