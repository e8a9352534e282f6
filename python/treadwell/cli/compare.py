"""The verb `compare`: sweeps and variants side by side, as tables, JSON or Markdown."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from treadwell.cli.output import PASSED, write_json, write_message, write_table
from treadwell.comparing.comparison import Candidate, compared
from treadwell.comparing.figure_file import check_figure
from treadwell.comparing.sides import candidates
from treadwell.comparing.tables import comparison_tables
from treadwell.errors import InputError, RecordingError
from treadwell.files import write_text


def compare(
    folders: Sequence[Path], *, out: Path | None, figure: Path | None, as_json: bool
) -> int:
    """Compare sweeps, show the tables, and return the exit status.

    Args:
        folders: of finished sweeps; the first one's first variant is what others are held against.
        out: a Markdown file to write the tables to.
        figure: a PDF, SVG or PNG file to draw the comparison to.
        as_json: write the comparison to standard output as JSON instead of tables.

    Raises:
        InputError: a folder is no finished sweep, or the file cannot be there.
        RecordingError: the file cannot be written.
    """
    if figure is not None:
        check_figure(figure)
    sides = candidates(folders)
    document = compared(sides)
    tables = comparison_tables(document)
    if as_json:
        write_json(document)
    else:
        for table in tables:
            write_table(table.title, table.header, table.rows)
            for note in table.notes:
                write_message(note)
    if out is not None:
        if not out.parent.is_dir():
            raise InputError(f"--out: {out}: there is no folder {out.parent}")
        try:
            write_text(out, "\n".join(table.markdown() for table in tables))
        except OSError as error:
            raise RecordingError(f"--out: {out}: {error.strerror}") from None
    if figure is not None:
        _draw(figure, sides, document)
    return PASSED


def _draw(path: Path, sides: Sequence[Candidate], document: dict[str, Any]) -> None:
    # Late, because matplotlib takes half a second to import.
    from treadwell.comparing.figure import draw_figure

    drawn = draw_figure(path, sides, document)
    write_message(f"figure: {path}" + (f" ({drawn.note})" if drawn.note else ""))
    write_message(f"caption: {drawn.caption}")
