"""Rows of a sweep as an Arrow table, and that as a Parquet file."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from treadwell.sweeps.row import Row

if TYPE_CHECKING:
    import pyarrow as pa


def rows_table(rows: Sequence[Row]) -> "pa.Table":
    """Return rows as a table with a column for each of `Row`'s attributes."""
    # Late, because pyarrow takes a while to import.
    import pyarrow as pa

    kinds = {"str": pa.string(), "int": pa.int64(), "float": pa.float64(), "bool": pa.bool_()}
    names = {name: str(kind) for name, kind in Row.__annotations__.items()}
    schema = pa.schema([(name, kinds[_plain(kind)]) for name, kind in names.items()])
    return pa.Table.from_pylist([row.document() for row in rows], schema=schema)


def write_table(file: Path, rows: Sequence[Row]) -> None:
    """Write rows as Parquet, whole or not at all.

    Raises:
        OSError: the file cannot be written.
    """
    import pyarrow.parquet as pq

    table = rows_table(rows)
    temporary = file.with_name(f".{file.name}")
    try:
        pq.write_table(table, temporary)
        with temporary.open("rb") as opened:
            os.fsync(opened.fileno())
        temporary.replace(file)
    finally:
        temporary.unlink(missing_ok=True)


def _plain(kind: str) -> str:
    """Return `float` of `float | None` and of `<class 'float'>`."""
    for name in ("bool", "float", "int", "str"):
        if name in kind:
            return name
    raise TypeError(kind)
