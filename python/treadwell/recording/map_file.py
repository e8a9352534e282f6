"""`map.npz`: the map as it was at the end of a run, for reports and for other tools.

`origin` (2,) m is the lower-left corner of cell (0, 0) and `cell` m the side of a cell; `kind`,
`height` and `sightings` are (rows, cols), rows along +y, columns along +x: 0 unknown, 1 floor,
2 obstacle; m, NaN where unknown; frames that saw the cell as floor. `voxels` (n, 4) float32 are
middle and side, m, of the cubes that the core held to be occupied; empty where it kept none.
Maps of a plane have one more: `probability` (rows, cols) float32 that a cell is occupied, NaN where
nothing was seen; or `lines` (n, 4) m, x and y of both ends of what is on a line. Or
`room` (rows, cols) uint32, the room of each cell, and `ways` (n, 3), the number of a way, x, y.
A map of landmarks has `landmarks` (n, 7), too: x, y, m; covariance xx, xy, yy, m²; probability that
it is there; name, NaN where it has none.
"""

import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.files import opened, whole_file
from treadwell.map_memory import OBSTACLE, RememberedMap

NAME: Final = "map.npz"
PICTURE: Final = "map.png"
"""What `map_picture` draws of it."""
_MOST_CELLS: Final = 2**26
"""What a file may claim to hold: a map of 300 m by 300 m in cells of 4 cm."""


@dataclass(frozen=True, slots=True, eq=False)
class StoredMap:
    """What a run knew of the place in the end.

    Attributes:
        surface: what the map last said of every cell.
        voxels: (n, 4) float32 m: middle and side of each occupied cube; empty without such a map.
    """

    surface: RememberedMap
    voxels: NDArray[np.float32]


def write_map(
    path: Path,
    surface: RememberedMap,
    voxels: NDArray[np.float32],
    more: Mapping[str, Any] | None = None,
) -> None:
    """Write the file whole or not at all.

    Args:
        path: of the file.
        surface: what the map last said of every cell.
        voxels: (n, 4) m: middle and side of each occupied cube.
        more: name -> array, of what some models have beside these.

    Raises:
        OSError: the file cannot be written.
    """
    with whole_file(path) as temporary, temporary.open("wb") as file:
        np.savez_compressed(
            file,
            origin=np.array(surface.origin),
            cell=np.array(surface.cell),
            kind=surface.kind,
            height=surface.height,
            sightings=surface.sightings,
            voxels=voxels,
            **(more or {}),
        )


def read_map(path: Path) -> StoredMap:
    """Read a file.

    Raises:
        InputError: it is missing or broken, or its arrays do not belong together.
    """
    try:
        with opened(path) as stream, np.load(stream, allow_pickle=False) as file:
            arrays = {key: _array(file, key) for key in _SHAPES}
    except InputError:
        raise
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None
    except (ValueError, KeyError, EOFError, zipfile.BadZipFile, zipfile.LargeZipFile) as error:
        raise InputError(f"{path}: is broken: {' '.join(str(error).split())}") from None
    except Exception as error:  # zlib's own error has no other base, and the file is anyone's
        raise InputError(f"{path}: is broken: {type(error).__name__}") from None
    kind = arrays["kind"]
    alike = all(arrays[key].shape == kind.shape for key in ("height", "sightings"))
    voxels, cell = arrays["voxels"], float(arrays["cell"])
    whole = (
        alike
        and (voxels.ndim, voxels.shape[-1]) == (2, 4)
        and np.isfinite(voxels).all()
        and bool((voxels[:, 3] > 0.0).all())
        and np.isfinite(arrays["origin"]).all()
        and (kind.size == 0 or (np.isfinite(cell) and cell > 0.0))
        and int(kind.max(initial=0)) <= OBSTACLE
    )
    if not whole:
        raise InputError(f"{path}: its arrays do not belong together")
    x, y = arrays["origin"].tolist()
    surface = RememberedMap((x, y), cell, kind, arrays["height"], arrays["sightings"])
    return StoredMap(surface, voxels)


_SHAPES: Final = {
    "origin": (1, np.float64),
    "cell": (0, np.float64),
    "kind": (2, np.uint8),
    "height": (2, np.float32),
    "sightings": (2, np.uint16),
    "voxels": (2, np.float32),
}
"""Array -> its dimensions and the type of its values."""


def _array(file: "np.lib.npyio.NpzFile", key: str) -> NDArray[Any]:
    """Return an array that is as the file's description says; it is looked at before it is read."""
    member = file.zip.getinfo(f"{key}.npy")  # type: ignore[union-attr]
    dimensions, kind = _SHAPES[key]
    if member.file_size > np.dtype(kind).itemsize * _MOST_CELLS:
        raise ValueError(f"{key} is too large")
    array: NDArray[Any] = file[key]
    if array.ndim != dimensions or array.dtype != kind or (key == "origin" and array.size != 2):
        raise ValueError(f"{key} has shape {array.shape} of {array.dtype}")
    return array
