"""`scenario.toml`: the scenario as it was run, overrides and draws applied; it runs again as it is.

The first line is a comment that names the file it came from. What such a file names beside itself,
a mesh or an MJCF world, is not copied: that scenario runs from its own folder only.
"""

import json
from pathlib import Path
from typing import Any, Final

import tomli_w

from treadwell.careful_json import json_of
from treadwell.errors import InputError
from treadwell.files import opened, write_text
from treadwell.scenario.model import Scenario

NAME: Final = "scenario.toml"
_ORIGIN: Final = "# as it was run; from "
_LONGEST_LINE: Final = 10_000


def write_scenario(path: Path, scenario: Scenario) -> None:
    """Write the file whole or not at all.

    Raises:
        OSError: the file cannot be written.
    """
    origin = None if scenario.path is None else str(scenario.path.absolute())
    text = tomli_w.dumps(without_nothing(scenario.configuration()))
    write_text(path, f"{_ORIGIN}{json.dumps(origin)}\n{text}")


def origin_of(path: Path) -> Path | None:
    """Return the file that a `scenario.toml` came from; None where it does not say or is broken."""
    try:
        with opened(path) as file:
            line = file.readline(_LONGEST_LINE).decode()
        named = json_of(line.removeprefix(_ORIGIN), str(path)) if line.startswith(_ORIGIN) else None
    except (InputError, OSError, ValueError):
        return None
    return Path(named) if isinstance(named, str) and "\x00" not in named else None


def without_nothing(value: Any) -> Any:  # noqa: ANN401 - any JSON
    """Return plain data without its keys that are None: TOML has no such value."""
    if isinstance(value, dict):
        return {key: without_nothing(item) for key, item in value.items() if item is not None}
    if isinstance(value, list):
        return [without_nothing(item) for item in value]
    return value
