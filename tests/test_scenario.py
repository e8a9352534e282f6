"""Scenario files: what is accepted, what is refused and how, overrides and draws."""

import contextlib
import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from treadwell.additions import is_component
from treadwell.components import COMPONENTS, parameter_tables
from treadwell.errors import InputError
from treadwell.scenario.elements import ELEMENTS
from treadwell.scenario.events import EVENTS
from treadwell.scenario.loading import (
    LARGEST_FILE,
    find_scenario,
    load_scenario,
    read_toml,
    scenario_names,
)
from treadwell.scenario.model import Scenario
from treadwell.scenario.overrides import Draw, parse_setting, split_key
from treadwell.scenario.values import element_names

HEAD = 'schema = 1\nname = "x"\n[start]\n[goal]\n'


def write(folder: Path, text: str | bytes, name: str = "x.toml") -> Path:
    path = folder / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def message(path: Path | str, overrides: tuple[str, ...] = ()) -> str:
    with pytest.raises(InputError) as caught:
        load_scenario(path, overrides=overrides)
    return str(caught.value)


@pytest.mark.parametrize("name", scenario_names())
def test_every_shipped_scenario_loads_and_has_its_files_name(name: str) -> None:
    scenario = load_scenario(name)
    assert scenario.name == name
    assert scenario.description


def test_the_four_required_keys_are_enough(tmp_path: Path) -> None:
    scenario = load_scenario(write(tmp_path, HEAD))
    assert scenario.goal.position == (2.0, 0.0)
    assert scenario.goal.radius == 0.15
    assert scenario.physics.friction == 0.8
    assert scenario.expect.outcome == "goal_reached"
    assert scenario.expect.max_falls == 0


@pytest.mark.parametrize("key", ["schema", "name", "start", "goal"])
def test_a_required_key_that_is_missing_is_named(tmp_path: Path, key: str) -> None:
    lines = ["schema = 1", 'name = "x"', "start = {}", "goal = {}"]
    text = "\n".join(line for line in lines if not line.startswith(key))
    assert f"x.toml: {key}: missing" in message(write(tmp_path, text))


