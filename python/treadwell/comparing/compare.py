"""A comparison from Python: the same as `treadwell compare`, with its figures as Arrow tables."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from treadwell.comparing.comparison import Candidate, compared
from treadwell.comparing.figure_file import check_figure
from treadwell.comparing.sides import candidates
from treadwell.comparing.tables import comparison_tables, write_tables
from treadwell.errors import InputError
from treadwell.scenario.messages import shown

if TYPE_CHECKING:
    import pyarrow as pa

    from treadwell.comparing.figure import Drawn
    from treadwell.sweeps.sweep import Sweep

_DIFFERENCES = {
    "metric": "string",
    "first": "string",
    "other": "string",
    "pairs": "int64",
    "difference": "float64",
    "low": "float64",
    "high": "float64",
    "test": "string",
    "p": "float64",
    "p_corrected": "float64",
    "verdict": "string",
    "pairs_least": "int64",
    "pairs_for_power": "int64",
}
_FIGURES = {
    "side": "string",
    "metric": "string",
    "value": "float64",
    "low": "float64",
    "high": "float64",
    "count": "int64",
}


@dataclass(frozen=True, slots=True, repr=False)
class Comparison:
    """Sweeps and their variants side by side.

    Attributes:
        sides: that are compared, each variant of each sweep.
        document: as `treadwell compare --json` has it.
    """

    sides: tuple[Candidate, ...]
    document: dict[str, Any]

    def table(self) -> "pa.Table":
        """Return the differences as an Arrow table: a row for each figure of each pair of sides.

        `difference` is `other` minus `first`, with the limits of its 95 % interval; shares are 0 to
        1, lengths m, angles rad, times s but for `core_ms`. What there is none of is null.
        """
        return _table(_DIFFERENCES, self.document["differences"])

    def figures(self) -> "pa.Table":
        """Return each side's figures as an Arrow table; shares with Wilson's 95 % interval."""
        rows = [
            {"side": side["name"], "metric": name, **figure}
            for side in self.document["candidates"]
            for name, figure in side["figures"].items()
        ]
        return _table(_FIGURES, rows)

    def draw(self, path: str | Path) -> "Drawn":
        """Draw a figure for a paper, as `--figure` does; return its caption and what lacks.

        Raises:
            InputError: the file's ending is none of `.pdf`, `.svg`, `.png`, or nothing is there.
            RecordingError: the file cannot be written.
        """
        # Late, because matplotlib takes half a second to import.
        from treadwell.comparing.figure import draw_figure

        return draw_figure(Path(path), self.sides, self.document)

    def __repr__(self) -> str:
        found = self.document["differences"]
        shown = sum(one["verdict"] in ("better", "worse") for one in found)
        tests = self.document["tests"]
        names = ", ".join(side.name for side in self.sides)
        return f"<Comparison of {names}: {shown} of {tests} tests show a difference>"

    def _repr_html_(self) -> str:
        return "".join(table.html() for table in comparison_tables(self.document))


def _folder(sweep: "str | Path | Sweep") -> Path:
    """Return a sweep's folder; what a sweep returned is known by having one."""
    found = sweep if isinstance(sweep, str | Path) else getattr(sweep, "folder", None)
    if found is None:
        raise InputError(
            f"compare: found {shown(sweep)}; must be a sweep's folder, or what treadwell.sweep "
            "returned, each by itself"
        )
    return Path(found)


def _table(columns: dict[str, str], rows: list[dict[str, Any]]) -> "pa.Table":
    # Late, because pyarrow takes a while to import.
    import pyarrow as pa

    schema = pa.schema([(name, getattr(pa, kind)()) for name, kind in columns.items()])
    return pa.Table.from_pylist([{name: row.get(name) for name in columns} for row in rows], schema)


def compare(
    *sweeps: "str | Path | Sweep",
    out: str | Path | None = None,
    figure: str | Path | None = None,
) -> Comparison:
    """Put sweeps, and the variants of each, side by side: the same as `treadwell compare`.

    Args:
        sweeps: folders of finished sweeps, or what `treadwell.sweep` returned.
        out: a Markdown file to write the tables to.
        figure: a PDF, SVG or PNG file to draw the comparison to.

    Returns:
        The comparison: `table()` has a row for each figure of each pair of sides.

    Raises:
        InputError: a folder is no finished sweep, or a file cannot be there.
        RecordingError: a file cannot be written.

    Example:
        >>> import treadwell
        >>> found = treadwell.compare("runs/before", "runs/after")  # doctest: +SKIP
        >>> found.table().select(["metric", "difference", "verdict"])  # doctest: +SKIP
        >>> found.draw("comparison.pdf").caption  # doctest: +SKIP
    """
    if not sweeps:
        raise InputError("compare: there is no sweep; name one or more folders")
    if figure is not None:
        check_figure(Path(figure))
    folders = [_folder(one) for one in sweeps]
    sides = tuple(candidates(folders))
    found = Comparison(sides, compared(sides))
    if out is not None:
        write_tables(Path(out), comparison_tables(found.document))
    if figure is not None:
        found.draw(figure)
    return found
