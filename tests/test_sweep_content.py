"""What a sweep's episodes depend on: a change of any of it is another sweep."""

import shutil
from pathlib import Path

import pytest
from robot_builders import qrio_copy
from sweep_builders import short

from treadwell.own_core import VARIABLE
from treadwell.sweeps.content import build_hash
from treadwell.sweeps.request import Line, make_line

HERE = Path(__file__).parent
MESH = """
[[course]]
kind = "mesh"
position = [2.0, 2.0, 0.0]
file = "wedge.stl"
"""
FACES = ("000 010 100", "000 100 001", "000 001 010", "100 010 001")


def wedge(size: float) -> str:
    """A tetrahedron as STL."""
    text = "solid w\n"
    for face in FACES:
        text += "facet normal 0 0 0\nouter loop\n"
        for corner in face.split():
            text += "vertex " + " ".join(str(size * int(digit)) for digit in corner) + "\n"
        text += "endloop\nendfacet\n"
    return text + "endsolid w\n"


def line(scenario: str, *settings: str, robot: str | None = None) -> Line:
    return make_line(scenario, [0], robot, settings)


def test_the_same_is_the_same(tmp_path: Path) -> None:
    scenario = short(tmp_path)
    assert line(scenario) == line(scenario)
    assert line(scenario).hash != line(scenario, "physics.friction=0.7").hash


def test_a_planner_that_was_edited_is_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scenario = short(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    package = tmp_path / "my_parts_of_a_sweep"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "planner.py").write_text("from . import helper\nclass Mine: ...\n")
    (package / "helper.py").write_text("STEP = 1\n")
    setting = "navigation.planner=my_parts_of_a_sweep.planner:Mine"
    before = line(scenario, setting)
    assert before.parts
    (package / "helper.py").write_text("STEP = 2\n")
    after = line(scenario, setting)
    assert after.classes != before.classes
    assert after.hash == before.hash
    (package / "helper.py").write_text("STEP = 2  # a number\n")
    assert line(scenario, setting) == after
    assert line(scenario, "navigation.planner=there_is_no_such_module:Mine").parts


def test_a_robots_mesh_that_was_changed_is_another_robot(tmp_path: Path) -> None:
    scenario, robot = short(tmp_path), qrio_copy(tmp_path)
    (robot / "assets").mkdir(exist_ok=True)
    (robot / "assets" / "shell.stl").write_bytes(b"before")
    before = line(scenario, robot=str(robot)).hash
    (robot / "assets" / "shell.stl").write_bytes(b"after")
    assert line(scenario, robot=str(robot)).hash != before


def test_a_mesh_of_the_course_that_was_changed_is_another_course(tmp_path: Path) -> None:
    scenario, mesh = Path(short(tmp_path)), tmp_path / "wedge.stl"
    scenario.write_text(scenario.read_text() + MESH)
    mesh.write_text(wedge(0.1))
    before = line(str(scenario)).hash
    mesh.write_text(wedge(0.2))
    assert line(str(scenario)).hash != before


def test_a_core_of_ones_own_is_another_build(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ours = build_hash()
    core = tmp_path / "core.so"
    core.write_bytes(b"one")
    monkeypatch.setenv(VARIABLE, str(core))
    one = build_hash()
    core.write_bytes(b"two")
    assert len({ours, one, build_hash()}) == 3


def test_a_line_says_what_run_is_given(tmp_path: Path) -> None:
    scenario = short(tmp_path)
    assert line(scenario).document()["file"] == scenario
    assert line("slalom").document()["file"] == "slalom"
    assert line("slalom", robot="nao").document()["robot_given"] == "nao"
    moved = Path(shutil.copy(scenario, tmp_path / "slalom.toml"))
    assert line(str(moved)).document()["file"] == str(moved)
