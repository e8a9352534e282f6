"""The verb `list`: scenarios, robots, components, experiments and parameters."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from treadwell.cli.output import write_message, write_table
from treadwell.errors import InputError, TreadwellError

PARAMETERS: Final = "parameters"
EXPERIMENTS: Final = "experiments"
NAMED: Final = (PARAMETERS, EXPERIMENTS)
"""Kinds of which one name can be asked for."""
CASES: Final = "cases"
"""What is shown of a single experiment."""
WITHOUT_KIND: Final = ("scenarios", "robots", "components", EXPERIMENTS)
"""What is shown where no kind is asked for."""


def kinds() -> list[str]:
    """Return what can be asked for: each slot of `[navigation]` by its plural, too."""
    from treadwell.components import COMPONENTS

    return [*WITHOUT_KIND, *(f"{slot}s" for slot in COMPONENTS), PARAMETERS]


def check_kind(kind: str) -> None:
    """Refuse a kind of which there is no list.

    Raises:
        InputError: it is none of `kinds`; the message says the nearest.
    """
    allowed = kinds()
    if kind not in allowed:
        from treadwell.scenario.messages import nearest, shortened

        raise InputError(
            f"WHAT: there is no list of {shortened(kind)!r}: allowed are {', '.join(allowed)}"
            f"{nearest(kind, allowed)}"
        )


def listed(
    kinds: Sequence[str], name: str | None = None, robot: str | None = None
) -> dict[str, Any]:
    """Return what there is of each kind, as plain data.

    Args:
        kinds: of what the function `kinds` returns.
        name: whose parameters, or which experiment's cases; None: all.
        robot: the robot whose defaults the parameters have; None: no robot's.

    Raises:
        InputError: nothing has parameters by that name, or there is no such experiment or robot.
    """
    if name is not None and list(kinds) == [EXPERIMENTS]:
        return {CASES: _cases(name)}
    makers: dict[str, Callable[[], Any]] = {
        "scenarios": _scenarios,
        "robots": _robots,
        "components": _components,
        EXPERIMENTS: _experiments,
        PARAMETERS: lambda: _parameters(name, robot),
    }
    return {
        kind: makers[kind]() if kind in makers else _of_slot(kind.removesuffix("s"))
        for kind in kinds
    }


def show(document: Mapping[str, Any]) -> None:
    """Write what `listed` returned as tables."""
    for kind, entries in document.items():
        if kind == "components":
            rows = [
                (slot, name, text, _paper(slot, name))
                for slot, names in entries.items()
                for name, text in names.items()
            ]
            write_table(kind, ("slot", "name", "what it is", "source"), rows)
            _name_papers(rows)
        elif kind == CASES:
            lines = [
                (each["name"], each["scenario"], f"{each['share']:g}", ", ".join(each["settings"]))
                for each in entries
            ]
            write_table(kind, ("name", "scenario", "runs a seed", "settings"), lines)
        elif kind == EXPERIMENTS:
            triples = [
                (each["name"], each["description"], ", ".join(each["cases"])) for each in entries
            ]
            write_table(kind, ("name", "what it is", "cases"), triples)
        elif kind == PARAMETERS:
            header = ("key", "default", "unit", "allowed", "what it means", "source")
            fields = ("key", "default", "unit", "bounds", "meaning", "source")
            keys = [tuple(_shown(entry[field]) for field in fields) for entry in entries]
            write_table(kind, header, keys)
            _name_papers(keys)
        elif kind in WITHOUT_KIND:
            pairs = [(entry["name"], entry["description"]) for entry in entries]
            write_table(kind, ("name", "what it is"), pairs)
        else:
            slot = kind.removesuffix("s")
            parts = [(name, text, _paper(slot, name)) for name, text in entries.items()]
            write_table(kind, ("name", "what it is", "source"), parts)
            _name_papers(parts)


def _paper(slot: str, name: str) -> str:
    """Return what a component is after, nothing where that is nobody's paper."""
    from treadwell.components import SOURCES

    return SOURCES[slot].get(name) or ""


def _name_papers(rows: Sequence[tuple[str, ...]]) -> None:
    """Say which papers the numbers in a table's last column mean."""
    from treadwell.components import PAPERS

    sources = " ".join(row[-1] for row in rows)
    for number, paper in PAPERS.items():
        if number in sources:
            write_message(f"{number}: {paper}")


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
    from treadwell.components import COMPONENTS

    return {slot: _of_slot(slot) for slot in COMPONENTS}


def _of_slot(slot: str) -> dict[str, str]:
    from treadwell.additions import known

    return known(slot)


def _experiments() -> list[dict[str, Any]]:
    from treadwell.experiments.catalogue import EXPERIMENTS

    return [
        {
            "name": made.name,
            "description": made.description,
            "cases": [case.name for case in made.cases],
        }
        for made in EXPERIMENTS.values()
    ]


def _cases(name: str) -> list[dict[str, Any]]:
    from treadwell.experiments.catalogue import find_experiment

    return [
        {
            "name": case.name,
            "scenario": case.scenario if isinstance(case.scenario, str) else "drawn",
            "share": case.share,
            "settings": list(case.overrides),
        }
        for case in find_experiment(name).cases
    ]


def _parameters(name: str | None, robot: str | None) -> list[dict[str, Any]]:
    from dataclasses import asdict

    from treadwell.reference.parameters import find_parameters
    from treadwell.robot.load import load_robot

    of_robot = None if robot is None else load_robot(robot)
    return [asdict(parameter) for parameter in find_parameters(name, of_robot)]


def _shown(value: object) -> str:
    if value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else str(value)
