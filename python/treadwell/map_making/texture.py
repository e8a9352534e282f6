"""Pictures on the mesh: of a recording in colour some are kept, and the surface shows them.

Burgard and Hebert, World Modeling (004, Fig. 36.15).
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell._core import textured_mesh
from treadwell.recording.mesh_file import SurfaceMesh, Texture
from treadwell.sources.frame import Floats, PinholeCamera, RangeFrame

MOST_SIDE: Final = 8192
"""Pixels along a side of a texture: more are shown by few graphics processors."""
_GREY: Final = 128
_GREY_ROWS: Final = 2
"""Below the pictures: what shows where no picture saw the surface."""


@dataclass(frozen=True, slots=True, eq=False)
class _Kept:
    camera: PinholeCamera
    map_from_camera: Floats
    depth: NDArray[np.float32]
    colour: NDArray[np.uint8]


class TexturePictures:
    """Keeps pictures in colour, evenly over a recording of any length."""

    def __init__(self, most: int) -> None:
        """Begin with none.

        Args:
            most: how many are kept at most.
        """
        self._most, self._every, self._passed = most, 1, 0
        self._kept: list[_Kept] = []

    def insert(self, frame: RangeFrame, map_from_camera: Floats) -> None:
        """Take in a frame; one without colour or depth is passed over.

        Args:
            frame: what was seen.
            map_from_camera: (4, 4), from where.
        """
        if self._most < 1 or frame.colour is None or frame.depth is None or frame.camera is None:
            return
        if self._passed % self._every == 0:
            depth = np.ascontiguousarray(frame.depth, np.float32)
            self._kept.append(_Kept(frame.camera, map_from_camera, depth, frame.colour))
        if len(self._kept) > self._most:
            # Those that are left are as far apart in the recording as those to come.
            self._kept, self._every = self._kept[::2], 2 * self._every
        self._passed += 1

    def shown(self, mesh: SurfaceMesh, tables: Mapping[str, Any]) -> SurfaceMesh:
        """Return a mesh that shows the pictures, each triangle the one that saw it best.

        Args:
            mesh: in the frame of the poses.
            tables: `mesh` and `elevation` of `[navigation]`, as the mesh was made.
        """
        if not self._kept or not len(mesh.triangles):
            return mesh
        views = [
            (
                (kept.camera.fx, kept.camera.fy),
                (kept.camera.cx, kept.camera.cy),
                kept.map_from_camera,
                kept.depth,
            )
            for kept in self._kept
        ]
        settings = json.dumps({name: tables.get(name, {}) for name in ("mesh", "elevation")})
        (corners, triangles), views_of, at_px = textured_mesh(
            mesh.corners, mesh.triangles, views, settings=settings
        )
        return SurfaceMesh(corners, triangles, self._texture(views_of, at_px))

    def _texture(self, views_of: NDArray[np.int32], at_px: NDArray[np.float32]) -> Texture:
        """Return the pictures side by side, and where each corner is in them."""
        height, width = self._kept[0].depth.shape
        across = int(np.ceil(np.sqrt(len(self._kept))))
        down = -(-len(self._kept) // across)
        picture = np.full((down * height + _GREY_ROWS, across * width, 3), _GREY, np.uint8)
        for number, kept in enumerate(self._kept):
            row, column = height * (number // across), width * (number % across)
            picture[row : row + height, column : column + width] = kept.colour
        size = np.array([picture.shape[1], picture.shape[0]], float)
        corner = np.column_stack([width * (views_of % across), height * (views_of // across)])
        # A pixel's place is that of its middle.
        places = (corner + at_px + 0.5) / size
        places[views_of < 0] = (0.5, 1.0 - 0.5 * _GREY_ROWS / size[1])
        coarser = -(-max(picture.shape[:2]) // MOST_SIDE)
        return Texture(_coarser(picture, coarser), places.astype(np.float32))


def _coarser(picture: NDArray[np.uint8], by: int) -> NDArray[np.uint8]:
    """Return a picture with so many fewer pixels along each side."""
    if by == 1:
        return picture
    from PIL import Image

    return np.asarray(Image.fromarray(picture).reduce(by))
