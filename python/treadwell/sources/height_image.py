"""A picture of heights, as seen from straight above: each pixel is a cell of ground."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Annotated, Final

import numpy as np
from PIL import Image
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, ValidationError

from treadwell.errors import InputError
from treadwell.files import read_content
from treadwell.scenario.loading import read_toml
from treadwell.sources.camera_file import MOST_PIXELS, faults
from treadwell.sources.cloud_table import MOST_POINTS, Cloud
from treadwell.sources.clouds import around_its_middle
from treadwell.sources.frame import Floats, RangeFrame

_LARGEST_FILE: Final = 1 << 28
_FAULTS: Final = (OSError, ValueError, SyntaxError, EOFError, MemoryError, OverflowError)
_GREY: Final = {"L": 255.0, "I;16": 65535.0, "I;16B": 65535.0, "I": 65535.0}
"""Mode of a grey picture -> its white."""
MOST_TINT: Final = 2
"""Of 255, by which red, green and blue of a grey may differ: programs round each for itself."""


class HeightFile(BaseModel):
    """The file beside the picture, with its name and the ending `.toml`."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    cell: Annotated[FiniteFloat, Field(ge=1e-4, le=1e4)]
    """Side of a pixel, m."""
    height: Annotated[FiniteFloat, Field(gt=0.0, le=1e5)]
    """Height of white above black, m."""


@dataclass(slots=True, eq=False)
class HeightImage:
    """A picture of heights.

    Attributes:
        path: the picture.
        file: what its pixels mean.
        kind: "height image".
        frames: one.
        unused: reason -> count.
        notes: what its user should know.
    """

    path: Path
    file: HeightFile
    kind: str = "height image"
    frames: int = 1
    unused: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)

    def __iter__(self) -> Iterator[RangeFrame]:
        """Yield the middles of all cells as a cloud.

        The world has x to the right of the picture and y up, with its lower left corner at 0, 0;
        black is z = 0. Pixels that are transparent, if only in part, are unknown.

        Raises:
            InputError: the picture is broken, no picture of heights, or all of it is transparent.
        """
        heights = self.file.height * _shares(self.path)
        rows, columns = heights.shape
        y, x = np.mgrid[rows - 0.5 : 0.0 : -1.0, 0.5:columns]
        points = np.stack([x * self.file.cell, y * self.file.cell, heights], axis=-1)
        points = points.reshape(-1, 3)
        points[np.isnan(points[:, 2])] = np.nan
        self.notes.clear()
        frame = around_its_middle(Cloud(points, None), 0.0, self.notes)
        if frame is None:
            raise InputError(f"{self.path}: all of it is transparent: it has not one height")
        yield frame


def _shares(path: Path) -> Floats:
    """Return a picture's heights (h, w) from 0, black, to 1, white; NaN where transparent.

    Raises:
        InputError: it is broken, too large, or has other colours than grey.
    """
    content = read_content(path, _LARGEST_FILE)
    try:
        with Image.open(BytesIO(content), formats=["PNG"]) as image:
            columns, rows = image.size
            if max(columns, rows) > MOST_PIXELS or columns * rows > MOST_POINTS:
                raise InputError(
                    f"{path}: {columns}x{rows} pixels, {MOST_POINTS} of them and {MOST_PIXELS} "
                    "a side are allowed"
                )
            if image.mode in _GREY:
                shares: Floats = np.array(image).astype(np.float64) / _GREY[image.mode]
                return shares
            parts = np.array(image.convert("RGBA"))
    except (*_FAULTS, Image.DecompressionBombError) as error:
        raise InputError(f"{path}: cannot be read as a PNG picture: {error}") from None
    colours, opaque = parts[:, :, :3], parts[:, :, 3] == 255
    if np.ptp(colours, axis=2)[opaque].max(initial=0) > MOST_TINT:
        raise InputError(f"{path}: has colours; a picture of heights is grey")
    grey: Floats = colours.mean(axis=2) / 255.0
    grey[~opaque] = np.nan
    return grey


def open_height_image(path: Path) -> HeightImage:
    """Open a picture with the `.toml` of its name.

    Raises:
        InputError: that is missing or wrong.
    """
    beside = path.with_suffix(".toml")
    if not beside.exists():
        raise InputError(
            f"{beside}: missing; a picture of heights needs it, with cell (m, the side of a pixel) "
            "and height (m, of white above black)"
        )
    table = read_toml(beside)
    try:
        return HeightImage(path, HeightFile.model_validate(table))
    except ValidationError as error:
        raise InputError("\n".join(faults(beside, error, HeightFile))) from None
    except RecursionError:
        raise InputError(f"{beside}: nested too deep") from None
