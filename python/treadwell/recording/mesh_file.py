"""`mesh.npz`: the surface that a world model kept, as triangles, for exports.

`corners` (n, 3) float32 m in the map frame; `triangles` (m, 3) uint32, three numbers of corners
each, against the clock from outside.
"""

import zipfile
from dataclasses import dataclass
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
class SurfaceMesh:
    """A surface as triangles.

    Attributes:
        corners: (n, 3) float32 m.
        triangles: (m, 3) uint32: numbers of corners.
    """

    corners: NDArray[np.float32]
    triangles: NDArray[np.uint32]


def write_mesh(path: Path, mesh: SurfaceMesh) -> None:
    """Write the file whole or not at all.

    Raises:
        OSError: the file cannot be written.
    """
    with whole_file(path) as temporary, temporary.open("wb") as file:
        np.savez_compressed(file, corners=mesh.corners, triangles=mesh.triangles)


def read_mesh(path: Path) -> SurfaceMesh:
    """Read a file.

    Raises:
        InputError: it is missing or broken, or its arrays do not belong together.
    """
    try:
        with opened(path) as stream, np.load(stream, allow_pickle=False) as file:
            corners, triangles = _array(file, "corners"), _array(file, "triangles")
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
    )
    if not whole:
        raise InputError(f"{path}: its arrays do not belong together")
    return SurfaceMesh(corners, triangles)


def _array(file: "np.lib.npyio.NpzFile", key: str) -> NDArray[Any]:
    """Return an array; how large it is, is looked at before it is read."""
    member = file.zip.getinfo(f"{key}.npy")  # type: ignore[union-attr]
    if member.file_size > np.dtype(np.float32).itemsize * _MOST:
        raise ValueError(f"{key} is too large")
    array: NDArray[Any] = file[key]
    return array
