"""The verbs `list` and `schema`: what there is to choose from and to set."""

from enum import StrEnum
from typing import Annotated, Final

import typer

from treadwell.cli import completion
from treadwell.cli.options import JsonOption
from treadwell.cli.output import PASSED, write_json
from treadwell.errors import InputError

LIST_EXAMPLE: Final = "Example: treadwell list parameters fog"
SCHEMA_EXAMPLE: Final = "Example: treadwell schema scenario > scenario.schema.json"


class Described(StrEnum):
    """What `schema` can describe."""

    SCENARIO = "scenario"
    ROBOT = "robot"
    RESULT = "result"
    MAP = "map"


def list_(
    what: Annotated[
        str | None,
        typer.Argument(
            metavar="WHAT",
            help="scenarios, robots, components, one kind of component (planners, world_models, "
            "...), experiments or parameters; all but the parameters without it.",
            autocompletion=completion.list_kinds,
        ),
    ] = None,
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="NAME",
            help="Whose parameters: a component, a stage, a key; or which experiment's cases.",
            autocompletion=completion.list_names,
        ),
    ] = None,
    *,
    robot: Annotated[
        str | None,
        typer.Option(
            "--robot",
            metavar="NAME",
            help="Whose defaults `list parameters` shows: a robot's name or folder.",
            autocompletion=completion.robots,
        ),
    ] = None,
    as_json: JsonOption = False,
) -> int:
    """Show what there is to choose from: scenarios, robots, components, experiments.

    `list parameters` shows every parameter with default, unit, bounds, meaning and source, `list
    experiments NAME` what is run of one.
    """
    from treadwell.cli import list as cli_list

    if what is not None:
        cli_list.check_kind(what)
    if name is not None and what not in cli_list.NAMED:
        raise InputError("NAME: only `list parameters` and `list experiments` take one")
    if robot is not None and what != cli_list.PARAMETERS:
        raise InputError("--robot: only `list parameters` takes one")
    document = cli_list.listed([what] if what else cli_list.WITHOUT_KIND, name, robot)
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
