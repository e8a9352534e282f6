"""What an experiment is: cases to run over seeds, and the tables that their runs make."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from statistics import median
from typing import Any

from treadwell.errors import InputError
from treadwell.measuring.watch import Watch
from treadwell.runner import Run
from treadwell.scenario.messages import nearest

Draw = Callable[[int], dict[str, Any]]
"""Makes the scenario of a seed, as its file would be read."""
Results = Mapping[str, Sequence[Run]]
"""Name of a case -> its runs in the order of the seeds. A case may have none."""

NOTHING = "-"
"""What a cell holds where nothing was measured or reported."""
THE_PAPER = "the paper"
"""The column with what the paper reports."""


@dataclass(frozen=True, slots=True)
class Case:
    """What is run over the seeds: a scenario, with settings of its own, or one drawn for each.

    Attributes:
        name: of the case; of its runs' folders.
        scenario: name or path, or what draws one for a seed.
        overrides: settings `KEY=VALUE`, as `--set` takes them.
        share: of the seeds asked for; 5 runs five times as many, 0.5 every second one.
        watch: what looks at each camera frame of its runs.
        afterwards: makes another run of one that was recorded for it; it can be pickled.
        beside: name and text of files that a scenario that is drawn names; they lie beside it.
    """

    name: str
    scenario: str | Draw
    overrides: tuple[str, ...] = ()
    share: float = 1.0
    watch: type[Watch] | None = None
    afterwards: Callable[[Run], Run] | None = None
    beside: tuple[tuple[str, str], ...] = ()

    def seeds(self, asked: range) -> range:
        """Return the seeds to run where these are asked for; at least one."""
        return range(asked.start, asked.start + max(1, round(self.share * len(asked))))


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

    def html(self) -> str:
        """Return it as HTML for a notebook, everything in it escaped."""
        from markupsafe import Markup

        def cells(kind: str, words: Sequence[str]) -> Markup:
            made = Markup("").join(Markup(f"<{kind}>{{}}</{kind}>").format(word) for word in words)
            return Markup("<tr>{}</tr>").format(made)

        rows = Markup("").join(cells("td", row) for row in self.rows)
        notes = Markup("").join(Markup("<p>{}</p>").format(note) for note in self.notes)
        page = Markup("<table><caption>{}</caption><thead>{}</thead><tbody>{}</tbody></table>{}")
        return str(page.format(self.title, cells("th", self.header), rows, notes))


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture of the report: its title, one line, and its file."""

    title: str
    path: Path

    def markdown(self) -> str:
        """Return it as Markdown, for a file in the same folder."""
        return f"## {self.title}\n\n![{self.title}]({self.path.name})\n"


def _none_beside(_done: Sequence[Any]) -> Sequence[Picture]:
    return ()


@dataclass(frozen=True, slots=True)
class Beside:
    """What an experiment does beside its runs, each piece in a fresh process.

    Attributes:
        items: makes what there is to do, each piece plain data that can be pickled; given the
            experiment's folder, in which a piece may leave files.
        work: a function of a module that does a piece.
        told: one line of what came of a piece.
        tables: makes the report of what came of all that were done.
        pictures: those of the files in the folder that belong into the report.
    """

    items: Callable[[Path], Sequence[Any]]
    work: Callable[[Any], Any]
    told: Callable[[Any], str]
    tables: Callable[[Sequence[Any]], Sequence[Table]]
    pictures: Callable[[Sequence[Any]], Sequence[Picture]] = _none_beside


def _no_pictures(_results: Results, _folder: Path) -> Sequence[Picture]:
    return ()


@dataclass(frozen=True, slots=True)
class Experiment:
    """A paper's experiment.

    Attributes:
        name: as the command line has it.
        description: one line, with the paper.
        cases: in the order in which they are run.
        tables: makes the report of what came out.
        pictures: draws files into a folder, and returns title and path of each.
        beside: what is done beside the runs, where there is anything.
        of_robots: makes the same experiment of other robots, names and folders; None where the
            robots are what it is about.
    """

    name: str
    description: str
    cases: tuple[Case, ...]
    tables: Callable[[Results], Sequence[Table]]
    pictures: Callable[[Results, Path], Sequence[Picture]] = _no_pictures
    beside: Beside | None = None
    of_robots: "Callable[[Sequence[str]], Experiment] | None" = None

    def with_robots(self, robots: Sequence[str]) -> "Experiment":
        """Return the experiment with these robots, names or folders; as it is where there are none.

        Raises:
            InputError: its robots cannot be chosen, or one of these is none.
        """
        if not robots:
            return self
        if self.of_robots is None:
            raise InputError(f"--robots: {self.name} has robots of its own; `robots` takes others")
        return self.of_robots(robots)

    def narrowed(self, names: Sequence[str]) -> "Experiment":
        """Return the experiment with these cases and nothing beside; as it is where there are none.

        Raises:
            InputError: it has no such case; the message says which there are.
        """
        known = [case.name for case in self.cases]
        for name in names:
            if name not in known:
                raise InputError(
                    f"--only: {self.name} has no case {name!r}: allowed are {', '.join(known)}"
                    f"{nearest(name, known)}"
                )
        chosen = tuple(case for case in self.cases if case.name in names)
        return replace(self, cases=chosen, beside=None) if names else self


def middle(values: Sequence[float], digits: int = 1, unit: str = "") -> str:
    """Return the median as text; `NOTHING` of nothing."""
    return f"{median(values):.{digits}f}{unit}" if values else NOTHING


def share(good: int, of: int) -> str:
    """Return `good of of`; `NOTHING` of nothing."""
    return f"{good} of {of}" if of else NOTHING


def _row(cells: Any) -> str:  # noqa: ANN401 - anything that can be gone through
    return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"