@pytest.mark.parametrize("kind", sorted(set(ELEMENTS) - {"mesh", "mjcf"}))
def test_every_kind_of_element_has_defaults(tmp_path: Path, kind: str) -> None:
    scenario = load_scenario(write(tmp_path, f'{HEAD}[[course]]\nkind = "{kind}"\n'))
    assert getattr(scenario.course[0], "kind", None) == kind


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('[[course]]\nkind = "stairs"\nrise = -0.03', "course.stairs.rise: found -0.03"),
        ('[[course]]\nkind = "stairs"\nrise = [0.1, 0.1]', "course.stairs.rise: found [0.1, 0.1]"),
        (
            '[[course]]\nkind = "stairs"\nsteps = 2\nrise = [0.1, -1]',
            "course.stairs.rise.1: found -1",
        ),
        ('[[course]]\nkind = "stair"', 'course.stair.kind: found "stair"'),
        ('[[course]]\nkind = "stair"', "did you mean 'stairs'?"),
        ('[[course]]\nname = "a"\nkind = "box"\nhight = 1', "course.a.hight: unknown key"),
        ('[[course]]\nkind = "platform"\nsize = [1.0, 0.5]', "course.platform.size.2: missing"),
        ('[[course]]\nkind = "wall"\nfrom = [0, 1]\nto = [0, 1]', "course.wall.to"),
        ('[[course]]\nkind = "mesh"', "course.mesh.file: missing"),
        ('[[course]]\nkind = "mesh"\nfile = "none.stl"', "there is no such file"),
        ('[[course]]\nkind = "mesh"\nfile = "../a.stl"', "must lie in the scenario file's folder"),
        ('[[course]]\nkind = "mjcf"\nfile = "/etc/passwd"', "must lie in the scenario"),
        ('[[course]]\nkind = "mesh"\nfile = "x.toml"', "must end in .stl or .obj"),
        ('[[course]]\nkind = "scatter"\nsize = [0.3, 0.1]', "course.scatter.size"),
        ('[[course]]\nkind = "house"\nthings = ["dor"]', 'course.house.things.0: found "dor"'),
        ('[[course]]\nkind = "house"\nthings = ["dor"]', "did you mean 'door'?"),
        ('[[course]]\nkind = "yard"\narea = [[1, 1], [0, 0]]', "course.yard.area"),
        ('[[course]]\nkind = "flights"\ntread = [0.2, 0.1]', "course.flights.tread"),
        ('[[course]]\nkind = "slabs"\nedge = 0.001', "course.slabs.edge"),
        ('[[course]]\nkind = "door"\nopen = 1.5', "course.door.open: found 1.5"),
        ('[[course]]\nkind = "door"\nwall = [-1, 0, 1]', "course.door.wall.0: found -1"),
        ('[[event]]\nat = 1\ndo = "move"\nname = "a"', "must have either 'to' or 'path'"),
        ('[[event]]\nat = 1\ndo = "move"\nname = "a"\nto = [0, 0]\nloop = true', "event.0.loop"),
        ('[[event]]\ndo = "push"\nimpulse = [1, 0, 0]', "'at' or 'near'"),
        ('[[event]]\nat = 1\nnear = [0, 0]\nwithin = 1\ndo = "blind"\nduration = 1', "'at' or"),
        ('[[event]]\nnear = [0, 0]\ndo = "blind"\nduration = 1', "event.0.within"),
        ('[[event]]\nat = 1\ndo = "jump"', 'event.0.do: found "jump"'),
        ('[[event]]\nat = 1\ndo = "blind"', "event.0.duration: missing"),
        ("[physics]\nfriction = nan", "physics.friction: found nan"),
        ("[physics]\nfriction = inf", "physics.friction: found inf"),
        ("[physics]\nfrction = 1", "did you mean 'friction'?"),
        ('[physics]\nfriction = "0.8"', 'physics.friction: found "0.8"'),
        ('[sensors]\ndepth = "idel"', "did you mean 'ideal'?"),
        ('[navigation]\nplanner = "a_sta"', "did you mean 'a_star'?"),
        ('[navigation]\nbehaviour = "stair_climbin"', "navigation.behaviour"),
        ("[navigation.fogg]\ncell = 1", "did you mean 'fog'?"),
        ('[navigation]\nlocalizer = "matching"', "\"matching\"; is called 'scan_match' now"),
        ("[navigation.matching]\noffset = 1", "is called navigation.scan_match now"),
        ("[navigation.fog]\ncell = nan", "navigation.fog.cell: found nan"),
        ("[navigation]\nfog = 3", "navigation.fog: found 3"),
        ("[expect]\nmax_falls = -1", "expect.max_falls: found -1"),
        ('[vary]\n"start.yaw" = { uniform = [1, 0] }', 'vary."start.yaw".uniform'),
        ('[vary]\n"start.yaw" = { unifrm = [0, 1] }', "unifrm"),
        ('[vary]\n"start.yaws" = { uniform = [0, 1] }', "start.yaws: unknown key"),
        ('[vary]\n"course.box.yaw" = { uniform = [0, 1] }', "course"),
        ("[fly]", "fly: unknown key"),
    ],
)
def test_bad_input_names_file_key_finding_and_hint(
    tmp_path: Path, text: str, expected: str
) -> None:
    found = message(write(tmp_path, f"{HEAD}{text}\n"))
    assert expected in found
    assert str(tmp_path / "x.toml") in found


