"""A setting of a component that was not chosen changes nothing, and whoever gave it is told so."""

import json
import re
from pathlib import Path

import pytest

import treadwell
from treadwell import mapping
from treadwell.cli.app import execute
from treadwell.components import COMPONENTS, TABLES, parameter_tables
from treadwell.errors import InputError
from treadwell.scenario.loading import load_scenario
from treadwell.scenario.unread import unread
from treadwell.sweeps.request import crossed

ELEVATION = "navigation.world_model=elevation"
CELL = "navigation.fog.cell=0.03"
HEAD = 'schema = 1\nname = "x"\n[start]\n[goal]\n'
SENTENCE = (
    "--set navigation.fog.cell changes nothing: navigation.world_model is elevation, "
    "and only fog and octree read it"
)


def test_every_component_has_its_tables_and_no_other() -> None:
    assert {slot: set(names) for slot, names in TABLES.items()} == {
        slot: set(names) for slot, names in COMPONENTS.items()
    }
    of_components = {t for of in TABLES.values() for tables in of.values() for t in tables}
    assert of_components < set(parameter_tables())
    assert {"fog", "a_star", "odometry"} < of_components
    assert not of_components & {"ground", "stairs", "climbing"}  # these are of every run


@pytest.mark.parametrize(
    "settings",
    [
        [CELL],
        ["navigation.world_model=octree", CELL],
        ["navigation.planner=voronoi", "navigation.a_star.unknown_price=2.0"],
        [ELEVATION, "navigation.ground.noise_floor=0.004", "seed=3", "goal.radius=0.2"],
    ],
)
def test_what_is_read_is_not_mentioned(settings: list[str]) -> None:
    assert unread(load_scenario("slalom", overrides=settings)) == {}


def test_what_is_not_read_is_told_with_what_would_read_it() -> None:
    made = load_scenario("slalom", overrides=[ELEVATION, CELL])
    assert unread(made) == {"navigation.fog.cell": SENTENCE}
    by_mapping = {"navigation": {"world_model": "elevation", "fog": {"cell": 0.03}}}
    (told,) = unread(load_scenario("slalom", overrides=by_mapping)).values()
    assert told == SENTENCE.replace("--set", "overrides")


def test_the_settings_of_what_an_object_replaces_are_not_read() -> None:
    made = load_scenario("slalom", overrides=[CELL, "navigation.odometry.tuning={}"])
    (told,) = unread(made, replaced={"world_model": object()}).values()
    assert told.endswith("navigation.world_model is an object, and only fog and octree read it")


def test_check_and_run_say_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["slalom", "--set", ELEVATION, "--set", CELL]
    assert execute(["check", *asked]) == 0
    assert capsys.readouterr().err == f"note:      {SENTENCE}\n"
    assert execute(["check", *asked, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["unread"] == [SENTENCE]
    short = ["--set", "time_limit=0.1", "--no-record", "--out", str(tmp_path / "run")]
    assert execute(["run", *asked, *short]) == 1
    assert SENTENCE in capsys.readouterr().err


def test_an_episode_warns_of_it() -> None:
    with pytest.warns(UserWarning, match=re.escape(SENTENCE)) as told:
        treadwell.Episode("slalom", overrides=[ELEVATION, CELL])
    assert [Path(one.filename) for one in told] == [Path(__file__)]


def test_a_sweep_tells_what_none_of_its_lines_reads() -> None:
    one, both = (ELEVATION,), ("navigation.world_model=fog,elevation",)
    asked = {"seeds": range(2), "settings": (CELL,)}
    assert crossed(["slalom", "doorway"], vary=one, **asked).unread() == [SENTENCE]
    assert crossed(["slalom", "doorway"], vary=both, **asked).unread() == []


def test_a_table_of_the_file_that_nothing_reads_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "two_choices.toml"
    text = HEAD + "[navigation.elevation]\ncell = 0.05\n"
    file.write_text(text)
    told = "[navigation.elevation] changes nothing: navigation.world_model is fog, and only"
    assert execute(["check", str(file)]) == 0
    assert capsys.readouterr().err.startswith(f"note:      {told} elevation, ")
    assert execute(["check", str(file), "--set", "navigation.world_model=elevation"]) == 0
    assert not capsys.readouterr().err


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("[navigation.elevation]\ncel = 0.05", r"navigation.elevation.cel: unknown key; .*'cell'"),
        (
            "[navigation.elevation.tuning]\nxx = 1",
            r"navigation.elevation.tuning.xx: unknown key; allowed: ",
        ),
    ],
)
def test_keys_of_what_is_not_chosen_are_checked(tmp_path: Path, table: str, message: str) -> None:
    file = tmp_path / "wrong.toml"
    file.write_text(f"{HEAD}{table}\n")
    with pytest.raises(InputError, match=message):
        load_scenario(file)
    with pytest.raises(InputError, match=r"--set navigation.elevation.cel: unknown key"):
        load_scenario("slalom", overrides=["navigation.elevation.cel=0.05"])
    with pytest.raises(InputError, match=r"navigation.fog.cel: unknown key; .*'cell'"):
        mapping.Map("elevation", overrides={"fog.cel": 0.1})
