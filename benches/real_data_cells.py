"""What `real_data.py` writes into docs/results: a table of each data set."""

from collections.abc import Callable, Sequence
from typing import Any

Row = dict[str, Any]


def results_table(rows: Sequence[Row]) -> tuple[str, list[Row]]:
    """Return title and rows of a data set's table, the pixels side by side where they fit."""
    title, cells = TABLES[rows[0]["data"]]
    found: dict[str, dict[str, str]] = {}
    for row in rows:
        name = row["segmenter"]
        what = name if " " in name else f"`{name}`"
        what += f", {row['pixels']}" if row["data"] == "scan" else ""
        found.setdefault(what, {}).update(cells(row))
    return title, [{"what": what, "measured": figures} for what, figures in found.items()]


def _table_cells(row: Row) -> dict[str, str]:
    if row["pixels"] == "640x480":
        return {row["pixels"]: f"{row['iou']:.3f}"}
    inner = f"{row['iou_inner']:.3f} / {row['least_inner']:.3f}"
    return {
        row["pixels"]: f"{row['iou']:.3f} / {row['least']:.3f}",
        f"{row['pixels']}, away from other labels": inner,
    }


def _clutter_cells(row: Row) -> dict[str, str]:
    figures = f"{row['found']} of {row['of']}, {row['iou']:.3f} / {row['least']:.3f}"
    return {row["pixels"]: figures}


def _scan_cells(row: Row) -> dict[str, str]:
    return {k: str(v) for k, v in row.items() if k not in ("data", "pixels", "segmenter")}


def _room_cells(row: Row) -> dict[str, str]:
    figures = f"{row['planes']}, {row['share']:.2f}, {row['residual_px']:.2f} px"
    return {row["pixels"]: figures}


TABLES: dict[str, tuple[str, Callable[[Row], dict[str, str]]]] = {
    "table": (
        "A labelled Kinect cloud (mOSD `test1`): IoU of the table, mean / least of six draws",
        _table_cells,
    ),
    "clutter": (
        "The table under clutter (mOSD): the ground found in one picture, and its IoU",
        _clutter_cells,
    ),
    "scan": (
        "A simulated scan (SynPEB `test_100`): regions at 80 % overlap (Hoover 1996)",
        _scan_cells,
    ),
    "room": (
        "A room (CAPE's example): planes found, share of what was seen, rms",
        _room_cells,
    ),
}
