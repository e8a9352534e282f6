"""JSON schemas of the files: a scenario, a robot's `robot.toml`, `result.json`."""

from collections.abc import Callable
from typing import Any, Final

from treadwell.additions import known
from treadwell.components import CLASS_NAME, COMPONENTS
from treadwell.judging.result import Result
from treadwell.map_result import MapResult
from treadwell.reference.parameters import all_tables
from treadwell.robot.file import RobotFile
from treadwell.scenario.model import Scenario
from treadwell.scenario.overrides import Draw

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"


def scenario_schema() -> dict[str, Any]:
    """Return the schema of a scenario file, its components' tables included."""
    schema = Scenario.model_json_schema()
    navigation = schema["$defs"]["Navigation"]
    for slot in COMPONENTS:
        navigation["properties"][slot]["anyOf"] = [
            {"enum": list(known(slot))},
            {"pattern": f"^{CLASS_NAME.pattern}$"},
        ]
    navigation["properties"] |= _tables()
    navigation["properties"]["static_map"]["properties"]["file"] = {
        "type": "string",
        "description": "An OctoMap file, .bt or .ot, by its path from the scenario file's folder, "
        "in which it lies: the map that is told instead of one made of the course.",
    }
    # A component of the user's has a table of its class's name.
    navigation["additionalProperties"] = {"type": "object"}
    draw = Draw.model_json_schema(ref_template="#/$defs/{model}")
    schema["$defs"] |= draw.pop("$defs", {})
    schema["properties"]["vary"] = {
        "type": "object",
        "description": "What is drawn anew for every seed: a dotted key, and what from.",
        "additionalProperties": draw,
    }
    schema["properties"]["course_of"] = {
        "type": "string",
        "description": "A scenario file in the same folder whose course stands before this one's.",
    }
    return _titled(schema, "A treadwell scenario")


def robot_schema() -> dict[str, Any]:
    """Return the schema of `robot.toml`, the walker's parameters included."""
    schema = RobotFile.model_json_schema()
    described = schema["properties"]
    for name in ("gait", "navigation"):
        described[name] = {"description": described[name]["description"], "type": "object"}
    described["gait"] |= next(table.schema for table in all_tables() if table.key == "gait")
    described["navigation"]["properties"] = _tables()
    return _titled(schema, "A robot.toml of treadwell")


def result_schema() -> dict[str, Any]:
    """Return the schema of `result.json`."""
    return _titled(Result.model_json_schema(mode="serialization"), "A result.json of treadwell")


def map_schema() -> dict[str, Any]:
    """Return the schema of the `result.json` of a map."""
    schema = MapResult.model_json_schema(mode="serialization")
    return _titled(schema, "The result.json of a map of treadwell")


SCHEMAS: Final[dict[str, Callable[[], dict[str, Any]]]] = {
    "scenario": scenario_schema,
    "robot": robot_schema,
    "result": result_schema,
    "map": map_schema,
}
"""What there is a schema of -> what makes it."""


def _tables() -> dict[str, Any]:
    tables = [table for table in all_tables() if table.key.startswith("navigation.")]
    return {table.name: table.schema for table in tables}


def _titled(schema: dict[str, Any], title: str) -> dict[str, Any]:
    return {"$schema": DIALECT, **schema, "title": title}
