"""The verb `sweep`: many episodes with a bar of successes so far, and the counts as a table."""

from pathlib import Path
from typing import Any

from treadwell.cli.output import (
    FAILED,
    PASSED,
    announce,
    write_json,
    write_message,
    write_notes,
    write_table,
)
from treadwell.cli.sweep_progress import SweepProgress
from treadwell.recording.run_folder import sweep_folder
from treadwell.sweeps.asked import Asked
from treadwell.sweeps.conduct import Care, conduct
from treadwell.sweeps.summary import summary_table
from treadwell.sweeps.sweep import chosen_engine


def sweep(
    asked: Asked,
    *,
    engine: str,
    workers: int | None,
    care: Care,
    out: Path | None,
    user_code: bool,
    as_json: bool,
) -> int:
    """Run a sweep, show its counts, and return the exit status.

    Args:
        asked: which episodes.
        engine: `local` or `ray`.
        workers: episodes at a time; None: as many as there are cores.
        care: limits, and what is kept.
        out: the folder.
        user_code: False: a scenario that names a Python class is refused.
        as_json: write the counts to standard output as JSON instead of a table.

    Raises:
        InputError: what was given is bad, or the folder cannot be taken.
        RecordingError: the folder cannot be written.
    """
    request = asked.request()
    if not user_code:
        request.refuse_user_code()
    announce(request.python())
    write_notes(request.unread())
    folder = sweep_folder(out, asked.name)
    with SweepProgress(len(request.keys())) as progress:
        try:
            made = chosen_engine(engine, workers)
            document = conduct(
                request,
                folder,
                made,
                care=care,
                progress=progress,
                command=asked.command,
                told=write_message,
            )
        except KeyboardInterrupt:
            write_message(
                f"{progress.done} of {len(request.keys())} episodes are done; "
                f"the same command with --out {folder} goes on"
            )
            raise
    if as_json:
        shown = {key: value for key, value in document.items() if key != "episodes"}
        write_json({"folder": str(folder), **shown})
    else:
        show(document)
    write_message(f"results: {folder / 'results.json'}")
    return PASSED if document["passed"] else FAILED


def show(document: dict[str, Any]) -> None:
    """Write the counts as a table."""
    table = summary_table(document)
    for note in table.notes:
        write_message(note)
    write_table(table.title, table.header, table.rows)
