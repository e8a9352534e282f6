"""`mesh.npz`: the surface that a world model kept, as triangles, for exports.

`corners` (n, 3) float32 m in the map frame; `triangles` (m, 3) uint32, three numbers of corners
each, against the clock from outside. Where the data had colour, `picture` (h, w, 3) uint8 and
`places` (n, 2) float32: where in it each corner is, from its left and upper border, shares of its
width and height.
"""

import zipfile
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.files import opened, whole_file

NAME: Final = "mesh.npz"
_MOST: Final = 2**27
"""Numbers that an array of the file may claim to hold."""


@dataclass(frozen=True, slots=True, eq=False)
class Texture:
    """What a surface looks like.

    Attributes:
        picture: (h, w, 3) uint8 red, green, blue.
        places: (n, 2) float32, of each corner: from the picture's left and upper border, shares of
            its width and height.
    """

    picture: NDArray[np.uint8]
    places: NDArray[np.float32]

    def png(self) -> bytes:
        """Return the picture as a PNG file."""
        from PIL import Image

        file = BytesIO()
        Image.fromarray(self.picture).save(file, "PNG")
        return file.getvalue()

    def colours(self) -> NDArray[np.uint8]:
        """Return the colour of each corner, (n, 3)."""
        size = np.array([self.picture.shape[1], self.picture.shape[0]])
        column, row = np.clip((self.places * size).astype(int), 0, size - 1).T
        found: NDArray[np.uint8] = self.picture[row, column]
        return found


@dataclass(frozen=True, slots=True, eq=False)
class SurfaceMesh:
    """A surface as triangles.

    Attributes:
        corners: (n, 3) float32 m.
        triangles: (m, 3) uint32: numbers of corners.
        texture: what it looks like; None where no colour was seen.
    """

    corners: NDArray[np.float32]
    triangles: NDArray[np.uint32]
    texture: Texture | None = None


def write_mesh(path: Path, mesh: SurfaceMesh) -> None:
    """Write the file whole or not at all.

    Raises:
        OSError: the file cannot be written.
    """
    with whole_file(path) as temporary, temporary.open("wb") as file:
        shown = mesh.texture
        if shown is None:
            np.savez_compressed(file, corners=mesh.corners, triangles=mesh.triangles)
            return
        np.savez_compressed(
            file,
            corners=mesh.corners,
            triangles=mesh.triangles,
            picture=shown.picture,
            places=shown.places,
        )


def read_mesh(path: Path) -> SurfaceMesh:
    """Read a file.

    Raises:
        InputError: it is missing or broken, or its arrays do not belong together.
    """
    try:
        with opened(path) as stream, np.load(stream, allow_pickle=False) as file:
            corners, triangles = _array(file, "corners"), _array(file, "triangles")
            texture = None
            if "picture" in file.files:
                texture = Texture(_array(file, "picture"), _array(file, "places"))
    except InputError:
        raise
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None
    except (ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise InputError(f"{path}: is broken: {' '.join(str(error).split())}") from None
    except Exception as error:  # zlib's own error has no other base, and the file is anyone's
        raise InputError(f"{path}: is broken: {type(error).__name__}") from None
    whole = (
        corners.dtype == np.float32
        and triangles.dtype == np.uint32
        and (corners.ndim, corners.shape[-1]) == (2, 3)
        and (triangles.ndim, triangles.shape[-1]) == (2, 3)
        and bool(np.isfinite(corners).all())
        and int(triangles.max(initial=0)) < max(len(corners), 1)
        and (texture is None or _fits(texture, len(corners)))
    )
    if not whole:
        raise InputError(f"{path}: its arrays do not belong together")
    return SurfaceMesh(corners, triangles, texture)


def _fits(texture: Texture, count: int) -> bool:
    picture, places = texture.picture, texture.places
    return (
        picture.dtype == np.uint8
        and picture.ndim == 3
        and picture.shape[2] == 3
        and picture.size > 0
        and places.dtype == np.float32
        and places.shape == (count, 2)
        and bool(np.isfinite(places).all())
    )


def _array(file: "np.lib.npyio.NpzFile", key: str) -> NDArray[Any]:
    """Return an array; how large it is, is looked at before it is read."""
    member = file.zip.getinfo(f"{key}.npy")  # type: ignore[union-attr]
    if member.file_size > np.dtype(np.float32).itemsize * _MOST:
        raise ValueError(f"{key} is too large")
    array: NDArray[Any] = file[key]
    return array
