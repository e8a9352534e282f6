"""A comparison as tables: for the terminal, Markdown and the page on a sweep."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from treadwell.comparing.comparison import TOO_FEW, letter
from treadwell.comparing.metrics import METRICS, Metric
from treadwell.comparing.power import POWER
from treadwell.comparing.statistics import LEVEL
from treadwell.errors import InputError, RecordingError
from treadwell.experiments.experiment import NOTHING, Table
from treadwell.files import write_text


def comparison_tables(document: dict[str, Any]) -> list[Table]:
    """Return what `compared` found as tables, without those that would be empty."""
    tables = (
        _figures(document),
        _scenarios(document),
        _differences(document),
        *_each_against_each(document),
    )
    return [table for table in tables if table.rows]


def write_tables(path: Path, tables: Sequence[Table]) -> None:
    """Write tables as Markdown; a file that is there is replaced, whole or not at all.

    Raises:
        InputError: there is no such folder.
        RecordingError: the file cannot be written.
    """
    if not path.parent.is_dir():
        raise InputError(f"--out: {path}: there is no folder {path.parent}")
    try:
        write_text(path, "\n".join(table.markdown() for table in tables))
    except OSError as error:
        raise RecordingError(f"--out: {path}: {error.strerror}") from None


def _figures(document: dict[str, Any]) -> Table:
    """Each candidate's figures; a column of which nobody has anything is left out."""
    sides = document["candidates"]
    shown = [
        metric
        for metric in METRICS
        if any(side["figures"][metric.name]["value"] is not None for side in sides)
    ]
    rows = [
        (
            side["name"],
            str(side["episodes"]),
            *(_figure(metric, side["figures"][metric.name]) for metric in shown),
        )
        for side in sides
    ]
    return Table(
        "Comparison",
        ("", "episodes", *(_title(metric) for metric in shown)),
        tuple(rows),
        (
            "Shares with Wilson's 95 % interval; time and path efficiency of those that arrived. "
            "What is neither a share nor called a median is a mean.",
            *filter(None, (pairs_note(document),)),
        ),
    )


def _title(metric: Metric) -> str:
    return f"{metric.title}, median" if metric.kind == "median" else metric.title


def _figure(metric: Metric, figure: dict[str, Any]) -> str:
    value = figure["value"]
    if value is None:
        return NOTHING
    if metric.kind == "share":
        low, high = 100 * figure["low"], 100 * figure["high"]
        return f"{100 * value:.1f} % ({low:.1f} to {high:.1f})"
    return f"{value:.{metric.digits}f}"


def _scenarios(document: dict[str, Any]) -> Table:
    """Successes by scenario, where there are several."""
    sides = document["candidates"]
    names = list(sides[0]["scenarios"]) if sides else []
    rows = [
        (
            name,
            *(f"{s['scenarios'][name]['yes']} of {s['scenarios'][name]['count']}" for s in sides),
        )
        for name in names
        if len(names) > 1
    ]
    return Table("Successes", ("", *(side["name"] for side in sides)), tuple(rows))


def pairs_note(document: dict[str, Any]) -> str:
    """Say with which sides the first one has nothing in common; empty where with all it has."""
    pairs: dict[str, int] = {}
    for one in _with_first(document):
        pairs[one["other"]] = max(one["pairs"], pairs.get(one["other"], 0))
    alone = [name for name, count in pairs.items() if not count]
    return f"No scenario and seed in common with the first: {', '.join(alone)}." if alone else ""


def _differences(document: dict[str, Any]) -> Table:
    """What differs from the first candidate, and what does not."""
    titles = {metric.name: metric for metric in METRICS}
    rows = []
    for one in _with_first(document):
        metric = titles[one["metric"]]
        if one["p"] is None or (one["difference"] == 0 and one["p"] == 1.0):
            continue
        rows.append(
            (
                one["other"],
                metric.title,
                _step(metric, one["difference"]),
                _interval(metric, one),
                str(one["pairs"]),
                f"{one['p_corrected']:.3g}",
                one["verdict"],
                _needed(one),
            )
        )
    first = document["candidates"][0]["name"] if document["candidates"] else ""
    return Table(
        f"Against {first}",
        ("", "figure", "mean difference", "95 % interval", "pairs", "p", "", "pairs it takes"),
        tuple(rows),
        (
            "Pairs: the same scenario and seed, where both have the figure. The mean is of these "
            "pairs alone, also of what stands above as a median. McNemar's exact test of shares, "
            f"a permutation test of the rest, {_correction(document)}; a difference is one below "
            f"{LEVEL:g}. Intervals, of one difference each and not corrected: Newcombe's of "
            "shares, else what the permutation test would not contradict; fewer than six pairs "
            "have none.",
            *_few_note(document),
        ),
    )


