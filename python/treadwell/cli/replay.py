"""The verb `replay`: the core over a run's observations, and whether it answered the same."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from treadwell.cli.output import (
    ERROR,
    FAILED,
    INTERRUPTED,
    PASSED,
    announce,
    write_json,
    write_message,
    write_table,
)
from treadwell.cli.progress import ProgressLine
from treadwell.plugins import examined, foreign_parts
from treadwell.summary import replay_rows, replay_title


def replay(
    run_dir: Path, *, settings: Sequence[str], out: Path | None, user_code: bool, as_json: bool
) -> int:
    """Replay a run, write what came of it, and return the exit status.

    Args:
        run_dir: the run's folder.
        settings: `KEY=VALUE` each.
        out: the replay's folder.
        user_code: False: a run whose scenario names a Python class is refused.
        as_json: write `result.json` to standard output instead of a table.
    """
    from treadwell.replaying.replay import replay_source
    from treadwell.replaying.source import open_source

    source = open_source(run_dir, settings)
    if user_code:
        parts = foreign_parts(source.scenario.navigation.slots())
        announce(examined(parts, str(source.path)))
    with ProgressLine(run_dir.name) as progress:
        done = replay_source(source, run_dir, out=out, progress=progress, user_code=user_code)
    document = done.result.document()
    facts = document["replay"]
    if as_json:
        write_json(document)
    else:
        show(document)
    if facts["broken"]:
        write_message(f"warning:   {facts['broken']}")
    write_message(f"replay:    {done.folder}")
    if done.interrupted:
        return INTERRUPTED
    if facts["error"]:
        return ERROR
    return PASSED if done.passed else FAILED


def show(document: Mapping[str, Any]) -> None:
    """Write the result as a table."""
    write_table(replay_title(document), ("", ""), replay_rows(document))
