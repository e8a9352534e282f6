"""`recording.rrd` of a map: what each frame saw, the sensor, and the map in the end."""

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import RecordingError
from treadwell.map_memory import FLOOR, OBSTACLE, RememberedMap
from treadwell.recording.file import write_fault
from treadwell.recording.mesh_file import SurfaceMesh
from treadwell.recording.quiet import first_import
from treadwell.sources.frame import Floats, moved

_RADIUS: Final = 0.25
"""Of a cell's side, the radius with which a frame's points are drawn."""
_FLAT: Final = 0.02
"""Of a cell's side, half the thickness of a floor's tile."""


class MapRecording:
    """Writes the recording of a map while it is made."""

    def __init__(self, path: Path, name: str, cell: float) -> None:
        """Open the file.

        Args:
            path: of the file, in a folder that exists.
            name: what is mapped.
            cell: m, side of a cell.

        Raises:
            RecordingError: the file cannot be opened.
        """
        with first_import():
            import rerun as rr

        self._rr, self._path, self._cell = rr, path, cell
        self._stream = rr.RecordingStream("treadwell_map")
        try:
            self._stream.save(path)
        except OSError as error:
            raise RecordingError(f"{path}: {write_fault(path, error)}") from error
        except RuntimeError as error:  # what rerun makes of the system's word
            raise RecordingError(f"{path}: cannot be written: {error}") from error
        self._stream.send_recording_name(name)
        self._begin_s: float | None = None
        self._stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)

    def frame(self, time: float, pose: Floats, points: NDArray[np.float32]) -> None:
        """Write what a frame saw.

        Args:
            time: s, of the source's clock.
            pose: (4, 4) map from sensor.
            points: (n, 3) m, in the sensor's frame.
        """
        rr = self._rr
        self._begin_s = time if self._begin_s is None else self._begin_s
        self._stream.set_time("time", duration=time - self._begin_s)
        # Named as a run's, so that what reads those reads these.
        self._stream.log(
            "world/camera", rr.Transform3D(mat3x3=pose[:3, :3], translation=pose[:3, 3])
        )
        placed = moved(pose, points).astype(np.float32)
        self._stream.log("world/points", rr.Points3D(placed, radii=_RADIUS * self._cell))

    def landmarks(self, landmarks: Floats) -> None:
        """Write landmarks.

        Args:
            landmarks: (n, 7), as in `map.npz`.
        """
        rr = self._rr
        places = np.column_stack([landmarks[:, :2], np.zeros(len(landmarks))])
        names = ["" if np.isnan(name) else f"{name:.0f}" for name in landmarks[:, 6]]
        # Half axes as the eye takes a Gaussian in: two standard deviations, along x and y.
        spread = 2.0 * np.sqrt(np.maximum(landmarks[:, [2, 4]], 0.0))
        thin = np.full(len(landmarks), _FLAT * self._cell)
        self._stream.log(
            "world/map/landmarks",
            rr.Ellipsoids3D(
                centers=places, half_sizes=np.column_stack([spread, thin]), labels=names
            ),
            static=True,
        )

    def labels(
        self, places: NDArray[np.float32], colours: NDArray[np.uint8], offset: Floats
    ) -> None:
        """Write what is what.

        Args:
            places: (n, 3) m, in the map.
            colours: (n, 3), of each its label's.
            offset: (3,) m, from the frame of the recording to the map's.
        """
        rr = self._rr
        points = rr.Points3D(places - offset, colors=colours, radii=_RADIUS * self._cell)
        self._stream.log("world/map/labels", points, static=True)

    def surface(self, mesh: SurfaceMesh, offset: Floats) -> None:
        """Write the surface, with its pictures where it has some.

        Args:
            mesh: in the map.
            offset: (3,) m, from the frame of the recording to the map's.
        """
        rr, shown = self._rr, mesh.texture
        self._stream.log(
            "world/map/surface",
            rr.Mesh3D(
                vertex_positions=mesh.corners - offset,
                triangle_indices=mesh.triangles,
                vertex_texcoords=None if shown is None else shown.places,
                albedo_texture=None if shown is None else shown.picture,
            ),
            static=True,
        )

    def finish(self, found: RememberedMap, offset: Floats, voxels: NDArray[np.float32]) -> None:
        """Write the map, and close the file.

        Args:
            found: the map.
            offset: (3,) m, from the frame of the recording to the map's.
            voxels: (n, 4) m: middle and side of each occupied cube.
        """
        rr = self._rr
        for name, kind in (("floor", FLOOR), ("obstacle", OBSTACLE)):
            middles, halves = self._tiles(found, kind)
            if len(middles):
                self._stream.log(
                    f"world/map/{name}",
                    rr.Boxes3D(
                        centers=middles - offset,
                        half_sizes=halves,
                        colors=self._colours(middles[:, 2], kind),
                        fill_mode="solid",
                    ),
                    static=True,
                )
        if len(voxels):
            self._stream.log(
                "world/map/cubes",
                rr.Boxes3D(
                    centers=voxels[:, :3] - offset,
                    half_sizes=np.repeat(0.5 * voxels[:, 3:], 3, axis=1),
                    fill_mode="solid",
                ),
                static=True,
            )
        self._stream.flush()
        self._stream.disconnect()

    def _tiles(self, found: RememberedMap, kind: int) -> tuple[Floats, Floats]:
        here = (found.kind == kind) & np.isfinite(found.height)
        side = 0.5 * found.cell
        thick = np.full(int(here.sum()), _FLAT * found.cell)
        tops = found.height[here].astype(np.float64)
        if kind == OBSTACLE and len(tops):
            floors = found.height[found.kind == FLOOR]
            ground = float(np.min(floors)) if len(floors) else float(tops.min())
            thick = np.maximum(0.5 * (tops - ground), thick)
        middles = np.column_stack([found.centres()[here], tops - thick])
        return middles, np.column_stack([np.full((len(thick), 2), side), thick])

    @staticmethod
    def _colours(heights: Floats, kind: int) -> NDArray[np.uint8]:
        from treadwell.recording.layout import OBSTACLE as COLOUR
        from treadwell.recording.layout import height_colours

        if kind == OBSTACLE:
            return np.tile(np.array(COLOUR[:3], np.uint8), (len(heights), 1))
        low, high = np.percentile(heights, [0.5, 99.5])
        return height_colours(heights.astype(np.float32), float(low), float(max(high, low + 0.02)))