def test_2000_elements_are_taken_and_one_more_is_refused_in_one_line(tmp_path: Path) -> None:
    element = '[[course]]\nkind = "box"\nsize = [0.1, 0.1, 0.1]\nposition = [{}.0, {}.0]\n'
    elements = [element.format(2 + i % 40, i // 40) for i in range(2001)]
    assert len(load_scenario(write(tmp_path, HEAD + "".join(elements[:-1]))).course) == 2000
    found = message(write(tmp_path, HEAD + "".join(elements)))
    assert "at most 2000 items" in found
    assert len(found.splitlines()) == 1


def test_all_faults_are_told_at_once_but_not_more_than_a_screenful(tmp_path: Path) -> None:
    text = HEAD + '[[course]]\nkind = "box"\nyaw = "a"\n' * 50 + "[physics]\nfriction = -1\n"
    lines = message(write(tmp_path, text)).splitlines()
    assert len(lines) == 21
    assert lines[-1].endswith("and 31 more")


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"schema = 1\nname = \n", "line 2"),
        (b"schema = 1\nname = '\xff'\n", "line 2: not UTF-8"),
        (b"a = " + b"[" * 5000, "nested too deep"),
        (b"a = " + b"9" * 6000, "out of range"),
        (b"#" * (LARGEST_FILE + 1), "larger than"),
        (b"", "schema: missing"),
    ],
)
def test_a_file_that_is_not_a_scenario_is_refused(
    tmp_path: Path, content: bytes, expected: str
) -> None:
    assert expected in message(write(tmp_path, content))


@pytest.mark.parametrize("name", ["slalon", "", "/", "/dev/zero", "a\0b", "x" * 5000, "../slalom"])
def test_what_is_no_scenario_is_bad_input(name: str) -> None:
    assert message(name)


def test_a_wrong_name_gets_the_nearest_one() -> None:
    assert "did you mean 'slalom'?" in message("slalon")


def test_a_path_is_tried_before_a_shipped_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write(tmp_path, HEAD, "slalom")
    assert load_scenario("slalom").name == "x"
    assert find_scenario("doorway").name == "doorway.toml"
    assert read_toml(find_scenario("doorway.toml"))["name"] == "doorway"


def test_a_symbolic_link_does_not_lead_out_of_the_folder(tmp_path: Path) -> None:
    inside, outside = tmp_path / "in", tmp_path / "out"
    inside.mkdir()
    outside.mkdir()
    write(outside, "x", "thing.stl")
    (inside / "thing.stl").symlink_to(outside / "thing.stl")
    text = f'{HEAD}[[course]]\nkind = "mesh"\nfile = "thing.stl"\n'
    assert "must lie in the scenario file's folder" in message(write(inside, text))


def test_names_of_elements_are_unique_also_among_those_of_events(tmp_path: Path) -> None:
    element = 'kind = "box"\nname = "a"'
    twice = f"{HEAD}[[course]]\n{element}\n[[course]]\n{element}\n"
    assert "course.a.name" in message(write(tmp_path, twice))
    added = '[[event]]\nat = 1\ndo = "add"\nelement = { kind = "box", name = "a" }\n'
    assert "event.0.element.name" in message(
        write(tmp_path, f"{HEAD}[[course]]\n{element}\n{added}")
    )


def test_unnamed_elements_are_called_by_kind_and_number() -> None:
    elements = [
        {"kind": "box"},
        {"kind": "box", "name": "box 2"},
        {"kind": "box"},
        {"kind": "sill"},
    ]
    assert element_names(elements) == ["box", "box 2", "box 3", "sill"]


def test_flags_beat_settings_which_beat_draws_which_beat_the_file(tmp_path: Path) -> None:
    text = 'schema = 1\nname = "x"\nrobot = "nao"\nseed = 1\n[start]\nyaw = 1.0\n[goal]\n'
    text += '[vary]\n"start.yaw" = { choice = [2.0] }\n'
    path = write(tmp_path, text)
    assert load_scenario(path).start.yaw == 2.0
    assert load_scenario(path).robot == "nao"
    assert load_scenario(path, overrides=["start.yaw=3.0"]).start.yaw == 3.0
    set_both = ["seed=2", "robot=set"]
    assert load_scenario(path, overrides=set_both).seed == 2
    assert load_scenario(path, overrides=set_both).robot == "set"
    flagged = load_scenario(path, overrides=set_both, seed=3, robot="flag")
    assert (flagged.seed, flagged.robot) == (3, "flag")


