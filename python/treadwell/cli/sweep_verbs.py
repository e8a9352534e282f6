"""The options of the verbs `sweep` and `compare`."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Final

import typer

from treadwell.cli import completion
from treadwell.cli.options import JsonOption, NoUserCodeOption, RobotOption, SetOption

SWEEP_EXAMPLE: Final = (
    "Example: treadwell sweep slalom doorway --episodes 20 "
    "--vary navigation.world_model=fog,averaging --out runs/maps"
)
COMPARE_EXAMPLE: Final = (
    "Example: treadwell compare runs/maps --out comparison.md --figure comparison.pdf"
)


class Where(StrEnum):
    """Where a sweep can run."""

    LOCAL = "local"
    RAY = "ray"


def sweep(  # noqa: PLR0913 - one an option
    scenarios: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="SCENARIO...",
            help="Files or names; none with --suite.",
            autocompletion=completion.scenarios,
        ),
    ] = None,
    *,
    episodes: Annotated[
        int | None,
        typer.Option(
            "--episodes",
            metavar="N",
            min=1,
            help="Seeds of each, 0 to N-1; one seed gives one result on one kind of processor.",
        ),
    ] = None,
    first_seed: Annotated[
        int, typer.Option("--first-seed", metavar="N", min=0, help="The first seed, if not 0.")
    ] = 0,
    suite: Annotated[
        str | None,
        typer.Option(
            "--suite",
            metavar="NAME",
            help="A frozen list of episodes.",
            autocompletion=completion.suites,
        ),
    ] = None,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            metavar="KEY=A,B,C",
            help="A variant for each value. Repeatable.",
            autocompletion=completion.settings,
        ),
    ] = None,
    settings: SetOption = None,
    robot: RobotOption = None,
    workers: Annotated[
        int | None,
        typer.Option("--workers", metavar="K", min=1, help="Episodes at a time; default: cores."),
    ] = None,
    engine: Annotated[
        Where, typer.Option("--engine", help="This machine, or a Ray cluster.")
    ] = Where.LOCAL,
    timeout: Annotated[
        float, typer.Option("--timeout", metavar="S", min=1.0, help="Seconds for an episode.")
    ] = 600.0,
    memory: Annotated[
        float,
        typer.Option("--memory", metavar="GB", min=0.5, max=1e6, help="Memory for an episode."),
    ] = 4.0,
    keep: Annotated[
        int,
        typer.Option("--keep", metavar="N", min=0, help="First seeds kept even if all went well."),
    ] = 3,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Its folder; one that is there goes on."),
    ] = None,
    no_user_code: NoUserCodeOption = False,
    as_json: JsonOption = False,
) -> int:
    """Run many episodes, side by side; the same command goes on where it was stopped."""
    from treadwell.cli import sweep as cli_sweep
    from treadwell.sweeps.asked import Asked, care

    asked = Asked(
        scenarios=tuple(scenarios or ()),
        suite=suite,
        episodes=episodes,
        first_seed=first_seed,
        robot=robot,
        settings=tuple(settings or ()),
        vary=tuple(vary or ()),
    )
    return cli_sweep.sweep(
        asked,
        engine=engine.value,
        workers=workers,
        care=care(timeout, memory, keep),
        out=out,
        user_code=not no_user_code,
        as_json=as_json,
    )


def compare(
    sweep_dirs: Annotated[
        list[Path], typer.Argument(metavar="SWEEP_DIR...", help="Sweeps' folders.")
    ],
    *,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE.md", help="Write the tables there.")
    ] = None,
    figure: Annotated[
        Path | None,
        typer.Option(
            "--figure",
            metavar="FILE.pdf|.svg|.png",
            help="Draw it there for a paper: successes, differences, ways.",
        ),
    ] = None,
    as_json: JsonOption = False,
) -> int:
    """Put sweeps, and the variants of each, side by side; paired by scenario and seed."""
    from treadwell.cli import compare as cli_compare

    return cli_compare.compare(sweep_dirs, out=out, figure=figure, as_json=as_json)
