"""What comes of a map, and what every way to make one needs."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from treadwell.errors import RecordingError
from treadwell.map_memory import RememberedMap
from treadwell.map_result import MapResult


class FrameProgress(Protocol):
    """Is told how a map gets on."""

    def update(self, frame: int, frames: int, used: int) -> None:
        """Take in that so many of all frames (0: not known) were read, and so many used."""
        ...


@dataclass(frozen=True, slots=True)
class MadeMap:
    """What came of a map.

    Attributes:
        result: as in `result.json`.
        map: the map.
        folder: where everything lies.
    """

    result: MapResult
    map: RememberedMap
    folder: Path


@contextmanager
def writing(folder: Path) -> Iterator[None]:
    """Turn what the system says of a file that cannot be written into one message.

    Raises:
        RecordingError: a file cannot be written.
    """
    try:
        yield
    except OSError as error:
        raise RecordingError(f"{folder}: cannot be written: {error.strerror or error}") from error


def stem(path: Path) -> str:
    """Return what a source is called: its name without endings."""
    return path.resolve().name.split(".")[0] or "source"


def title_of(name: str, world_model: str, frames: tuple[int, int], cell: float) -> str:
    """Return what stands above a map's picture, two lines.

    Args:
        name: what was mapped.
        world_model: by what.
        frames: how many were used, and how many there were.
        cell: m, side of a cell.
    """
    used, every = frames
    told = f"{used} of {every} frame{'s' * (every != 1)}"
    return f"{name} · {world_model} · {told}\ncells of {1e3 * cell:g} mm"
