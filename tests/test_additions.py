"""Components that installed packages add: found by entry points, named in scenarios, listed."""

import json
from pathlib import Path

import pytest

import treadwell
from treadwell.additions import additions, class_of, installed, is_component, known
from treadwell.cli.app import execute
from treadwell.components import COMPONENTS
from treadwell.errors import InputError
from treadwell.scenario.loading import load_scenario


def package(folder: Path, name: str, points: str) -> None:
    """Write what the installation of a package leaves."""
    info = folder / f"{name}-1.2.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.2\n")
    (info / "entry_points.txt").write_text(f"[treadwell.components]\n{points}")


@pytest.fixture
def parts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    package(tmp_path, "ours", "planner.straight = user_parts:Straight\n")
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


def test_an_installed_component_is_known_by_its_name(parts: Path) -> None:
    assert parts.is_dir()
    assert additions("planner") == {"straight": "ours 1.2: user_parts:Straight"}
    assert additions("localizer") == {}
    assert known("planner").keys() == {*COMPONENTS["planner"], "straight"}
    assert is_component("planner", "straight")
    assert not is_component("localizer", "straight")
    assert class_of("planner", "straight") == "user_parts:Straight"


@pytest.mark.usefixtures("parts")
def test_a_scenario_names_it_and_its_table(capsys: pytest.CaptureFixture[str]) -> None:
    named = ("navigation.planner=straight", "navigation.straight.points=4")
    episode = treadwell.Episode("open_floor", overrides=("time_limit=1", *named))
    for _ in episode:
        pass
    path = episode.pilot.path()
    assert path is not None
    assert len(path) == 4
    assert execute(["list", "components", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)["components"]
    assert listed["planner"]["straight"] == "ours 1.2: user_parts:Straight"


@pytest.mark.usefixtures("parts")
def test_a_misspelt_name_is_refused_with_those_that_are_there() -> None:
    with pytest.raises(InputError, match=r"a_star, voronoi, .*, straight.*straight"):
        load_scenario("open_floor", overrides=("navigation.planner=strait",))
    with pytest.raises(InputError, match="unknown key"):
        load_scenario("open_floor", overrides=("navigation.straight.points=4",))


def test_an_entry_point_takes_no_name_that_is_taken_and_needs_a_slot(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bad = "planner.a_star = x:A\nnavigator.b = x:B\nc = x:C\nplanner.no-name = x:D\n"
    package(tmp_path, "odd", bad)
    monkeypatch.syspath_prepend(tmp_path)
    assert [name for slot in COMPONENTS for name in installed(slot)] == []


@pytest.mark.usefixtures("parts")
def test_a_name_that_two_packages_bring_is_refused_with_both(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = tmp_path / "other"
    other.mkdir()
    package(other, "theirs", "planner.straight = their_parts:Straight\n")
    monkeypatch.syspath_prepend(other)
    with pytest.raises(InputError, match=r"ours 1\.2: .* and theirs 1\.2: "):
        class_of("planner", "straight")
    with pytest.raises(InputError, match="no installed package brings wandering"):
        class_of("planner", "wandering")


def test_an_installed_component_that_cannot_be_imported_is_bad_input(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package(tmp_path, "gone", "planner.gone = no_such_package:Planner\n")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(InputError, match=r"navigation\.planner: cannot import no_such_package"):
        treadwell.Episode("open_floor", overrides=("navigation.planner=gone",))
