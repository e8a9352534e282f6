"""What a sweep's rows come to: counts for each line, and the document `results.json`."""

from collections import Counter
from collections.abc import Sequence
from statistics import median
from typing import Any

from treadwell.experiments.experiment import Table
from treadwell.summary import collisions_in_words
from treadwell.sweeps.request import Request
from treadwell.sweeps.row import Row


def results_document(request: Request, rows: Sequence[Row], command: str = "") -> dict[str, Any]:
    """Return what `results.json` holds: what was asked for, a summary of each line, every row."""
    by_line: dict[int, list[Row]] = {number: [] for number in range(len(request.lines))}
    for row in rows:
        by_line[request.line_of(row.key)].append(row)
    return {
        **request.document(),
        "command": command,
        "passed": all(row.success for row in rows),
        "summary": [
            {
                "scenario": line.scenario,
                "robot": line.robot,
                "variant": line.variant,
                **summary(by_line[number]),
            }
            for number, line in enumerate(request.lines)
        ],
        "episodes": [row.document() for row in rows],
    }


def summary(rows: Sequence[Row]) -> dict[str, Any]:
    """Return counts over rows, and the median time of those that succeeded."""
    times = [row.simulated_seconds for row in rows if row.success and row.simulated_seconds]
    known = [row.solvable for row in rows if row.solvable is not None]
    return {
        "episodes": len(rows),
        "successes": sum(row.success for row in rows),
        "passed": sum(row.passed for row in rows),
        "justified": sum(row.justified for row in rows),
        "solvable": sum(known),
        "solvable_known": len(known),
        "falls": sum((row.falls or 0) > 0 for row in rows),
        "collisions": sum(row.collisions or 0 for row in rows),
        "collisions_standing": sum(row.collisions_standing or 0 for row in rows),
        "outcomes": dict(sorted(Counter(row.outcome for row in rows).items())),
        "not_reproduced": [row.key.text for row in rows if row.reproduced is False],
        "simulated_seconds_median": median(times) if times else None,
    }


def summary_table(
    document: dict[str, Any], title: str = "Sweep", notes: Sequence[str] = ()
) -> Table:
    """Return the counts of a document as a table, a line of the sweep each.

    Args:
        document: as `results_document` made it.
        title: of the table.
        notes: what else there is to say, a sentence each.
    """
    rows, again = [], []
    for line in document["summary"]:
        rows.append(
            (
                " ".join(filter(None, (line["scenario"], line["robot"], line["variant"]))),
                f"{line['successes']} of {line['episodes']}",
                ", ".join(f"{count} {outcome}" for outcome, count in line["outcomes"].items()),
                str(line["justified"]),
                f"{line['solvable']} of {line['solvable_known']}",
                str(line["falls"]),
                collisions_in_words(line["collisions"], line.get("collisions_standing", 0)),
            )
        )
        if line["not_reproduced"]:
            again.append(f"not the same again: {', '.join(line['not_reproduced'])}")
    header = (
        "", "successes", "outcomes", "refused rightly", "solvable", "falls", "collisions",
    )  # fmt: skip
    return Table(title, header, tuple(rows), (*notes, *again))
