"""What is in a room: a source's pictures grouped, labelled and kept as a map of labels."""

import json
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell._core import SceneLabels
from treadwell.errors import InputError
from treadwell.map_making.placing import Placing, ground_below, sensed
from treadwell.map_making.request import MapRequest
from treadwell.sources.frame import Floats, PinholeCamera, RangeFrame

NAMES: Final[tuple[str, ...]] = tuple(SceneLabels.names())
COLOURS: Final = ("#9aa5b1", "#e0a030", "#3d6fb4", "#8b5a2b", "#c0392b", "#2e9e5b")
"""One for each of `NAMES`."""
RGB: Final = np.array([[int(c[i : i + 2], 16) for i in (1, 3, 5)] for c in COLOURS], np.uint8)


class RoomLabels:
    """Labels pictures: floor, step, wall, furniture, clutter, door.

    Attributes:
        core: with the groups and labels of the last picture.
    """

    def __init__(
        self,
        columns: int,
        settings: dict[str, Any] | None = None,
        examples: tuple[Floats, list[int]] | None = None,
    ) -> None:
        """Begin with an empty map.

        Args:
            columns: of wider pictures blocks of pixels are one.
            settings: `[classification]`, table -> key -> value.
            examples: features (n, k) of groups and their labels, in place of what is known.

        Raises:
            InputError: a setting is bad.
        """
        self._columns = columns
        self.core = SceneLabels(json.dumps(settings or {}), examples)

    def insert(
        self,
        depth: NDArray[np.float32],
        camera: PinholeCamera,
        map_from_camera: Floats,
        *,
        floor: float = 0.0,
        keep: bool = True,
    ) -> bool:
        """Take in a picture; return whether it says enough.

        Args:
            depth: (h, w) m along the optical axis, NaN where nothing was seen.
            camera: of the picture.
            map_from_camera: (4, 4).
            floor: how high the floor is in the map, m.
            keep: whether the map of labels gets it.
        """
        pool = pool_of(camera.width, self._columns)
        pose = map_from_camera.copy()
        pose[2, 3] -= floor
        return bool(
            self.core.insert(
                pooled(depth, pool),
                pose,
                focal=[camera.fx / pool, camera.fy / pool],
                centre=[(centre + 0.5) / pool - 0.5 for centre in (camera.cx, camera.cy)],
                keep=keep,
            )
        )

    def points(self, floor: float = 0.0) -> tuple[Floats, NDArray[np.uint8]]:
        """Return the map: places (n, 3) m, and indices (n,) into `NAMES`."""
        places, labels, _ = self.core.points()
        places[:, 2] += floor
        return places, labels


class MapLabels:
    """The labels of a map that is made of a source's pictures."""

    def __init__(self, request: MapRequest, first: RangeFrame, place: Placing, kind: str) -> None:
        """Begin without a label.

        Args:
            request: with the settings.
            first: frame that is mapped.
            place: of the map in the world.
            kind: of the source: a run begins on a floor at z = 0, of others the ground under the
                first picture is the floor.

        Raises:
            InputError: a setting is bad, or the frames are no pictures.
        """
        if first.depth is None:
            raise InputError("--set map.labels: labels are of depth images; these data are none")
        self._labels = RoomLabels(request.data.columns, request.labels)
        self._offset = place.offset
        floor = ground_below(sensed(first), place.pose(first.world_from_sensor))
        self._floor = -float(place.offset[2]) if kind == "run" else floor

    def insert(self, frame: RangeFrame, map_from_camera: Floats) -> None:
        """Take in a picture from where its camera was."""
        if frame.depth is not None and frame.camera is not None:
            self._labels.insert(frame.depth, frame.camera, map_from_camera, floor=self._floor)

    def points(self) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
        """Return places (n, 3) m in the world whose z is up, and indices (n,) into `NAMES`."""
        places, labels = self._labels.points(self._floor)
        return (places + self._offset).astype(np.float32), labels


def pool_of(width: int, columns: int) -> int:
    """Return of how many pixels a side the blocks are that are one."""
    return max(1, -(-width // columns))


def pooled(depth: NDArray[np.float32], pool: int) -> NDArray[np.float32]:
    """Return a picture whose blocks of `pool` pixels a side are one: the median of their depths.

    A block that was not seen as a whole was not seen: it lies at a border.
    """
    if pool == 1:
        return np.ascontiguousarray(depth, np.float32)
    rows, cols = depth.shape[0] // pool, depth.shape[1] // pool
    blocks = depth[: rows * pool, : cols * pool].reshape(rows, pool, cols, pool)
    middle = np.median(blocks.transpose(0, 2, 1, 3).reshape(rows, cols, -1), axis=2)
    return np.ascontiguousarray(middle, np.float32)
