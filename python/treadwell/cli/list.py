"""The verb `list`: scenarios, robots and components."""

from collections.abc import Mapping, Sequence
from typing import Any

from treadwell.cli.output import write_table
from treadwell.errors import InputError, TreadwellError


def listed(kinds: Sequence[str]) -> dict[str, Any]:
    """Return what there is of each kind, as plain data.

    Args:
        kinds: of `scenarios`, `robots`, `components`.
    """
    makers = {"scenarios": _scenarios, "robots": _robots, "components": _components}
    return {kind: makers[kind]() for kind in kinds}


def show(document: Mapping[str, Any]) -> None:
    """Write what `listed` returned as tables."""
    for kind, entries in document.items():
        if kind == "components":
            triples = [
                (slot, name, text)
                for slot, names in entries.items()
                for name, text in names.items()
            ]
            write_table(kind, ("slot", "name", "what it is"), triples)
        else:
            rows = [(entry["name"], entry["description"]) for entry in entries]
            write_table(kind, ("name", "what it is"), rows)


def _scenarios() -> list[dict[str, str]]:
    from treadwell.data import data_folder
    from treadwell.scenario.loading import load_scenario, scenario_names

    entries = []
    for name in scenario_names():
        path = data_folder("scenarios") / f"{name}.toml"
        try:
            text = load_scenario(path).description
        except InputError as error:
            text = f"broken: {str(error).splitlines()[0]}"
        entries.append({"name": name, "description": text, "file": str(path)})
    return entries


def _robots() -> list[dict[str, str]]:
    from treadwell.robot.load import load_robot, robot_names

    entries = []
    for name in robot_names():
        try:
            robot = load_robot(name)
            entry = {"description": robot.file.robot.description, "folder": str(robot.folder)}
        except TreadwellError as error:
            entry = {"description": f"broken: {str(error).splitlines()[0]}", "folder": ""}
        entries.append({"name": name, **entry})
    return entries


def _components() -> dict[str, dict[str, str]]:
    from treadwell.additions import known
    from treadwell.components import COMPONENTS

    return {slot: known(slot) for slot in COMPONENTS}
