"""What `treadwell.run`, `Episode` and `replay` take: paths, overrides as a mapping, classes."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from episode_builders import result, scenario
from hypothesis import given
from hypothesis import strategies as st
from user_parts import PARTS, Straight

import treadwell
from treadwell.errors import InputError
from treadwell.plugins import METHODS
from treadwell.protocols import Plan
from treadwell.runner import Run
from treadwell.scenario.loading import load_scenario
from treadwell.scenario.overrides import Overrides, assign, read_overrides

SHORT = {"time_limit": 0.3}


class Lost:
    """A planner that takes half of what it is given."""

    def plan(self, view: Any, stairs: Any) -> Plan:  # noqa: ANN401 - whatever it is
        return Plan(None, f"{view} {stairs}")


def test_every_path_may_be_a_string_or_a_path(tmp_path: Path) -> None:
    source = treadwell.Episode("open_floor").robot.folder
    for kind in (str, Path):
        place = tmp_path / kind.__name__
        done = treadwell.run("open_floor", robot=kind(source), overrides=SHORT, out=kind(place))
        assert done.folder == place
        again = treadwell.replay(kind(place), out=kind(tmp_path / f"again_{kind.__name__}"))
        assert again.passed
        assert again.folder.name == f"again_{kind.__name__}"
    with pytest.raises(InputError, match="exists already"):
        treadwell.run("open_floor", overrides=SHORT, out=str(tmp_path / "str"))
    scenario = tmp_path / "scenario.toml"
    scenario.write_text('schema = 1\nname = "mine"\n[start]\n[goal]\n')
    for given_as in (str(scenario), scenario):
        assert treadwell.Episode(given_as).scenario.name == "mine"


@pytest.mark.parametrize(
    "overrides",
    [
        ["navigation.fog.cell=0.05", "goal.position=[1.0, 0.5]", "course.first.yaw=0.1"],
        {"navigation.fog.cell": 0.05, "goal.position": (1.0, 0.5), "course.first.yaw": 0.1},
        {
            "navigation": {"fog": {"cell": np.float64(0.05)}},
            "goal": {"position": np.array([1.0, 0.5])},
            "course": {"first": {"yaw": 0.1}},
        },
        {"navigation": {"fog.cell": 0.05}, "goal.position": [1, 0.5], "course.first": {"yaw": 0.1}},
    ],
)
def test_overrides_are_settings_or_a_mapping_dotted_or_nested(overrides: Overrides) -> None:
    made = load_scenario("slalom", overrides=overrides)
    assert made.navigation.parameters()["fog"] == {"cell": 0.05}
    assert made.goal.position == (1.0, 0.5)
    assert made.course[0].yaw == 0.1


WORDS = st.text("abc_1", min_size=1, max_size=3)
VALUES = st.booleans() | st.integers(-9, 9) | st.text(max_size=3) | st.lists(st.integers())
TABLES = st.recursive(
    st.dictionaries(WORDS, VALUES, min_size=1, max_size=3),
    lambda inner: st.dictionaries(WORDS, VALUES | inner, min_size=1, max_size=3),
)


@given(TABLES)
def test_a_mapping_of_overrides_put_in_place_is_that_mapping(table: dict[str, Any]) -> None:
    raw: dict[str, Any] = {}
    for key, value in read_overrides(table):
        assign(raw, key, value)
    assert raw == table


def test_a_draw_in_a_mapping_has_its_dotted_key() -> None:
    draw = {"goal.radius": {"uniform": (0.2, 0.2)}}
    assert load_scenario("slalom", overrides={"vary": draw}).goal.radius == 0.2


@pytest.mark.parametrize(
    ("overrides", "expected"),
    [
        ({"navigation": {"fgo": {"cell": 1}}}, "navigation.fgo: unknown key; .*'fog'"),
        ({"course.frist.yaw": 1}, "overrides course.frist.yaw: .*did you mean 'first'"),
        ({"goal": {"position": {1.0, 2.0}}}, "overrides: goal.position: found set; must be"),
        ({"navigation.planner": Straight}, "found the class Straight"),
        ({"goal": {3: 1}}, "overrides: found the key 3; must be a text"),
        ([("goal.radius", 1)], "overrides: found .*; must be KEY=VALUE, or all a mapping"),
        ("goal.radius", "must be KEY=VALUE"),
    ],
)
def test_a_bad_override_is_one_message_with_its_key(overrides: Overrides, expected: str) -> None:
    with pytest.raises(InputError, match=expected):
        load_scenario("slalom", overrides=overrides)


def test_a_mapping_without_an_end_is_refused() -> None:
    endless: dict[str, Any] = {}
    endless["goal"] = endless
    with pytest.raises(InputError, match="nested too deep"):
        load_scenario("slalom", overrides=endless)
    loop: list[Any] = []
    loop.append(loop)
    with pytest.raises(InputError, match=r"goal\.position: nested too deep"):
        load_scenario("slalom", overrides={"goal.position": loop})


@pytest.mark.parametrize("slot", METHODS)
def test_a_class_is_made_as_one_that_the_scenario_names(slot: str) -> None:
    kind = PARTS[slot]
    made = treadwell.Episode("slalom", **{slot: kind}, overrides=SHORT)
    assert type(made.guards[slot].component) is kind
    named = f"{kind.__module__}:{kind.__name__}"
    assert made.scenario.navigation.slots()[slot] == named
    assert made.core_input.given == {slot: named}


def test_a_class_gets_its_table_of_parameters_and_a_replay_by_it_is_the_same(
    tmp_path: Path,
) -> None:
    settings = {**SHORT, "navigation": {"Straight": {"points": 7}}}
    done = treadwell.run("slalom", planner=Straight, overrides=settings, out=tmp_path / "run")
    assert done.result.configuration["navigation"]["Straight"] == {"points": 7}
    again = treadwell.replay(done.folder, planner=Straight, out=tmp_path / "again")
    assert again.result.replay.first_difference is None
    assert again.result.replay.compared == again.result.replay.observations
    changed = {"navigation.Straight.points": 5}
    other = treadwell.replay(
        done.folder, planner=Straight, overrides=changed, out=tmp_path / "other"
    )
    written = json.loads((other.folder / "result.json").read_text())
    assert written["configuration"]["navigation"]["Straight"] == {"points": 5}


@pytest.mark.parametrize(
    ("parts", "settings", "expected"),
    [
        ({"planner": Lost}, (), r"planner: \w+:Lost: Lost has no method plan\(view, stairs, start"),
        ({"localizer": Straight}, (), r"localizer: user_parts:Straight: .*correct\(body, "),
        ({"planer": Straight}, (), "planer: no such component; .*did you mean 'planner'"),
        (
            {"planner": Straight},
            ["navigation.Straight.points=1"],
            r"planner: cannot make user_parts:Straight: ValueError\('points must be 2 or more'\)",
        ),
        (
            {"planner": Straight},
            ["navigation.Strait.points=3"],
            "navigation.Strait: unknown key; .*did you mean 'Straight'",
        ),
    ],
)
def test_a_class_that_cannot_be_made_or_lacks_a_method_is_named_before_anything_runs(
    parts: dict[str, type], settings: Sequence[str], expected: str
) -> None:
    with pytest.raises(InputError, match=expected):
        treadwell.Episode("slalom", **parts, overrides=settings)


def test_a_class_that_the_caller_brings_is_no_code_of_the_scenarios() -> None:
    made = treadwell.Episode("slalom", planner=Straight, user_code=False)
    assert isinstance(made.guards["planner"].component, Straight)


def test_a_class_that_no_scenario_could_name_will_do() -> None:
    kind = type("Über", (Straight,), {})
    made = treadwell.Episode("slalom", planner=kind)
    assert type(made.guards["planner"].component) is kind
    assert made.scenario.navigation.planner == "a_star"


def test_a_part_may_be_named_as_a_scenario_names_it() -> None:
    episode = treadwell.Episode("open_floor", planner="voronoi", localizer="scan_match")
    assert episode.scenario.navigation.planner == "voronoi"
    assert episode.scenario.navigation.localizer == "scan_match"
    with pytest.raises(InputError, match=r"planner: .*did you mean 'voronoi'"):
        treadwell.Episode("open_floor", planner="voronoy")


def test_the_doors_are_there_for_completion() -> None:
    public = {name for name in dir(treadwell) if not name.startswith("__")}
    library = {"costs", "mapping", "protocols"}
    assert public == (set(treadwell.__all__) - {"__version__"}) | library


def test_an_episode_and_its_steps_are_a_line_at_the_prompt() -> None:
    episode = treadwell.Episode("open_floor", seed=3)
    assert repr(episode) == "<Episode open_floor with qrio, seed 3, 0.00 s>"
    step = episode.tick()
    assert repr(step).startswith(f"<Step at 0.00 s: {step.state}, believes (")
    assert len(repr(step)) < 200


def test_a_run_says_its_reason() -> None:
    run = Run(result(scenario(), outcome="refused", reason="blocked: a box"), Path("runs/x"))
    assert run.reason == "blocked: a box"
    assert repr(run).endswith("not passed (blocked: a box); runs/x>")
    assert not [name for name in dir(run.result) if name.startswith("model_")]
