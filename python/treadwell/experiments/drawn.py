"""Scenarios that are drawn, not written by hand: their files, so that each can be run again."""

from pathlib import Path
from typing import Any

import tomli_w

from treadwell.files import write_text


def write_scenario(path: Path, table: dict[str, Any]) -> str:
    """Write a drawn scenario and return its path, as `load_scenario` takes it.

    Raises:
        OSError: it cannot be written.
    """
    write_text(path, tomli_w.dumps(table))
    return str(path)
