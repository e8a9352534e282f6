"""One depth image of a file: 16-bit PNG, or numpy's `.npy`; and what its numbers mean."""

import warnings
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from treadwell.errors import InputError
from treadwell.files import read_content
from treadwell.sources.camera_file import CameraFile
from treadwell.sources.frame import UnusableError

SUFFIXES: Final = (".png", ".npy")
LARGEST_FILE: Final = 1 << 29
"""Bytes: the largest image in 64-bit numbers."""
FARTHEST_DEPTH_M: Final = 100.0
"""No depth camera sees as far: an image of which half lies beyond is in millimetres, of which as
many are a hand's breadth, nearer than any sees."""
MILLIMETRES: Final = 1e-3
_FAULTS: Final = (OSError, ValueError, SyntaxError, EOFError, TypeError, MemoryError, OverflowError)


@dataclass(slots=True)
class DepthUnit:
    """What the numbers of a source's images are: its first image tells whether millimetres.

    Attributes:
        scale: metres a unit, once known.
        notes: where it is told.
    """

    notes: list[str] = field(default_factory=list)
    scale: float | None = None

    def metres(self, depth: NDArray[Any]) -> NDArray[np.float32]:
        """Return an image (h, w) in metres, NaN where nothing was seen.

        Args:
            depth: as metres if its source is right; 0, negative and not finite is not seen.

        Raises:
            UnusableError: not one pixel was seen, or half of them farther than any camera sees.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            # Large numbers of 64 bits become infinite in 32: they are not seen either.
            metres = depth.astype(np.float32)
            seen = (metres > 0.0) & (metres < np.inf)
        count = int(np.count_nonzero(seen))
        if not count:
            raise UnusableError("no point")
        metres[~seen] = np.nan
        if self.scale is None:
            self.scale = 1.0
            if lies_beyond(metres, count):
                self.scale = MILLIMETRES
                self.notes.append(
                    f"depths are taken for millimetres: half of the first image would lie beyond "
                    f"{FARTHEST_DEPTH_M:g} m, at {float(np.nanmedian(metres)):.4g}"
                )
        if self.scale != 1.0:
            metres *= np.float32(self.scale)
        if lies_beyond(metres, count):
            raise UnusableError(f"depth beyond {FARTHEST_DEPTH_M:g} m")
        return metres


def lies_beyond(metres: NDArray[np.float32], count: int) -> bool:
    """Whether more than half of an image's seen pixels lie too far away to be metres.

    Args:
        metres: (h, w), if its source is right.
        count: how many pixels were seen.
    """
    return 2 * int(np.count_nonzero(metres > FARTHEST_DEPTH_M)) > count


def read_depth(path: Path, camera: CameraFile, camera_path: Path) -> NDArray[Any]:
    """Return an image (h, w) in metres if its file keeps to the rules: see `DepthUnit`.

    Raises:
        UnusableError: it is missing or broken, or of another size than the camera's.
        InputError: its numbers are integers and the camera's file does not say what they are.
    """
    try:
        content = read_content(path, LARGEST_FILE)
    except InputError:
        raise UnusableError("image that cannot be read") from None
    shape = camera.height, camera.width
    image = (_npy if path.suffix.lower() == ".npy" else png_depth)(content, shape)
    if image.dtype.kind == "f":
        return image
    if camera.depth_scale is None:
        raise InputError(
            f"{camera_path}: depth_scale: missing; it is required, as {path.name} has integers: "
            "units a metre, 1000 for millimetres"
        )
    scaled: NDArray[np.float32] = image.astype(np.float32) / np.float32(camera.depth_scale)
    return scaled


def png_depth(content: bytes, shape: tuple[int, int]) -> NDArray[Any]:
    """Return the integers (h, w) of a 16-bit PNG.

    Raises:
        UnusableError: it is broken, of another size, or not of one channel of 16 bits.
    """
    try:
        with Image.open(BytesIO(content), formats=["PNG"]) as image:
            check_size((image.height, image.width), shape)
            if image.mode not in ("I;16", "I;16B", "I"):
                raise UnusableError("image that is not 16-bit grey")
            return np.array(image)
    except (*_FAULTS, Image.DecompressionBombError):
        raise UnusableError("image that cannot be read") from None


def read_colour(path: Path, shape: tuple[int, int]) -> NDArray[np.uint8]:
    """Return red, green and blue (h, w, 3) of a PNG or JPEG.

    Raises:
        UnusableError: it is missing, broken or of another size.
    """
    try:
        content = read_content(path, LARGEST_FILE)
        with Image.open(BytesIO(content), formats=["PNG", "JPEG"]) as image:
            check_size((image.height, image.width), shape)
            return np.array(image.convert("RGB"))
    except (InputError, *_FAULTS, Image.DecompressionBombError):
        raise UnusableError("colour image that cannot be read") from None


def check_size(found: tuple[int, ...], wanted: tuple[int, int]) -> None:
    """Hold an image's rows and columns against the camera's.

    Raises:
        UnusableError: they are others.
    """
    if found != wanted:
        raise UnusableError(f"image that is not {wanted[1]}x{wanted[0]}")


def _npy(content: bytes, shape: tuple[int, int]) -> NDArray[Any]:
    """Return the numbers of a `.npy` file; its header is held against the camera first."""
    stream = BytesIO(content)
    try:
        version = np.lib.format.read_magic(stream)
        read = {
            (1, 0): np.lib.format.read_array_header_1_0,
            (2, 0): np.lib.format.read_array_header_2_0,
        }[version]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that Python 2 wrote it
            found, by_columns, kind = read(stream)
    except Exception:  # the header is parsed as Python, which fails in any of its ways
        raise UnusableError("image that cannot be read") from None
    check_size(found, shape)
    if kind.kind not in "fiu" or kind.itemsize > 16:
        raise UnusableError("image that is not of numbers")
    if len(content) - stream.tell() != kind.itemsize * shape[0] * shape[1]:
        raise UnusableError("image that cannot be read")
    flat = np.frombuffer(content, kind, offset=stream.tell())
    return flat.reshape(shape, order="F" if by_columns else "C")
