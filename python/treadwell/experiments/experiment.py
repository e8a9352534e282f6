"""What an experiment is: scenarios to run over seeds, and the tables that its results make."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from statistics import median
from typing import Any

from treadwell.judging.result import Result

Results = Mapping[str, Sequence[Result]]
"""Scenario -> its results in the order of the seeds. A scenario may have none."""

NOTHING = "-"
"""What a cell holds where nothing was measured or reported."""


@dataclass(frozen=True, slots=True)
class Table:
    """A table of the report.

    Attributes:
        title: one line.
        header: names of the columns.
        rows: as wide as the header.
        notes: how to read it, one sentence each.
    """

    title: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...] = ()

    def document(self) -> dict[str, Any]:
        """Return it as plain data."""
        return asdict(self)

    def markdown(self) -> str:
        """Return it as Markdown."""
        lines = [f"## {self.title}", "", _row(self.header), _row("---" for _ in self.header)]
        lines += [_row(row) for row in self.rows]
        lines += ["", *self.notes] if self.notes else []
        return "\n".join(lines) + "\n"


@dataclass(frozen=True, slots=True)
class Experiment:
    """A paper's experiment.

    Attributes:
        name: as the command line has it.
        description: one line, with the paper.
        scenarios: names of scenarios, in the order in which they are run.
        tables: makes the report of what came out.
    """

    name: str
    description: str
    scenarios: tuple[str, ...]
    tables: Callable[[Results], Sequence[Table]]


def middle(values: Sequence[float], digits: int = 1, unit: str = "") -> str:
    """Return the median as text; `NOTHING` of nothing."""
    return f"{median(values):.{digits}f}{unit}" if values else NOTHING


def share(good: int, of: int) -> str:
    """Return `good of of`; `NOTHING` of nothing."""
    return f"{good} of {of}" if of else NOTHING


def _row(cells: Any) -> str:  # noqa: ANN401 - anything that can be gone through
    return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"
