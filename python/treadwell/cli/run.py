"""The verb `run`: one episode with its progress line, and its result as a table."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from treadwell.cli.output import (
    ERROR,
    FAILED,
    INTERRUPTED,
    PASSED,
    announce,
    write_json,
    write_message,
    write_notes,
    write_table,
)
from treadwell.cli.progress import ProgressLine
from treadwell.plugins import examined, foreign_parts
from treadwell.scenario.loading import load_scenario
from treadwell.scenario.unread import unread, unread_tables
from treadwell.summary import result_rows, result_title

STATUS: Final = {"interrupted": INTERRUPTED, "error": ERROR}
"""Outcomes that are not the robot's doing -> exit status."""


def run(  # noqa: PLR0913 - one an option
    scenario: str,
    *,
    robot: str | None,
    seed: int | None,
    settings: Sequence[str],
    out: Path | None,
    record: bool,
    view: bool,
    user_code: bool,
    as_json: bool,
) -> int:
    """Run an episode, write its result, and return the exit status.

    Args:
        scenario: a file or a name.
        robot: instead of the file's.
        seed: instead of the file's.
        settings: `KEY=VALUE` each.
        out: the run's folder.
        record: keep the recording and the observations.
        view: show the physics in a window.
        user_code: False: a scenario that names a Python class is refused.
        as_json: write `result.json` to standard output instead of a table.
    """
    from treadwell.runner import run as run_episode

    made = load_scenario(scenario, robot=robot, seed=seed, overrides=settings)
    if user_code:
        announce(examined(foreign_parts(made.navigation.slots()), str(made.path)))
    write_notes([*unread(made).values(), *unread_tables(made)])
    with ProgressLine(Path(scenario).stem) as progress:
        result = run_episode(
            made, out=out, record=record, view=view, progress=progress, user_code=user_code
        )
    document = result.document
    if as_json:
        write_json(document)
    else:
        show(document)
    if result.least_clearance is not None:
        write_message(f"clearance: {100 * result.least_clearance:.1f} cm at the narrowest place")
    write_message(f"map:       {result.folder / 'map.png'}")
    if record:
        write_message(f"recording: treadwell inspect {result.folder}")
    return exit_status(document)


def exit_status(document: Mapping[str, Any]) -> int:
    """Return the exit status that a `result.json` means."""
    return STATUS.get(document["outcome"], PASSED if document["passed"] else FAILED)


def show(document: Mapping[str, Any]) -> None:
    """Write the result as a table."""
    write_table(result_title(document), ("", ""), result_rows(document))
