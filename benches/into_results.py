"""`--results SUBJECT`: what a script measured, into docs/results by `tools/docs/results.py`."""

import argparse
import shlex
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "tools" / "docs"))
NOT_REPEATED = ("--results", "--table", "--json", "--keep")
"""Options with a value that say where results go, and nothing of what is measured."""


@dataclass(frozen=True)
class Target:
    """A subject, and the commit that was checked out before anything was measured."""

    subject: str
    commit: str


def add_options(parser: argparse.ArgumentParser, *, table: bool = True) -> None:
    """Add `--results`, and `--table` where a script writes a single table."""
    parser.add_argument(
        "--results", type=_target, metavar="SUBJECT", help="write a table into docs/results"
    )
    if table:
        parser.add_argument("--table", help="its title, if not the script's own")


def write(
    options: argparse.Namespace,
    title: str,
    seeds: Sequence[int] | None,
    rows: Sequence[dict[str, Any]],
    command: str | None = None,
) -> None:
    """Write a table where `--results` asks for it.

    Args:
        options: as they were read.
        title: of the table, unless `--table` says otherwise.
        seeds: that were used.
        rows: each with `what` and `measured`.
        command: what repeats it; by default what was typed.
    """
    if options.results is None:
        return
    from results import record

    record(
        options.results.subject,
        getattr(options, "table", None) or title,
        command or repeated(sys.argv),
        None if seeds is None else seed_range(seeds),
        rows,
        commit=options.results.commit,
    )


def repeated(words: Sequence[str]) -> str:
    """Return the command that measures the same again, without a path of this machine."""
    script, *rest = words
    kept: list[str] = []
    skip = False
    for word in rest:
        if skip or word.partition("=")[0] in NOT_REPEATED:
            skip = not skip and "=" not in word
            continue
        kept.append(Path(word).name if Path(word).is_absolute() else word)
    return shlex.join(["python", _from_root(Path(script)), *kept])


def seed_range(seeds: Sequence[int]) -> str:
    """Return `100-119` or `3`."""
    return str(seeds[0]) if len(seeds) == 1 else f"{seeds[0]}-{seeds[-1]}"


def _from_root(script: Path) -> str:
    full = script.resolve()
    return str(full.relative_to(ROOT)) if full.is_relative_to(ROOT) else script.name


def _target(subject: str) -> Target:
    from pages import load
    from results import checked_out

    try:
        load(subject)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return Target(subject, checked_out())