def _needed(one: dict[str, Any]) -> str:
    """Say how many pairs a difference takes that was not shown."""
    if one["verdict"] in _TURNED:
        return ""
    least = f"{one['pairs_least']} at least" if one["verdict"] == TOO_FEW else ""
    estimate = one["pairs_for_power"]
    known = estimate is None or (least and estimate <= one["pairs_least"])
    about = "" if known else f"about {estimate}"
    return ", ".join(filter(None, (least, about))) or NOTHING


def _few_note(document: dict[str, Any]) -> list[str]:
    """Say what `too few pairs` and the last column mean, where they are there."""
    found = _with_first(document)
    notes = []
    few = [one for one in found if one["verdict"] == TOO_FEW]
    if few:
        pairs = sorted({one["pairs"] for one in few})
        least = max(one["pairs_least"] for one in few)
        told = ", ".join(map(str, pairs))
        notes.append(
            f"Too few pairs: {told} cannot show a difference beside {document['tests'] - 1} other "
            f"tests, however large it is: the least p of n pairs is 2 / 2^n. It takes {least} at "
            "least, and those only where all differ in the same direction."
        )
    if any("about" in _needed(one) for one in found):
        notes.append(
            f"About: so many pairs show a difference as large as the one seen in {100 * POWER:g} % "
            "of cases; by few pairs it is known no better than the difference itself."
        )
    return notes


def _correction(document: dict[str, Any]) -> str:
    tests, sides = document["tests"], len(document["candidates"])
    if sides > 2 and document["against"] == "each":
        return f"all {tests} of each against each corrected after Holm"
    return f"all {tests} corrected after Holm"


def _with_first(document: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the differences from the first side."""
    if not document["candidates"]:
        return []
    first = document["candidates"][0]["name"]
    return [one for one in document["differences"] if one["first"] == first]


def _each_against_each(document: dict[str, Any]) -> list[Table]:
    """Return a matrix of each figure in which some pair differs, and of success anyway."""
    names = [side["name"] for side in document["candidates"]]
    if len(names) <= 2 or document["against"] != "each":
        return []
    tables = []
    for metric in METRICS:
        found = {
            (one["first"], one["other"]): one
            for one in document["differences"]
            if one["metric"] == metric.name and one["p"] is not None
        }
        shown = any(one["verdict"] in _TURNED for one in found.values())
        if not found or not (shown or metric.name == "success"):
            continue
        rows = tuple(
            (f"{letter(number)}  {name}", *(_cell(metric, found, name, to) for to in names))
            for number, name in enumerate(names)
        )
        header = ("", *map(letter, range(len(names))))
        tables.append(Table(f"Each against each: {metric.title}", header, rows))
    if tables:
        note = "The row less the column; a word where it is shown to be better or worse than that."
        tables[-1] = replace(tables[-1], notes=(note,))
    return tables


_TURNED: Final = {"better": "worse", "worse": "better"}
"""A verdict -> the same pair's, seen from the other side."""


def _cell(metric: Metric, found: dict[tuple[str, str], dict[str, Any]], name: str, to: str) -> str:
    """Return what stands in a row of the matrix below the name of a column."""
    if (to, name) in found:
        one = found[to, name]
        step, verdict = one["difference"], one["verdict"]
    elif (name, to) in found:
        one = found[name, to]
        step, verdict = 0.0 - one["difference"], _TURNED.get(one["verdict"], "")
    else:
        return NOTHING
    return f"{_step(metric, step)} {verdict if verdict in _TURNED else ''}".rstrip()


def _step(metric: Metric, difference: float) -> str:
    """Return a difference with its sign and unit."""
    scale, unit = (100, " %") if metric.kind == "share" else (1, "")
    return f"{scale * difference:+.{metric.digits}f}{unit}"


def _interval(metric: Metric, one: dict[str, Any]) -> str:
    if one["low"] is None or one["high"] is None:
        return NOTHING
    return f"{_step(metric, one['low'])} to {_step(metric, one['high'])}"
