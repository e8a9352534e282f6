"""A result in a few words: a line for Python's prompt, a table for terminal and notebook."""

from collections.abc import Iterable, Mapping
from html import escape
from typing import Any

Row = tuple[str, object]
"""What it is, and its value."""


class Shown:
    """Is shown as a line at Python's prompt, and as a table in a notebook; not by all its data."""

    def document(self) -> dict[str, Any]:
        """Return it as plain data."""
        raise NotImplementedError

    def _line(self, document: Mapping[str, Any]) -> str:
        return result_line(document)

    def _table(self, document: Mapping[str, Any]) -> tuple[str, list[Row]]:
        return result_title(document), result_rows(document)

    def __dir__(self) -> list[str]:
        """Return what it says, without what its base class, pydantic's, offers to programs."""
        return [name for name in super().__dir__() if not name.startswith(("model_", "__pydantic"))]

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self._line(self.document())}>"

    def __str__(self) -> str:
        return repr(self)

    def _repr_html_(self) -> str:
        return html_table(*self._table(self.document()))


class ShownReplay(Shown):
    """The same for a replay's result."""

    def _line(self, document: Mapping[str, Any]) -> str:
        return replay_line(document)

    def _table(self, document: Mapping[str, Any]) -> tuple[str, list[Row]]:
        return replay_title(document), replay_rows(document)


def html_table(title: str, rows: Iterable[Row]) -> str:
    """Return a table as HTML, with everything escaped."""
    cells = "".join(
        f'<tr><th style="text-align:left">{escape(name)}</th>'
        f'<td style="text-align:left">{escape(str(value))}</td></tr>'
        for name, value in rows
    )
    return f"<table><caption>{escape(title)}</caption><tbody>{cells}</tbody></table>"


def result_title(document: Mapping[str, Any]) -> str:
    """Return scenario, robot and seed of a `result.json`."""
    return f"{document['scenario']} with {document['robot']}, seed {document['seed']}"


def result_rows(document: Mapping[str, Any]) -> list[Row]:
    """Return what a `result.json` says of a run, without what it does not know."""
    rows: list[Row] = [
        ("outcome", document["outcome"]),
        ("reason", document.get("reason")),
        ("passed", "yes" if document["passed"] else "no"),
        ("failures", "; ".join(map(str, document.get("failures", [])))),
        ("simulated time", _number(document.get("simulated_seconds"), "s", 1)),
        ("real-time factor", _number(document.get("real_time_factor"), "", 1)),
        ("falls", document.get("falls")),
        ("collisions", _collisions(document)),
        ("steps taken", document.get("steps_taken")),
        ("path length", _number(document.get("path_length"), "m", 2)),
        ("replans", document.get("replans")),
        ("localization error, mean", _error(document)),
        ("ablation", "yes: the core was given the truth" if document.get("ablation") else None),
    ]
    return _known(rows)


def result_line(document: Mapping[str, Any]) -> str:
    """Return scenario, robot, seed, and how the run ended, in a line."""
    passed = "passed" if document["passed"] else "not passed"
    time = _number(document["simulated_seconds"], "s", 1)
    reason = f" ({document['reason']})" if document.get("reason") else ""
    return f"{result_title(document)}: {document['outcome']} after {time}, {passed}{reason}"


def collisions_in_words(count: int, standing: int) -> str:
    """Return how many collisions there were, and in how many of them the robot stood, if any."""
    return f"{count}, {standing} of them while it stood" if standing else str(count)


def _collisions(document: Mapping[str, Any]) -> str:
    hits = document.get("collisions", [])
    return collisions_in_words(len(hits), sum(hit.get("standing") is True for hit in hits))


def replay_title(document: Mapping[str, Any]) -> str:
    """Return scenario, robot and seed of a replay's `result.json`."""
    return f"{result_title(document)}, replayed"


def replay_rows(document: Mapping[str, Any]) -> list[Row]:
    """Return what a `result.json` says of a replay, without what it does not know."""
    facts = document["replay"]
    core, wall = float(facts["core_seconds"]), float(document["wall_seconds"])
    rows: list[Row] = [
        ("replayed", f"{document['simulated_seconds']:.2f} s, {facts['observations']} ticks"),
        ("compared with the recording", compared(facts)),
        ("declared", facts["declared"]),
        ("reason", facts["reason"]),
        ("error", facts["error"]),
        ("real-time factor", f"{document['real_time_factor']:.1f}"),
        ("core's share of the time", f"{core / max(wall, 1e-9):.0%}"),
        ("localization error, mean", _error(document)),
    ]
    return _known(rows)


def replay_line(document: Mapping[str, Any]) -> str:
    """Return scenario, robot, seed, and whether core and recording agree, in a line."""
    return f"{replay_title(document)}: {compared(document['replay'])}"


def compared(facts: Mapping[str, Any]) -> str:
    """Return the sentence that says whether core and recording agree.

    Args:
        facts: the key `replay` of a replay's `result.json`.
    """
    first = facts["first_difference"]
    if first is not None:
        return f"first difference at tick {first['tick']} ({first['time']:.2f} s): {first['what']}"
    if not facts["compared"]:
        return "it holds no answers to compare with"
    return f"the same in all {facts['compared']} ticks, bit for bit"


def _error(document: Mapping[str, Any]) -> str | None:
    localization = document.get("localization") or {}
    error = _number((localization.get("translation_error") or {}).get("mean"), "m", 3)
    lost = localization.get("lost_share", 0.0)
    return (
        f"{error}; in {lost:.0%} of the frames it knew that it was lost"
        if error and lost
        else error
    )


def _number(value: float | None, unit: str, digits: int) -> str | None:
    return None if value is None else f"{value:.{digits}f} {unit}".rstrip()


def _known(rows: Iterable[Row]) -> list[Row]:
    return [row for row in rows if row[1] not in (None, "")]
