"""The folder of a sweep as far as a page needs it: rows of episodes, whatever keys they lack."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from treadwell.careful_json import json_of
from treadwell.errors import InputError
from treadwell.files import read_text
from treadwell.sweeps.agreement import LARGEST
from treadwell.sweeps.folder import kept_folder
from treadwell.sweeps.journal import NAME as JOURNAL
from treadwell.sweeps.journal import read_rows

ASKED, RESULTS = "sweep.json", "results.json"


@dataclass(frozen=True, slots=True)
class EpisodeRow:
    """One episode of a sweep.

    Attributes:
        scenario, robot, variant, seed, outcome, reason: as text; empty where unknown.
        success: it met its expectations, or refused where there is no way.
        end: (x, y) m where the robot was in the end; None: not known.
        folder: of the kept run; None where it was not kept or is gone.
        settings: `KEY=VALUE` that the variant stands for.
        source: the scenario as `treadwell run` is given it: a name or a file.
        robot_given: as it is given the robot; None: not.
        seconds: simulated; None: not known.
        error: mean error of localization, m; None: not known.
    """

    scenario: str
    robot: str
    variant: str
    seed: str
    outcome: str
    reason: str
    success: bool
    end: tuple[float, float] | None
    folder: Path | None
    settings: tuple[str, ...]
    seconds: float | None
    error: float | None
    source: str = ""
    robot_given: str | None = None

    @property
    def line(self) -> tuple[str, str, str]:
        """What its line of the table is about: scenario, robot, variant."""
        return self.scenario, self.robot, self.variant


@dataclass(frozen=True, slots=True)
class SweepData:
    """A sweep: its folder, what was asked for, the command that asks for it again, and its rows."""

    folder: Path
    asked: dict[str, Any]
    rows: tuple[EpisodeRow, ...]
    problems: tuple[str, ...]
    command: str = ""


def is_sweep(folder: Path) -> bool:
    """Whether a folder is a sweep's."""
    return (folder / RESULTS).is_file() or (folder / ASKED).is_file()


def read_sweep(folder: Path) -> SweepData:
    """Read a sweep's folder.

    Raises:
        InputError: a file is broken.
    """
    problems: list[str] = []
    asked = _document(folder / ASKED, problems)
    found = _document(folder / RESULTS, problems)
    episodes = found.get("episodes", []) if isinstance(found, dict) else found
    if not isinstance(episodes, list) or not all(isinstance(row, dict) for row in episodes):
        raise InputError(f"{folder / RESULTS}: episodes: must be a list of tables")
    noted = read_rows(folder / JOURNAL)
    if len(noted) > len(episodes):  # it was stopped before it wrote them all
        episodes = noted
    lines = _lines(asked)
    rows = tuple(_row(folder, row, lines) for row in episodes)
    wanted = sum(len(line.get("seeds") or ()) for line in lines.values())
    if not rows:
        problems.append("no episode is done yet")
    elif len(rows) < wanted:
        problems.append(f"{len(rows)} of {wanted} episodes are done; the command goes on with it")
    command = _text(found, "command") if isinstance(found, dict) else ""
    told = asked if isinstance(asked, dict) else {}
    return SweepData(folder, told, rows, tuple(problems), command)


def _document(path: Path, problems: list[str]) -> Any:  # noqa: ANN401 - any JSON
    if not path.is_file():
        problems.append(f"{path.name} is missing")
        return {}
    return json_of(read_text(path, LARGEST), str(path), strict=False)


def _lines(asked: Any) -> dict[tuple[str, str, str], dict[str, Any]]:  # noqa: ANN401
    """Return scenario, robot and variant -> the line of `sweep.json`."""
    lines = asked.get("lines", []) if isinstance(asked, dict) else []
    return {
        (_text(line, "scenario"), _text(line, "robot"), _text(line, "variant")): {
            name: value for name, value in line.items() if _is_as_written(name, value)
        }
        for line in (lines if isinstance(lines, list) else [])
        if isinstance(line, dict)
    }


def _is_as_written(name: str, value: Any) -> bool:  # noqa: ANN401
    if name in {"settings", "seeds"}:
        return isinstance(value, list)
    return isinstance(value, str) or value is None


def _row(
    folder: Path, row: dict[str, Any], lines: dict[tuple[str, str, str], dict[str, Any]]
) -> EpisodeRow:
    line = lines.get((_text(row, "scenario"), _text(row, "robot"), _text(row, "variant")), {})
    key = (_text(row, "scenario"), _text(row, "robot"), _text(row, "variant"))
    place = row.get("end_position")
    if not isinstance(place, list) or len(place) < 2:
        place = [row.get("end_x"), row.get("end_y")]
    x, y = _number(place[0]), _number(place[1])
    success = row.get("success", row.get("passed"))
    return EpisodeRow(
        *key,
        seed=_text(row, "seed"),
        outcome=_text(row, "outcome"),
        reason=_text(row, "reason"),
        success=bool(success),
        end=None if x is None or y is None else (x, y),
        folder=kept_folder(folder, row.get("folder", row.get("run", row.get("path")))),
        settings=tuple(str(each) for each in line.get("settings") or ()),
        seconds=_number(row.get("simulated_seconds")),
        error=_number(row.get("translation_error_mean")),
        source=line.get("file") or key[0],
        robot_given=line["robot_given"] if "robot_given" in line else key[1] or None,
    )


def _text(row: dict[str, Any], key: str) -> str:
    value = row.get(key)
    if isinstance(value, dict):
        return ", ".join(f"{name}={item}" for name, item in value.items())
    return "" if value is None else str(value)


def _number(value: Any) -> float | None:  # noqa: ANN401
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None