def test_a_seed_that_is_set_decides_the_draws(tmp_path: Path) -> None:
    path = write(tmp_path, f'{HEAD}[vary]\n"start.yaw" = {{ normal = [0.0, 0.1] }}\n')
    assert load_scenario(path, overrides=["seed=7"]) == load_scenario(path, seed=7)


def test_settings_reach_elements_by_name_and_by_index(tmp_path: Path) -> None:
    path = write(tmp_path, f'{HEAD}[[course]]\nkind = "box"\n[[course]]\nkind = "stairs"\n')
    for key in ("course.stairs.rise", "course.1.rise"):
        stairs = load_scenario(path, overrides=[f"{key}=0.05"]).course[1]
        assert getattr(stairs, "rise", None) == 0.05
    assert "did you mean 'stairs'?" in message(path, ("course.stair.rise=0.05",))
    assert "counted from 0" in message(path, ("course.2.rise=0.05",))


@pytest.mark.parametrize(
    ("setting", "expected"),
    [
        ("a=1", ("a", 1)),
        ("a=[1, 2]", ("a", [1, 2])),
        ("a=b c", ("a", "b c")),
        ('a="1"', ("a", "1")),
        ("a=1\nb = 2", ("a", "1\nb = 2")),
        ("a==", ("a", "=")),
        ("a=", ("a", "")),
    ],
)
def test_a_setting_is_toml_and_otherwise_a_string(setting: str, expected: object) -> None:
    assert parse_setting(setting) == expected


@pytest.mark.parametrize("setting", ["a", "=1", "a..b=1", 'a."b=1', "start.yaw.x=1", "name.x=1"])
def test_a_setting_that_cannot_be_is_bad_input(setting: str) -> None:
    assert "--set" in message("slalom", (setting,))


def test_a_quoted_word_of_a_key_may_hold_dots() -> None:
    assert split_key('vary."start.yaw".uniform') == ["vary", "start.yaw", "uniform"]


@given(seed=st.integers(0, 2**53 - 1))
@settings(max_examples=30, deadline=None)
def test_a_seed_gives_the_same_scenario_again(seed: int) -> None:
    first, second = load_scenario("slalom", seed=seed), load_scenario("slalom", seed=seed)
    assert first.configuration() == second.configuration()
    assert 0.6 <= first.physics.friction <= 1.0


@given(
    low=st.integers(-(10**7), 10**7).map(lambda number: number / 1e6),
    width=st.just(0.0) | st.floats(1e-9, 10),
    seed=st.integers(0, 1000),
)
def test_a_uniform_draw_stays_in_its_bounds(low: float, width: float, seed: int) -> None:
    value = Draw.model_validate({"uniform": [low, low + width]}).sample(seed, "key")
    assert isinstance(value, float)
    assert low <= value <= low + width


def test_one_draw_does_not_change_anothers_numbers(tmp_path: Path) -> None:
    one = '"start.yaw" = { uniform = [-1.0, 1.0] }\n'
    two = '"physics.friction" = { uniform = [0.6, 1.0] }\n'
    alone = load_scenario(write(tmp_path, f"{HEAD}[vary]\n{one}"), seed=5)
    both = load_scenario(write(tmp_path, f"{HEAD}[vary]\n{two}{one}"), seed=5)
    assert alone.start.yaw == both.start.yaw


def test_component_tables_pass_through_untouched(tmp_path: Path) -> None:
    text = f"{HEAD}[navigation.fog]\ncell = 0.05\nnested = {{ list = [1, 2.5] }}\n"
    navigation = load_scenario(write(tmp_path, text)).navigation
    assert navigation.parameters() == {"fog": {"cell": 0.05, "nested": {"list": [1, 2.5]}}}


