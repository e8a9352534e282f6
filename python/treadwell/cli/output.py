"""How the command line speaks: JSON or text on standard output, messages and errors beside it."""

import errno
import json
import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal

from treadwell.errors import InputError, TreadwellError
from treadwell.interruption import leave_terminal
from treadwell.shell_limits import RECORDED_RUN, tightness

if TYPE_CHECKING:
    from treadwell.plugins import ForeignPart

PASSED: Final = 0
FAILED: Final = 1
BAD_INPUT: Final = 2
ERROR: Final = 3
INTERRUPTED: Final = 130
SHOW_TRACEBACK: Final = "TREADWELL_TRACEBACK"
"""Environment variable: when it is set, an unexpected error shows where it happened."""


@contextmanager
def _to_somebody() -> Iterator[None]:
    """Take a terminal closed under a word for the signal that it sends, which may be late."""
    try:
        yield
    except OSError as error:
        if error.errno != errno.EIO:
            raise
        leave_terminal()
        raise KeyboardInterrupt from error


def write_json(document: object) -> None:
    """Write a document to standard output; nothing else goes there with `--json`."""
    with _to_somebody():
        sys.stdout.write(json.dumps(document, indent=2, allow_nan=False, default=str) + "\n")
        sys.stdout.flush()


def write_message(text: str) -> None:
    """Write a line to standard error."""
    with suppress(OSError):  # nobody is there any more to read it
        sys.stderr.write(text.rstrip("\n") + "\n")
        sys.stderr.flush()


def announce(parts: "Mapping[ForeignPart, Path | None]") -> None:
    """Say which Python a scenario is about to run, on standard error; nothing where it is none.

    Args:
        parts: what `treadwell.plugins.examined` returned.
    """
    for part, file in parts.items():
        write_message(f"python:    {part.said(file)}")


def write_notes(notes: Iterable[str]) -> None:
    """Say what may be other than it was meant, on standard error; nothing where there is nothing.

    Args:
        notes: a sentence each, without a full stop.
    """
    for note in notes:
        write_message(f"note:      {note}")


_WIDTH_OF_A_FILE: Final = 160
"""Columns."""


def write_table(title: str, header: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
    """Write a table to standard output."""
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(title=Text(title, style="bold"), box=SIMPLE_HEAD, title_justify="left")
    alone = len(header) == 1
    for number, name in enumerate(header):
        # Names are what one types next: never broken. A column alone has sentences: never cut.
        overflow: Literal["fold", "ellipsis"] = "fold" if alone else "ellipsis"
        table.add_column(name, no_wrap=number == 0 and not alone, overflow=overflow)
    for row in rows:
        # Text and not markup: names and descriptions are the user's.
        table.add_row(*(Text(str(cell)) for cell in row))
    # Into a file or a pipe nothing has to be broken into short lines.
    console = Console(width=None if sys.stdout.isatty() else _WIDTH_OF_A_FILE)
    with _to_somebody():
        console.print(table)


def guarded(command: Callable[[], Any], *, as_json: bool) -> int:
    """Run a command and return its exit status; whatever goes wrong becomes one message.

    Args:
        command: returns an exit status, or None for success.
        as_json: write the error as JSON to standard output, too.
    """
    try:
        status = command()
        with _to_somebody():
            sys.stdout.flush()
    except KeyboardInterrupt:
        return _fail("interrupted", INTERRUPTED, as_json=as_json)
    except BrokenPipeError:
        # Who reads our output has had enough; what Python flushes at the end must not fail again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return PASSED
    except Exception as error:
        if os.environ.get(SHOW_TRACEBACK):
            raise
        return _fail(*_verdict(error), as_json=as_json)
    return PASSED if status is None else int(status)


def _verdict(error: Exception) -> tuple[str, int]:
    """Return the message and the exit status that an error means."""
    usage = getattr(error, "format_message", None)
    if usage is not None and getattr(error, "exit_code", None) == BAD_INPUT:
        return with_nearest(str(usage())), BAD_INPUT
    if isinstance(error, TreadwellError):
        return str(error), BAD_INPUT if isinstance(error, InputError) else ERROR
    text = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    if tight := tightness(RECORDED_RUN):
        text += f"; {tight}"
    elif not isinstance(error, OSError | MemoryError):
        text += f"\n(this is a fault of treadwell; set {SHOW_TRACEBACK}=1 to see where)"
    return text, ERROR


def with_nearest(message: str) -> str:
    """Return what the command line's parser says of a word, with the nearest that it takes."""
    message = message.replace("Value error, ", "")
    found = re.search(r"'([^']*)' is not one of ('.*')\.$", message)
    if found is None:
        return message
    from treadwell.scenario.messages import nearest

    near = nearest(found[1], re.findall(r"'([^']*)'", found[2]))
    return f"{message.removesuffix('.')}{near}" if near else message


def _fail(message: str, status: int, *, as_json: bool) -> int:
    if message:  # nothing when help was shown because there was no command
        write_message(f"treadwell: {message}" if status == INTERRUPTED else f"error: {message}")
    if as_json:
        with suppress(KeyboardInterrupt):  # the status says it
            write_json({"error": message, "status": status})
    return status
