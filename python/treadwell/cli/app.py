"""The command line `treadwell`: its verbs, their options, and the exit status of each."""

import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from types import FrameType
from typing import Annotated

import typer

from treadwell.cli import completion, list_verbs, run_verbs, sweep_verbs
from treadwell.cli import map as map_verb
from treadwell.cli import serve as serve_verb
from treadwell.cli.options import (
    InstallCompletionOption,
    JsonOption,
    NoUserCodeOption,
    RobotOption,
    ScenarioArgument,
    SeedOption,
    SetOption,
    ShowCompletionOption,
)
from treadwell.cli.output import ERROR, INTERRUPTED, PASSED, guarded, write_json
from treadwell.interruption import SIGNALS, leave_terminal

app = typer.Typer(
    name="treadwell",
    help="A small humanoid finds its own way over an obstacle course, by its senses alone.",
    epilog="Exit status: 0 it met its expectations, 1 it did not, 2 the input is bad, "
    "3 anything else, 130 interrupted.",
    add_completion=False,  # our own options: typer's take no shell's name
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # rich takes longer to import than all else together
)

robot_app = typer.Typer(help="What a robot's folder holds.")
app.add_typer(robot_app, name="robot")


@app.callback(invoke_without_command=True)
def _options(
    context: typer.Context,
    *,
    version: Annotated[bool, typer.Option("--version", help="Show the version.")] = False,
    show_completion: ShowCompletionOption = None,
    install_completion: InstallCompletionOption = None,
) -> None:
    if version:
        from treadwell.version import __version__

        typer.echo(f"treadwell {__version__}")
        raise typer.Exit
    completion.show(show_completion)
    completion.install(install_completion)
    _help_without_verb(context)


@robot_app.callback(invoke_without_command=True)
def _help_without_verb(context: typer.Context) -> None:
    """Show the help where no verb follows; not `no_args_is_help`, which takes it for an error."""
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


@app.command(epilog="Example: treadwell run slalom --seed 3 --set physics.friction=0.6")
def run(  # noqa: PLR0913 - one an option
    scenario: ScenarioArgument,
    *,
    robot: RobotOption = None,
    seed: SeedOption = None,
    settings: SetOption = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="The run's folder; default: a new one in runs/."),
    ] = None,
    record: Annotated[
        bool, typer.Option("--record/--no-record", help="Keep the recording and observations.")
    ] = True,
    view: Annotated[bool, typer.Option("--view", help="Watch the physics in a window.")] = False,
    no_user_code: NoUserCodeOption = False,
    as_json: JsonOption = False,
) -> int:
    """Run one closed-loop episode, and say how it went."""
    from treadwell.cli import run as cli_run

    return cli_run.run(
        scenario,
        robot=robot,
        seed=seed,
        settings=settings or [],
        out=out,
        record=record,
        view=view,
        user_code=not no_user_code,
        as_json=as_json,
    )


@app.command(
    short_help="Say what a scenario file would build, or what is wrong.",
    epilog="Example: treadwell check scenarios/slalom.toml --set goal.radius=0.1",
)
def check(
    scenario: ScenarioArgument,
    *,
    robot: RobotOption = None,
    seed: SeedOption = None,
    settings: SetOption = None,
    as_json: JsonOption = False,
) -> int:
    """Check a scenario file and say what it would build; nothing is run, nor imported."""
    from treadwell.cli import check as cli_check

    document = cli_check.checked(scenario, robot=robot, seed=seed, settings=settings or [])
    if as_json:
        write_json(document)
    else:
        cli_check.show(document)
    return PASSED


app.command(
    "list",
    short_help="Show the scenarios, robots, components, ... there are.",
    epilog=list_verbs.LIST_EXAMPLE,
)(list_verbs.list_)
app.command(
    "map",
    short_help="Make a map of range data of others, or of a run.",
    epilog=map_verb.EXAMPLE,
)(map_verb.map_)
app.command(
    short_help="Write a JSON schema of a file, for editors.", epilog=list_verbs.SCHEMA_EXAMPLE
)(list_verbs.schema)
app.command(epilog=run_verbs.INSPECT_EXAMPLE)(run_verbs.inspect)
app.command(
    short_help="Check a run's files, and step its physics again.", epilog=run_verbs.VERIFY_EXAMPLE
)(run_verbs.verify)
app.command(
    short_help="Run the core again over what a run recorded.", epilog=run_verbs.REPLAY_EXAMPLE
)(run_verbs.replay)
app.command(
    short_help="Write a page on a run, on several, or on a sweep.", epilog=run_verbs.REPORT_EXAMPLE
)(run_verbs.report)
app.command(short_help="Write files that other tools open.", epilog=run_verbs.EXPORT_EXAMPLE)(
    run_verbs.export
)
app.command(short_help="Be the core of a robot elsewhere.", epilog=serve_verb.EXAMPLE)(
    serve_verb.serve
)


