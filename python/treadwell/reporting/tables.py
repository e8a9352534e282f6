"""Tables of text, as the page shows them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

_MOST_ROWS: Final = 60
"""Of a table; the rest is counted."""


@dataclass(frozen=True, slots=True)
class TableData:
    """A table: a title, the columns' names, rows of text, and what stands below."""

    title: str
    columns: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    note: str = ""


def table(title: str, columns: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> TableData:
    """Return a table with no more rows than a reader looks through."""
    more = len(rows) - _MOST_ROWS
    return TableData(title, columns, rows[:_MOST_ROWS], f"and {more} more" if more > 0 else "")
