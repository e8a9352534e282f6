"""The verb `map`: a map of range data that was recorded elsewhere, or in a run."""

import sys
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Annotated, Final, Self

import typer

from treadwell.cli import completion
from treadwell.cli.options import JsonOption, NoUserCodeOption, SeedOption
from treadwell.cli.output import INTERRUPTED, PASSED, write_json, write_message, write_table

if TYPE_CHECKING:
    from treadwell.map_result import MapResult

EXAMPLE: Final = (
    "Examples: treadwell map terrain.pcd --world-model elevation --set elevation.cell=0.1; "
    "treadwell map intel-lab.log.gz --localizer scan_match"
)
_EVERY: Final = 500
"""Frames between two lines where there is no terminal."""


def map_(  # noqa: PLR0913 - one an option
    source: Annotated[
        Path,
        typer.Argument(
            metavar="SOURCE",
            help="A run, depth images or clouds with poses, one cloud, a height image, a laser "
            "log, ranges and bearings, a bag.",
        ),
    ],
    *,
    world_model: Annotated[
        str | None,
        typer.Option(
            "--world-model",
            metavar="NAME",
            help="Default: fog of pictures, elevation of clouds, landmarks of ranges and bearings, "
            "occupancy_2d of a laser's scans; of those also lines, topology, points.",
        ),
    ] = None,
    localizer: Annotated[
        str | None,
        typer.Option(
            "--localizer",
            metavar="NAME",
            help="truth: poses are taken as they are (default); scan_match: they are a laser's "
            "odometry, and its scans are placed by what they see.",
        ),
    ] = None,
    robot: Annotated[
        str | None,
        typer.Option(
            "--robot",
            metavar="NAME",
            help="A robot's name or folder: its height counts.",
            autocompletion=completion.robots,
        ),
    ] = None,
    camera: Annotated[
        Path | None,
        typer.Option("--camera", metavar="FILE", help="A camera.toml instead of the source's own."),
    ] = None,
    topics: Annotated[
        list[str] | None,
        typer.Option("--topic", metavar="NAME", help="Of a bag, what to read. Repeatable."),
    ] = None,
    seed: SeedOption = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="KEY=VALUE", help="elevation.cell=0.1, map.up=-y. Repeatable."
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Its folder; default: a new one in runs/."),
    ] = None,
    record: Annotated[
        bool, typer.Option("--record/--no-record", help="Keep the recording.")
    ] = True,
    no_user_code: NoUserCodeOption = False,
    as_json: JsonOption = False,
) -> int:
    """Make a map of range data that was recorded elsewhere, or in a run, without MuJoCo."""
    from treadwell.map_making.making import make_map
    from treadwell.map_making.request import read_request

    del no_user_code  # a map is made by what is built in
    request = read_request(
        source,
        world_model=world_model,
        localizer=localizer,
        robot=robot,
        camera=camera,
        topics=topics or (),
        seed=seed or 0,
        settings=settings or (),
    )
    with FrameLine(source.name) as progress:
        made = make_map(request, out=out, record=record, progress=progress)
    result = made.result
    if as_json:
        write_json(result.model_dump(mode="json", by_alias=True))
    else:
        _show(result)
    # Of a map without floor they say what went wrong.
    word = "warning:" if result.cells.floor == 0 and result.landmarks is None else "note:"
    for note in result.notes:
        write_message(f"{word:10} {note}")
    write_message(f"map:       {made.folder / 'map.png'}")
    if record:
        write_message(f"recording: treadwell inspect {made.folder}")
    return INTERRUPTED if result.interrupted else PASSED


def _show(result: "MapResult") -> None:
    rows: list[tuple[str, object]] = [
        ("source", f"{result.source.kind}, {result.source.path}"),
        ("frames used", f"{result.frames_used} of {result.frames}"),
        *((f"unused: {reason}", count) for reason, count in result.unused.items()),
        *_of_what(result),
        ("a frame, median", f"{result.timing_ms['map'].median:.2f} ms"),
        *((f"set by the data: {key}", value) for key, value in result.assumed.items()),
    ]
    write_table(f"{result.source.path} by {result.world_model}", ("", ""), rows)


def _of_what(result: "MapResult") -> list[tuple[str, str]]:
    if result.landmarks is not None:
        error = result.landmark_error
        told = [] if error is None else [("from where they were surveyed", f"{error:.3f} m")]
        return [("landmarks", str(len(result.landmarks))), *told]
    told = [
        ("cells of", f"{1e3 * result.cell:g} mm"),
        ("floor, obstacle", f"{result.cells.floor}, {result.cells.obstacle} cells"),
    ]
    if (matching := result.matching) is not None:
        told.append(("local maps, loops closed", f"{matching.local_maps}, {matching.loops_closed}"))
        told.append(("scans moved by, mean", f"{matching.moved:.3f} m"))
    if result.lines is not None:
        held = f"{result.lines.held:.1%}"
        told.append(("lines", f"{result.lines.count}, on which {held} of the points lie"))
    if (places := result.places) is not None:
        told.append(("places, ways", f"{places.count}, {len(places.ways)}"))
        told.append(("rooms, doorways", f"{places.rooms}, {len(places.doorways)}"))
    return told


class FrameLine:
    """Shows on standard error how a map gets on: one line on a terminal, else one in a hundred."""

    def __init__(self, title: str) -> None:
        """Show nothing yet."""
        self._title, self._terminal = title, sys.stderr.isatty()
        self._shown = False

    def __enter__(self) -> Self:
        """Begin."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Let the line vanish."""
        if self._terminal and self._shown:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()

    def update(self, frame: int, frames: int, used: int) -> None:
        """Show how many frames were read, of how many."""
        line = f"{self._title}: frame {frame} of {frames}, {used} used"
        if self._terminal:
            sys.stderr.write(f"\r\x1b[K{line}")
            sys.stderr.flush()
            self._shown = True
        elif frame % _EVERY == 0:
            write_message(line)
