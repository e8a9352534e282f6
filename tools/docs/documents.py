"""What `treadwell experiment`, `sweep`, `compare` and `bench` write with `--json`, as rows."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from treadwell.summary import collisions_in_words


@dataclass(frozen=True)
class Taken:
    """A table's rows, and what the document says of where they are from."""

    rows: list[dict[str, Any]]
    command: str | None = None
    seeds: str | None = None


def rows_of(document: dict[str, Any], title: str) -> Taken:
    """Return what a document says.

    Args:
        document: as one of the commands wrote it.
        title: of an experiment or a comparison, which of its tables.

    Raises:
        ValueError: it is no such document, or has no such table.
    """
    if "experiment" in document:
        return _experiment(document, title)
    if "candidates" in document:
        from treadwell.comparing.tables import comparison_tables

        tables = [table.document() for table in comparison_tables(document)]
        return Taken(_table(tables, title))
    if "benches" in document:
        modes = [(row, *one) for row in document["benches"] for one in row["modes"].items()]
        return Taken([_bench(*one) for one in modes], "treadwell bench")
    if "summary" in document and "lines" in document:
        return _sweep(document)
    raise ValueError("neither an experiment nor a sweep, a comparison or a bench")


def _experiment(document: dict[str, Any], title: str) -> Taken:
    if document["interrupted"]:
        raise ValueError("the experiment was interrupted: some runs are missing")
    first, count = document["first_seed"], document["seeds"]
    command = f"treadwell experiment {document['experiment']} --seeds {count} --first-seed {first}"
    return Taken(_table(document["tables"], title), command, _range(range(first, first + count)))


def _table(tables: Sequence[dict[str, Any]], title: str) -> list[dict[str, Any]]:
    """Return the rows of the table of a title; the column `wanted` is what was wanted."""
    for table in tables:
        if table["title"] == title:
            return [_row(table["header"], cells) for cells in table["rows"]]
    titles = ", ".join(repr(table["title"]) for table in tables)
    raise ValueError(f"there is no table {title!r}; there are {titles}")


def _row(header: Sequence[str], cells: Sequence[str]) -> dict[str, Any]:
    named = dict(zip(header[1:], cells[1:], strict=True))
    wanted = named.pop("wanted", None)
    return {"what": cells[0], "measured": named} | ({"wanted": wanted} if wanted else {})


def _sweep(document: dict[str, Any]) -> Taken:
    rows = []
    for line in document["summary"]:
        name = " ".join(filter(None, (line["scenario"], line["robot"], str(line["variant"] or ""))))
        time = line["simulated_seconds_median"]
        figures = {
            "successes": f"{line['successes']} of {line['episodes']}",
            "justified refusals": str(line["justified"]),
            "falls": str(line["falls"]),
            "collisions": collisions_in_words(
                line["collisions"], line.get("collisions_standing", 0)
            ),
            "median time": "-" if time is None else f"{time:.1f} s",
        }
        rows.append({"what": name, "measured": figures})
    seeds = sorted({seed for line in document["lines"] for seed in line["seeds"]})
    said = _range(range(seeds[0], seeds[-1] + 1)) if seeds else None
    return Taken(rows, document["command"] or None, said)


def _bench(row: dict[str, Any], mode: str, found: dict[str, Any]) -> dict[str, Any]:
    figures = {
        "median": f"{found['p50']:.3f} ms",
        "worst": f"{found['worst']:.3f} ms",
        "times faster": f"{found['ratio']:.1f}",
        "bindings": f"{100 * found['bindings_share']:.1f} %",
    }
    return {"what": f"{row['bench']}, {row['frames']}, `{mode}`", "measured": figures}


def _range(seeds: range) -> str:
    return str(seeds[0]) if len(seeds) == 1 else f"{seeds[0]}-{seeds[-1]}"
