"""The options of the verbs on runs' folders: `inspect`, `verify`, `replay`, `report`, `export`."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Final

import typer

from treadwell.cli import completion
from treadwell.cli.options import JsonOption, NoUserCodeOption
from treadwell.cli.output import PASSED, write_json, write_message

INSPECT_EXAMPLE: Final = "Example: treadwell inspect runs/latest"
VERIFY_EXAMPLE: Final = "Example: treadwell verify runs/*"
REPLAY_EXAMPLE: Final = (
    "Example: treadwell replay runs/latest --set navigation.world_model=averaging"
)
REPORT_EXAMPLE: Final = "Example: treadwell report runs/latest --video runs/latest/run.mp4"
EXPORT_EXAMPLE: Final = "Example: treadwell export runs/latest --to octomap --out maps"


class To(StrEnum):
    """What `export` can write."""

    OCTOMAP = "octomap"
    MAP_SERVER = "map_server"
    PLY = "ply"
    TUM = "tum"
    MCAP = "mcap"
    GLTF = "gltf"
    ROSBAG2 = "rosbag2"


class Storage(StrEnum):
    """How a bag of ROS 2 is stored."""

    MCAP = "mcap"
    SQLITE3 = "sqlite3"


def inspect(
    run_dir: Annotated[Path, typer.Argument(metavar="RUN_DIR", help="A run's folder.")],
    *,
    web: Annotated[bool, typer.Option("--web", help="Show it in a browser.")] = False,
    as_json: JsonOption = False,
) -> int:
    """Open a run's recording in the rerun viewer."""
    from treadwell.recording import recorder as recording
    from treadwell.recording.cut_off import cut_run

    cut = cut_run(run_dir)
    if cut is not None:
        write_message(f"{run_dir}: {cut.sentence()}")
    recording.inspect(run_dir, web=web)
    if as_json:
        write_json({"run": str(run_dir), "cut": None if cut is None else cut.seconds})
    return PASSED


def verify(
    run_dirs: Annotated[list[Path], typer.Argument(metavar="RUN_DIR...", help="Runs' folders.")],
    *,
    against: Annotated[
        Path | None,
        typer.Option("--against", metavar="RUN_DIR", help="Say where each first differs from it."),
    ] = None,
    as_json: JsonOption = False,
) -> int:
    """Check that a run's files are whole, and that plain MuJoCo steps to the same states."""
    from treadwell.cli import verify as cli_verify

    return cli_verify.verify(run_dirs, against=against, as_json=as_json)


def replay(
    run_dir: Annotated[Path, typer.Argument(metavar="RUN_DIR", help="A run's folder.")],
    *,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="Another navigation.planner=..., say. Repeatable.",
            autocompletion=completion.settings,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Its folder; default: a new one beside."),
    ] = None,
    no_user_code: NoUserCodeOption = False,
    as_json: JsonOption = False,
) -> int:
    """Run the core again over what a run recorded, without MuJoCo, and compare its answers."""
    from treadwell.cli import replay as cli_replay

    return cli_replay.replay(
        run_dir,
        settings=settings or [],
        out=out,
        user_code=not no_user_code,
        as_json=as_json,
    )


def report(
    run_dirs: Annotated[
        list[Path], typer.Argument(metavar="RUN_DIR...", help="Runs' folders, or a sweep's.")
    ],
    *,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="FILE", help="The page; default: report.html in the only folder."
        ),
    ] = None,
    video: Annotated[
        Path | None,
        typer.Option("--video", metavar="FILE", help="Also write a film: .mp4 or .gif."),
    ] = None,
    as_json: JsonOption = False,
) -> int:
    """Write a page on a run, on several, or on a sweep; it opens with no network."""
    from treadwell.cli import report as cli_report

    document = cli_report.reported(run_dirs, out=out, video=video)
    if as_json:
        write_json(document)
    return PASSED


def export(
    run_dir: Annotated[
        Path,
        typer.Argument(
            metavar="RUN_DIR", help="A run's folder; for octomap a scenario, too: its course."
        ),
    ],
    *,
    to: Annotated[To, typer.Option("--to", help="The format.")],
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Where to; default: export-... in the run's."),
    ] = None,
    storage: Annotated[
        Storage | None,
        typer.Option("--storage", help="Of rosbag2: mcap (default), or sqlite3 for ROS 2 Humble."),
    ] = None,
    as_json: JsonOption = False,
) -> int:
    """Write files that other tools open: maps, clouds, ways, messages."""
    from treadwell.cli import export as cli_export

    document = cli_export.exported(
        run_dir, to.value, out, None if storage is None else storage.value
    )
    if as_json:
        write_json(document)
    return PASSED