@app.command(
    short_help="Run a paper's experiments, its figures beside ours.",
    epilog="Example: treadwell experiment stairs --seeds 5 --out runs/stairs",
)
def experiment(  # noqa: PLR0913 - one an option
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME",
            help="One of `treadwell list experiments`.",
            autocompletion=completion.experiments,
        ),
    ],
    *,
    seeds: Annotated[
        int, typer.Option("--seeds", metavar="N", min=1, help="Seeds of each scenario.")
    ] = 3,
    first_seed: Annotated[
        int, typer.Option("--first-seed", metavar="N", min=0, help="The first of them.")
    ] = 0,
    robots: Annotated[
        list[str] | None,
        typer.Option(
            "--robots",
            metavar="NAME|FOLDER",
            help="Which robot takes part in `robots`; may be given again; default: all that ship.",
            autocompletion=completion.robots,
        ),
    ] = None,
    only: Annotated[
        list[str] | None,
        typer.Option(
            "--only",
            metavar="CASE",
            help="Only this case; may be given again.",
            autocompletion=completion.cases,
        ),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option("--workers", metavar="N", min=1, help="Episodes at a time; default: cores."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Its folder; default: a new one in runs/."),
    ] = None,
    record: Annotated[
        bool, typer.Option("--record", help="Keep a recording of every run, to inspect or replay.")
    ] = False,
    as_json: JsonOption = False,
) -> int:
    """Run a paper's experiments, and print its figures with ours beside them."""
    from treadwell.cli import experiment as cli_experiment

    return cli_experiment.experiment(
        name,
        robots=robots or (),
        only=only or (),
        seeds=range(first_seed, first_seed + seeds),
        workers=workers,
        out=out,
        record=record,
        as_json=as_json,
    )


@app.command(
    short_help="Time the core on a fixed workload, and an episode.",
    epilog="Example: treadwell bench occupancy --frames 20",
)
def bench(
    names: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[NAME]...", help="Which: occupancy, step, episode; all without it."
        ),
    ] = None,
    *,
    frames: Annotated[
        str | None,
        typer.Option("--frames", metavar="PATH|N", help="Depth frames; or how many are made."),
    ] = None,
    as_json: JsonOption = False,
) -> int:
    """Time the core on a fixed workload, and an episode against physics that never change."""
    from treadwell.cli import bench as cli_bench

    document = cli_bench.bench(names or [], frames)
    if as_json:
        write_json(document)
    else:
        cli_bench.show(document)
    return PASSED


app.command(short_help="Run many episodes, on all cores.", epilog=sweep_verbs.SWEEP_EXAMPLE)(
    sweep_verbs.sweep
)
app.command(
    short_help="Put sweeps and their variants side by side.", epilog=sweep_verbs.COMPARE_EXAMPLE
)(sweep_verbs.compare)


@robot_app.command("check", epilog="Example: treadwell robot check my_robot --walk")
def robot_check(
    folder: Annotated[
        Path,
        typer.Argument(metavar="FOLDER", help="With an MJCF and robot.toml; or a robot's name."),
    ],
    *,
    walk: Annotated[bool, typer.Option("--walk", help="Let it walk a metre, too.")] = False,
    template: Annotated[
        bool,
        typer.Option("--write-template", help="Write a draft of robot.toml from the MJCF first."),
    ] = False,
    model: Annotated[
        str | None,
        typer.Option(
            "--model",
            metavar="FILE",
            help="With --write-template: which of the folder's models is the robot.",
        ),
    ] = None,
    as_json: JsonOption = False,
) -> int:
    """Report what a robot's folder holds, what is missing, and what its gait can do."""
    from treadwell.cli import robot as cli_robot

    return cli_robot.check(folder, walk=walk, template=template, model=model, as_json=as_json)


def execute(arguments: Sequence[str]) -> int:
    """Run the command line and return its exit status.

    Args:
        arguments: what follows `treadwell`.
    """

    def command() -> int:
        status = app(list(arguments), prog_name="treadwell", standalone_mode=False)
        return status if isinstance(status, int) else PASSED

    return guarded(command, as_json="--json" in arguments)


def main() -> None:
    """Run the command line and leave with its exit status."""

    def stop(number: int, _frame: FrameType | None) -> None:
        if number == signal.SIGHUP:
            leave_terminal()
        raise KeyboardInterrupt

    status = INTERRUPTED
    try:
        # A run that is told to end, or whose terminal is closed, ends as after Ctrl-C.
        for number in (signal.SIGTERM, signal.SIGHUP):
            if signal.getsignal(number) != signal.SIG_IGN:
                signal.signal(number, stop)
        completion.prepare()
        status = execute(sys.argv[1:])
    except KeyboardInterrupt:
        pass
    except SystemExit as error:
        status = error.code if isinstance(error.code, int) else ERROR
    finally:
        for number in SIGNALS:  # all is said; what comes now would only add a traceback
            signal.signal(number, signal.SIG_IGN)
    sys.exit(status)


if __name__ == "__main__":
    main()
