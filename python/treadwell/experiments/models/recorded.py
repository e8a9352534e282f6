"""Every world model on range data that others recorded, where `TREADWELL_DATA` says."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from statistics import median
from typing import Final

from treadwell.errors import InputError
from treadwell.experiments.experiment import NOTHING, Beside, Table
from treadwell.experiments.models.suite import WORLD_MODELS
from treadwell.map_making.mapper import Mapper
from treadwell.map_making.request import read_request
from treadwell.map_result import counted
from treadwell.sources.source import open_source

SOURCES: Final = {
    "a room, 5 depth images": "rgbd_room",
    "a site from the air, a cloud": "isprs_ground_filter/samp11-utm.pcd.gz",
    "another, flatter one": "isprs_ground_filter/samp21-utm.pcd.gz",
    "landscape from the ground, a cloud": "real_terrain_clouds/terrain_med.pcd.gz",
}
"""What is mapped -> its place in the folder of data."""
SETTINGS: Final = {"rgbd_room": ("map.up=-y",)}
"""Place -> what its data needs: there the first camera is the world."""
MOST_FRAMES: Final = 100
_STATM: Final = Path("/proc/self/statm")


@dataclass(frozen=True, slots=True)
class Recorded:
    """A map to make: what it is of, its file or folder, and the model."""

    what: str
    source: Path
    model: str


@dataclass(frozen=True, slots=True)
class RecordedMap:
    """What came of one.

    Attributes:
        made: what was asked for.
        refused: why there is no map; "" where there is one.
        frames: read, at most `MOST_FRAMES`.
        used: frames in the map.
        cells: floor, obstacle and unknown.
        cell: side of a cell, m.
        milliseconds: median of a frame.
        megabytes: by which the process grew while the map was made; None where that is not told.
    """

    made: Recorded
    refused: str = ""
    frames: int = 0
    used: int = 0
    cells: tuple[int, int, int] = (0, 0, 0)
    cell: float = 0.0
    milliseconds: float = 0.0
    megabytes: float | None = None


def recorded(_folder: Path) -> list[Recorded]:
    """Return the maps to make: of the data that are there, by every model."""
    folder = os.environ.get("TREADWELL_DATA")
    if not folder:
        return []
    there = [(what, Path(folder) / place) for what, place in SOURCES.items()]
    return [
        Recorded(what, source, model)
        for what, source in there
        if source.exists()
        for model in WORLD_MODELS
    ]


def mapped(item: Recorded) -> RecordedMap:
    """Make a map; that a model has no use for such data is an outcome."""
    try:
        return _mapped(item)
    except InputError as error:
        return RecordedMap(item, refused=str(error))


def _mapped(item: Recorded) -> RecordedMap:
    settings = SETTINGS.get(item.source.name, ())
    request = read_request(item.source, world_model=item.model, settings=settings)
    source = open_source(item.source, camera=None, topics=(), pose_within=request.data.pose_within)
    frames = list(islice(source, MOST_FRAMES))
    if not frames:
        raise InputError(f"{item.source}: no frame can be used")
    before = _resident()
    mapper = Mapper(request, frames[0])
    used = sum(mapper.insert(frame) is not None for frame in frames)
    after = _resident()
    found = mapper.map()
    cells = counted(found)
    return RecordedMap(
        item,
        frames=len(frames),
        used=used,
        cells=(cells.floor, cells.obstacle, cells.unknown),
        cell=found.cell,
        milliseconds=1e3 * median(mapper.seconds) if mapper.seconds else 0.0,
        megabytes=None if before is None or after is None else after - before,
    )


def _resident() -> float | None:
    """Return how much memory the process has, MB, where the system tells it."""
    try:
        pages = int(_STATM.read_text().split()[1])
    except (OSError, ValueError, IndexError):
        return None
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def told(done: RecordedMap) -> str:
    """Return one line of what came of a map."""
    outcome = done.refused or f"{done.used} of {done.frames} frames, {done.milliseconds:.1f} ms"
    return f"{done.made.what}, {done.made.model}: {outcome}"


def recorded_tables(done: Sequence[RecordedMap]) -> list[Table]:
    """Return the table of what came of the maps; none where there are none."""
    if not done:
        return []
    return [
        Table(
            "Recorded data",
            ("data", "world model", "frames used", "cells of, mm", "floor", "obstacle",
             "ms a frame", "memory, MB"),
            tuple(_row(one) for one in done),
            (
                "Memory: by how much the process grew from before the model was made to after its "
                "last frame; the frames were read before. It holds the map that was remembered of "
                "all cells, and what the allocator kept. Of one frame the time is that of the "
                "first, with all that is made once; of clouds from the air it holds the filter "
                "that tells their ground.",
            ),
        )
    ]  # fmt: skip


def _row(one: RecordedMap) -> tuple[str, ...]:
    if one.refused:
        reason = "finds its floors in pictures" if "pictures" in one.refused else one.refused
        return (one.made.what, one.made.model, reason, *(NOTHING,) * 5)
    floor, obstacle, _ = one.cells
    memory = NOTHING if one.megabytes is None else f"{one.megabytes:.1f}"
    return (
        one.made.what,
        one.made.model,
        f"{one.used} of {one.frames}",
        f"{1e3 * one.cell:g}",
        str(floor),
        str(obstacle),
        f"{one.milliseconds:.1f}",
        memory,
    )


RECORDED: Final = Beside(items=recorded, work=mapped, told=told, tables=recorded_tables)
