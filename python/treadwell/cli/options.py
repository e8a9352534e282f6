"""Arguments and options that several verbs share."""

from typing import Annotated

import typer

from treadwell.cli import completion

ScenarioArgument = Annotated[
    str,
    typer.Argument(
        metavar="SCENARIO",
        help="A file, or the name of one that `treadwell list` shows.",
        autocompletion=completion.scenarios,
    ),
]
RobotOption = Annotated[
    str | None,
    typer.Option(
        "--robot",
        metavar="NAME",
        help="A robot's name or folder, not the file's.",
        autocompletion=completion.robots,
    ),
]
SeedOption = Annotated[
    int | None,
    typer.Option(
        "--seed",
        metavar="N",
        min=0,
        help="Seed of all that is random; one seed gives one result on one kind of processor.",
    ),
]
SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Change a key: course.stairs.rise=0.04. Repeatable.",
        autocompletion=completion.settings,
    ),
]
JsonOption = Annotated[
    bool, typer.Option("--json", help="Write JSON to standard output, and nothing else there.")
]
NoUserCodeOption = Annotated[
    bool, typer.Option("--no-user-code", help="Refuse a scenario that names a Python class.")
]
ShowCompletionOption = Annotated[
    completion.Shell | None,
    typer.Option("--show-completion", help="Show what makes a shell complete our words."),
]
InstallCompletionOption = Annotated[
    completion.Shell | None,
    typer.Option("--install-completion", help="Put that where new shells read it."),
]
