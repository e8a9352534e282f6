"""Lists, schemas and pages are what the code says, and the code says it of everything."""

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
import reference
from jsonschema import Draft202012Validator

from treadwell import _core
from treadwell.components import COMPONENTS, SOURCES
from treadwell.errors import InputError
from treadwell.reference.pages import pages
from treadwell.reference.parameters import all_tables, find_parameters
from treadwell.reference.schemas import SCHEMAS, scenario_schema
from treadwell.reference.words import allowed, escaped, kind, shown
from treadwell.robot.load import load_robot, robot_names
from treadwell.scenario.model import Scenario

ROOT = Path(__file__).resolve().parent.parent


def test_every_parameter_says_what_it_is() -> None:
    every = find_parameters()
    assert len(every) > 300
    for row in every:
        assert re.match(r"[A-Z0-9`]", row.meaning), row
        assert row.meaning.endswith("."), row
        assert row.unit, row
        assert row.bounds, row
    keys = [row.key for row in every]
    assert len(keys) == len(set(keys))


def test_every_component_has_a_line_and_built_in_ones_a_paper_where_there_is_one() -> None:
    for slot, names in COMPONENTS.items():
        assert names, slot
        for name, about in names.items():
            assert about, name
        assert SOURCES[slot].keys() == names.keys(), slot


def test_the_core_names_each_component_once() -> None:
    told = [(slot, name) for slot, name, *_ in _core.components()]
    assert len(told) == len(set(told))
    assert {slot for slot, _ in told} == set(COMPONENTS)


def test_parameters_are_found_by_component_and_by_key() -> None:
    assert all(row.key.startswith("navigation.fog.") for row in find_parameters("fog"))
    (cell,) = find_parameters("navigation.fog.cell")
    assert (cell.default, cell.unit) == (0.04, "m")
    assert find_parameters("gait")
    with pytest.raises(InputError, match=r"no parameters of 'fogg'.*fog"):
        find_parameters("fogg")
    with pytest.raises(InputError, match="matching is called scan_match now"):
        find_parameters("matching.keyframes")


@pytest.mark.parametrize("name", sorted(SCHEMAS))
def test_a_schema_is_one_and_describes_every_key(name: str) -> None:
    schema = SCHEMAS[name]()
    Draft202012Validator.check_schema(schema)
    models = [schema, *schema.get("$defs", {}).values()]
    for model in models:
        for key, value in model.get("properties", {}).items():
            assert value.get("description") or "$ref" in value, (model.get("title"), key)


def scenario_files() -> list[Path]:
    return sorted((ROOT / "scenarios").glob("*.toml"))


def plain(value: Any) -> Any:  # noqa: ANN401 - as TOML has it
    return json.loads(json.dumps(value, default=str))


@pytest.mark.parametrize("path", scenario_files(), ids=lambda path: path.stem)
def test_the_schema_accepts_every_scenario_that_ships(path: Path) -> None:
    Draft202012Validator(scenario_schema()).validate(plain(tomllib.loads(path.read_text())))


@pytest.mark.parametrize("name", robot_names())
def test_the_schema_accepts_every_robot_that_ships(name: str) -> None:
    text = (load_robot(name).folder / "robot.toml").read_text()
    Draft202012Validator(SCHEMAS["robot"]()).validate(plain(tomllib.loads(text)))


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("goall", {}),
        ("seed", -1),
        ("navigation", {"fog": {"cell": -0.04}}),
        ("navigation", {"fog": {"cel": 0.04}}),
        ("navigation", {"planner": "a_sta"}),
        ("course", [{"kind": "stair"}]),
        ("vary", {"start.yaw": {"unifrom": [0.0, 1.0]}}),
    ],
)
def test_the_schema_refuses_what_a_run_would_refuse(key: str, value: object) -> None:
    scenario = {"schema": 1, "name": "x", "start": {}, "goal": {}, key: value}
    assert not Draft202012Validator(scenario_schema()).is_valid(scenario)
    if key != "vary":
        good = {"schema": 1, "name": "x", "start": {}, "goal": {}}
        assert Draft202012Validator(scenario_schema()).is_valid(good)


def test_every_table_of_parameters_is_a_key_of_navigation_of_a_robot_or_of_a_function() -> None:
    scenario = {"schema": 1, "name": "x", "start": {}, "goal": {}}
    for table in all_tables():
        others = ("classification.", "costs.", "dynamic_scenes.", "landmarks.", "plan_view.")
        if table.key == "gait" or table.key.startswith(others):
            continue
        _, name = table.key.split(".")
        Scenario.model_validate({**scenario, "navigation": {name: {}}})


def test_the_pages_are_what_the_code_says() -> None:
    assert not reference.stale(), "python tools/docs/reference.py write"


def test_a_page_escapes_what_would_break_its_table() -> None:
    for name, text in pages().items():
        widths = [len(re.findall(r"(?<!\\)\|", line)) for line in text.splitlines()]
        tables = [width for width in widths if width]
        assert all(width >= 4 for width in tables), name


def test_a_schema_in_words() -> None:
    assert kind({"type": "array", "items": {"type": "number"}}) == "list of number"
    assert kind({"anyOf": [{"$ref": "#/$defs/Box"}, {"type": "null"}]}) == "Box"
    assert allowed({"type": "number", "minimum": 0, "exclusiveMaximum": 1.5}) == ">= 0, < 1.5"
    assert allowed({"enum": ["a", "b"]}) == "`a`, `b`"
    assert shown(None) == ""
    assert shown([0.5, True]) == "[0.5, true]"


def test_the_star_of_a_search_is_escaped_and_code_and_emphasis_stay() -> None:
    assert escaped("A*, D*'s `A*` and **A**") == "A\\*, D\\*'s `A*` and **A**"
    assert escaped(escaped("ARA*: A*")) == escaped("ARA*: A*")


def test_the_page_of_scenarios_names_the_keys_that_are_needed() -> None:
    about = pages()["scenario.md"].splitlines()[4]
    assert re.findall("`(.*?)`", about) == scenario_schema()["required"]
