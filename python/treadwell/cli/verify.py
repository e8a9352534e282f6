"""The verb `verify`: whether runs are whole, and where one first differs from another."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from treadwell.cli.output import FAILED, PASSED, write_json
from treadwell.errors import InputError
from treadwell.processor import likely_reason
from treadwell.recording.observation_log import NAME, read_header
from treadwell.recording.verification import verify as verify_runs
from treadwell.replaying.difference import between_logs


def verify(run_dirs: Sequence[Path], *, against: Path | None, as_json: bool) -> int:
    """Verify runs, write what was found, and return the exit status.

    Args:
        run_dirs: the runs' folders.
        against: another run's, whose recording theirs are compared with.
        as_json: write JSON to standard output.

    Raises:
        InputError: a folder is not there, or there is no recording to compare with.
    """
    for run_dir in (*run_dirs, *(() if against is None else (against,))):
        if not run_dir.is_dir():
            raise InputError(f"{run_dir}: there is no such run")
    found = {str(run_dir): _found(run_dir, against) for run_dir in run_dirs}
    if as_json:
        write_json(found)
    else:
        for name, table in found.items():
            print(f"{name}: {_sentence(table)}")
    whole = all(table["whole"] and not table.get("first_difference") for table in found.values())
    return PASSED if whole else FAILED


def _found(run_dir: Path, against: Path | None) -> dict[str, Any]:
    (seen,) = verify_runs([run_dir])
    cut = seen.cut
    table: dict[str, Any] = {"whole": seen.passed, "faults": list(seen.problems)}
    table |= {"cut": None if cut is None else cut.seconds}
    if cut is not None:
        left = f"; what it left is whole, {seen.steps} physics steps are the same"
        table["cut_sentence"] = cut.sentence() + ("" if seen.problems else left)
    if against is not None:
        first, other = read_header(against / NAME), read_header(run_dir / NAME)
        joints = first.get("joints", "").split(",")
        difference = between_logs(against / NAME, run_dir / NAME, joints)
        table["first_difference"] = None
        if difference is not None:
            what = {"tick": difference.tick, "time": difference.time_s, "what": difference.what}
            sentence = difference.sentence()
            if first.get("version") == other.get("version") and "processor" in other:
                reason = likely_reason(first.get("processor"), other["processor"])
                sentence += reason and ", " + reason
            table |= {"first_difference": what, "sentence": sentence}
    return table


def _sentence(table: dict[str, Any]) -> str:
    parts = table["faults"]
    if "cut_sentence" in table:
        parts = [table.pop("cut_sentence"), *parts]
    parts = parts or ["whole, the same states"]
    if "first_difference" in table:
        parts = [*parts, table.pop("sentence", "the same recording, bit for bit")]
    return "; ".join(parts)
