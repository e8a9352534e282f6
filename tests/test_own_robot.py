"""ROBOTIS OP3, which none of us made: its model from MuJoCo Menagerie as it is, and a robot.toml.

The model is no part of the project: `TREADWELL_DATA` says where it is. What is tested here is that
a folder outside the project is enough, and no line of code knows of it.
"""

import json
import os
import shutil
from pathlib import Path

import pytest

import treadwell
from treadwell.cli.app import execute
from treadwell.robot.load import load_folder
from treadwell.robot.report import report_on
from treadwell.robot.template import write_template
from treadwell.robot_trial import walk_a_metre

DATA = Path(os.environ.get("TREADWELL_DATA", "")) / "robot_op3"
TOLD = Path(__file__).parent / "data" / "op3" / "robot.toml"

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        not os.environ.get("TREADWELL_DATA") or not (DATA / "op3_novis.xml").is_file(),
        reason="TREADWELL_DATA does not say where robot_op3 is",
    ),
]


def model_folder(folder: Path) -> Path:
    """A folder with the model alone; its visual meshes are not among the data."""
    folder.mkdir()
    shutil.copy(DATA / "op3_novis.xml", folder / "op3.xml")
    shutil.copytree(DATA / "assets", folder / "assets")
    return folder


@pytest.fixture(scope="module")
def op3(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = model_folder(tmp_path_factory.mktemp("outside") / "op3")
    shutil.copy(TOLD, folder / "robot.toml")
    return folder


def test_the_report_finds_the_robot_that_its_sheet_describes(op3: Path) -> None:
    report = report_on(op3)
    assert report["fits"], report["problems"]
    assert report["mirrored"]
    assert not report["notes"]
    assert report["mass"]["total"] == pytest.approx(3.1475, abs=1e-3)
    assert report["gait"]["thigh"] == pytest.approx(0.11015)
    assert report["gait"]["shank"] == pytest.approx(0.110)
    assert report["gait"]["ankle_height"] == pytest.approx(0.0305)
    assert len(report["motors"]) == 20
    assert report["gait"]["up"]["highest"] >= 0.03


def test_the_bare_model_is_reported_and_its_draft_walks_a_metre(tmp_path: Path) -> None:
    folder = model_folder(tmp_path / "bare")
    report = report_on(folder)
    assert not report["fits"]
    assert len(report["without_range"]) == 20
    assert {actuator["kind"] for actuator in report["actuators"]} == {"servo"}
    write_template(folder)
    assert load_folder(folder).file.legs.left.sole.length == pytest.approx(0.127)
    walked = walk_a_metre(folder)
    assert walked["passed"], walked


@pytest.mark.long
def test_it_walks_a_metre_and_says_so(op3: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["robot", "check", str(op3), "--walk", "--json"]) == 0
    walked = json.loads(capsys.readouterr().out)["walk"]
    assert walked["falls"] == 0
    assert walked["speed"] > 0.05


def test_it_walks_the_slalom_without_a_touch(op3: Path, tmp_path: Path) -> None:
    result = treadwell.run("slalom", robot=str(op3), seed=3, out=tmp_path / "run", record=False)
    assert result.passed, result


def test_it_climbs_steps_of_thirty_millimetres(op3: Path, tmp_path: Path) -> None:
    result = treadwell.run("stairs_up", robot=str(op3), seed=3, out=tmp_path / "run", record=False)
    assert result.passed, result
    assert result.result.stairs_climbed == 4