def test_a_users_own_component_can_stand_in_every_slot(tmp_path: Path) -> None:
    for slot in COMPONENTS:
        chosen = load_scenario(
            write(
                tmp_path, f'{HEAD}[navigation]\n{slot} = "my.package:Thing"\nThing = {{ a = 1 }}\n'
            )
        )
        assert chosen.navigation.slots()[slot] == "my.package:Thing"
        assert is_component(slot, "my.package:Thing")
        assert not is_component(slot, "my.package.Thing")
    assert "fog" in parameter_tables()


def test_the_configuration_is_a_scenario_again() -> None:
    configuration = load_scenario("visitor", seed=4).configuration()
    again = Scenario.model_validate(configuration)
    assert again.configuration() == configuration


JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=8)
    | st.sampled_from([*ELEMENTS, *EVENTS, "noisy", "fog", 10**400, -0.0, math.nan, 1e308]),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(
            st.sampled_from(
                ["kind", "do", "at", "name", "position", "size", "element", "rise", "file", "steps"]
            )
            | st.text(max_size=5),
            inner,
            max_size=5,
        )
    ),
    max_leaves=20,
)
TOP = st.sampled_from([*Scenario.model_fields, "schema", "vary"])


@pytest.mark.slow
@given(tables=st.dictionaries(TOP, JSON, max_size=6), whole=st.booleans())
@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_any_structure_is_a_scenario_or_bad_input(tables: dict[str, Any], whole: bool) -> None:
    base: dict[str, Any] = {"schema": 1, "name": "x", "start": {}, "goal": {}} if whole else {}
    with pytest.MonkeyPatch.context() as patch, contextlib.suppress(InputError):
        patch.setattr("treadwell.scenario.loading.read_toml", lambda _path: {**base, **tables})
        assert load_scenario("slalom").configuration()


@given(setting=st.text(max_size=30) | st.builds("{}={}".format, TOP, st.text(max_size=12)))
@settings(max_examples=200, deadline=None)
def test_any_setting_is_taken_or_bad_input(setting: str) -> None:
    with contextlib.suppress(InputError):
        assert load_scenario("visitor", overrides=[setting]).name


@given(content=st.binary(max_size=200))
@settings(max_examples=200, deadline=None)
def test_any_bytes_are_bad_input(content: bytes, tmp_path_factory: pytest.TempPathFactory) -> None:
    path = write(tmp_path_factory.mktemp("bytes"), content)
    assert str(path) in message(path)


def test_the_course_of_another_file_comes_first(tmp_path: Path) -> None:
    (tmp_path / "house.toml").write_text(
        '[[course]]\nkind = "cylinder"\nposition = [3.0, 0.0]\nradius = 0.1\nheight = 0.3\n'
    )
    path = tmp_path / "task.toml"
    task = (
        'schema = 1\nname = "task"\ncourse_of = "house.toml"\n[start]\nposition = [0.0, 0.0]\n'
        "[goal]\nposition = [1.0, 0.0]\n"
        '[[course]]\nkind = "wall"\nfrom = [0.0, 1.0]\nto = [1.0, 1.0]\nheight = 0.5\n'
    )
    path.write_text(task)
    assert [element.kind for element in load_scenario(path).course] == ["cylinder", "wall"]
    for found in ('"nowhere.toml"', '"../house.toml"', "3", '"task.toml"'):
        path.write_text(task.replace('"house.toml"', found))
        with pytest.raises(InputError, match="course_of: "):
            load_scenario(path)


def test_minus_nothing_is_nothing_as_a_bound_and_as_the_end_of_a_draw(tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    text = f"{HEAD}[sensors]\ncamera_roll_pitch_error = -0.0\n"
    path.write_text(text + '[vary]\n"start.yaw" = {uniform = [0.0, -0.0]}\n', encoding="utf-8")
    scenario = load_scenario(path)
    assert str(scenario.sensors.camera_roll_pitch_error) == "0.0"
    assert str(scenario.start.yaw) == "0.0"


def test_a_number_that_is_nearly_nothing_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    path.write_text(f"{HEAD}[physics]\nfriction = 5e-324\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"physics\.friction: found 5e-324; must be 0, or not so"):
        load_scenario(path)
