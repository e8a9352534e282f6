"""The verb `compare`: sweeps and variants side by side, as tables, JSON or Markdown."""

from collections.abc import Sequence
from pathlib import Path

from treadwell.cli.output import PASSED, write_json, write_message, write_table
from treadwell.comparing.compare import compare as comparison
from treadwell.comparing.figure_file import check_figure
from treadwell.comparing.tables import comparison_tables, write_tables


def compare(
    folders: Sequence[Path], *, out: Path | None, figure: Path | None, as_json: bool
) -> int:
    """Compare sweeps, show the tables, and return the exit status.

    Args:
        folders: of finished sweeps; the first one's first variant stands first in the tables.
        out: a Markdown file to write the tables to.
        figure: a PDF, SVG or PNG file to draw the comparison to.
        as_json: write the comparison to standard output as JSON instead of tables.

    Raises:
        InputError: a folder is no finished sweep, or the file cannot be there.
        RecordingError: the file cannot be written.
    """
    if figure is not None:
        check_figure(figure)
    found = comparison(*folders)
    tables = comparison_tables(found.document)
    if as_json:
        write_json(found.document)
    else:
        for table in tables:
            write_table(table.title, table.header, table.rows)
            for note in table.notes:
                write_message(note)
    if out is not None:
        write_tables(out, tables)
    if figure is not None:
        drawn = found.draw(figure)
        write_message(f"figure: {figure}" + (f" ({drawn.note})" if drawn.note else ""))
        write_message(f"caption: {drawn.caption}")
    return PASSED
