"""A setting of a component that was not chosen changes nothing, and whoever gave it is told so."""

import json
import re
from pathlib import Path

import pytest

import treadwell
from treadwell.cli.app import execute
from treadwell.components import COMPONENTS, TABLES, parameter_tables
from treadwell.scenario.loading import load_scenario
from treadwell.scenario.unread import unread
from treadwell.sweeps.request import crossed

ELEVATION = "navigation.world_model=elevation"
CELL = "navigation.fog.cell=0.03"
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
