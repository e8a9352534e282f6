"""The verbs `list` and `schema`: what there is to choose from and to set."""

from enum import StrEnum
from typing import Annotated, Final

import typer

from treadwell.cli.options import JsonOption
from treadwell.cli.output import PASSED, write_json
from treadwell.errors import InputError

LIST_EXAMPLE: Final = "Example: treadwell list parameters fog"
SCHEMA_EXAMPLE: Final = "Example: treadwell schema scenario > scenario.schema.json"


class What(StrEnum):
    """What `list` can show."""

    SCENARIOS = "scenarios"
    ROBOTS = "robots"
    COMPONENTS = "components"
    EXPERIMENTS = "experiments"
    PARAMETERS = "parameters"


class Described(StrEnum):
    """What `schema` can describe."""

    SCENARIO = "scenario"
    ROBOT = "robot"
    RESULT = "result"
    MAP = "map"


def list_(
    what: Annotated[
        What | None, typer.Argument(help="One of them; all but the parameters without it.")
    ] = None,
    name: Annotated[
        str | None,
        typer.Argument(metavar="[NAME]", help="Whose parameters: a component, a stage, a key."),
    ] = None,
    *,
    as_json: JsonOption = False,
) -> int:
    """Show what there is to choose from: scenarios, robots, components, experiments.

    `list parameters` shows every parameter with default, unit, bounds, meaning and source.
    """
    from treadwell.cli import list as cli_list

    if name is not None and what is not What.PARAMETERS:
        raise InputError("NAME: only `list parameters` takes one")
    short = [kind.value for kind in What if kind is not What.PARAMETERS]
    document = cli_list.listed([what.value] if what else short, name)
    if as_json:
        write_json(document)
    else:
        cli_list.show(document)
    return PASSED


def schema(
    what: Annotated[Described, typer.Argument(help="Which file: a scenario, robot.toml, ...")],
    *,
    as_json: JsonOption = False,
) -> int:
    """Write the JSON schema of a file to standard output, for editors and other programs.

    With it an editor completes and checks a scenario while it is written: docs/how_to/schema.md.
    """
    from treadwell.reference.schemas import SCHEMAS

    _ = as_json  # it is JSON anyway
    write_json(SCHEMAS[what.value]())
    return PASSED
