"""Robots of a public collection, whose models are no part of the project: Booster T1, Toddlerbot.

`TREADWELL_DATA` says where the models are. Each is drafted from its model alone, and each has a
`robot.toml` in `tests/data` that was drafted so and read through.
"""

import os
import shutil
from pathlib import Path

import pytest

from treadwell.robot.file import RobotFile
from treadwell.robot.load import load_folder
from treadwell.robot.report import report_on
from treadwell.robot.template import write_template
from treadwell.robot_trial import walk_a_metre

DATA = Path(os.environ.get("TREADWELL_DATA", "")) / "robots"
TOLD = Path(__file__).parent / "data"
ROBOTS = {"booster_t1": "booster_t1", "toddlerbot": "toddlerbot_2xc"}
"""Folder of `tests/data` -> folder of the collection."""

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        not os.environ.get("TREADWELL_DATA") or not (DATA / "booster_t1").is_dir(),
        reason="TREADWELL_DATA does not say where robots/booster_t1 is",
    ),
]


def model_folder(folder: Path, name: str) -> Path:
    """A folder with the model alone."""
    copied = Path(shutil.copytree(DATA / ROBOTS[name], folder / name))
    for path in [copied, *copied.rglob("*")]:
        path.chmod(0o755 if path.is_dir() else 0o644)
    return copied


@pytest.mark.parametrize("name", ROBOTS)
def test_the_robot_toml_of_tests_data_fits_the_model(tmp_path: Path, name: str) -> None:
    folder = model_folder(tmp_path, name)
    shutil.copy(TOLD / name / "robot.toml", folder)
    report = report_on(folder)
    assert report["fits"], report["problems"]
    assert not report["notes"]


@pytest.mark.parametrize("name", ROBOTS)
def test_the_draft_finds_what_the_model_says_and_needs_no_edit(tmp_path: Path, name: str) -> None:
    folder = model_folder(tmp_path, name)
    write_template(folder)
    drafted, told = load_folder(folder).file, load_folder_told(tmp_path, name)
    assert report_on(folder)["fits"], report_on(folder)["problems"]
    for side in ("left", "right"):
        ours, theirs = getattr(drafted.legs, side), getattr(told.legs, side)
        assert ours.joints == theirs.joints
        assert ours.sole == theirs.sole
    assert (drafted.head, drafted.trunk) == (told.head, told.trunk)


def load_folder_told(folder: Path, name: str) -> RobotFile:
    told = model_folder(folder / "told", name)
    shutil.copy(TOLD / name / "robot.toml", told)
    return load_folder(told).file


def test_the_motors_of_a_t1_are_its_models_and_those_of_a_toddlerbot_are_said_to_be_guessed(
    tmp_path: Path,
) -> None:
    text = write_template(model_folder(tmp_path, "booster_t1")).read_text(encoding="utf-8")
    assert "peak_torque = 60" in text
    assert "by the model: actuatorfrcrange" in text
    text = write_template(model_folder(tmp_path, "toddlerbot")).read_text(encoding="utf-8")
    assert "the model says nothing of it: a guess" in text
    assert "by the model" not in text


def test_the_draft_of_a_t1_walks_a_metre(tmp_path: Path) -> None:
    folder = model_folder(tmp_path, "booster_t1")
    write_template(folder)
    walked = walk_a_metre(folder)
    assert walked["passed"], walked
