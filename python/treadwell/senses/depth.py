"""The depth camera without its errors: rays cast through every pixel into the simulated world."""

from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.senses.view import VISIBLE_GROUPS, View

Floats = NDArray[np.float64]

# MuJoCo's camera looks along -z with y up, the optical frame along z with y down.
MUJOCO_FROM_OPTICAL = np.diag([1.0, -1.0, -1.0])
# Nothing beyond this is looked for, and nothing is nearer, metres.
FAR = 20.0
NEAR = 1e-6
# Differences of normals, and of 1 / depth (1 / m), that are rounding on one flat face.
FLATNESS = 1e-9
UNKNOWN = -2


@dataclass(frozen=True)
class Pinhole:
    """A camera without distortion and with square pixels.

    Pixel centres are at integer coordinates, the optical axis goes through
    ((width - 1) / 2, (height - 1) / 2).

    Attributes:
        width: columns.
        height: rows.
        focal: focal length, pixels.
    """

    width: int
    height: int
    focal: float

    def __post_init__(self) -> None:
        """Refuse a camera that cannot be built."""
        if self.width < 1 or self.height < 1:
            raise ValueError(f"camera size must be > 0, got {self.width} x {self.height}")
        if not 0.0 < self.focal < np.inf:
            raise ValueError(f"camera focal length must be > 0, got {self.focal}")

    def directions(self) -> Floats:
        """Return the rays of all pixels, (h * w, 3), optical frame, row by row, each with z = 1."""
        u = (np.arange(self.width) - (self.width - 1) / 2) / self.focal
        v = (np.arange(self.height) - (self.height - 1) / 2) / self.focal
        x, y = np.meshgrid(u, v)
        return np.stack([x, y, np.ones_like(x)], axis=-1).reshape(-1, 3)

    def borders(self) -> Floats:
        """Return the planes through the outermost rays, (3, 4) unit normals inwards, optical."""
        across = (self.width - 1) / 2 / self.focal
        down = (self.height - 1) / 2 / self.focal
        inward = np.array(
            [[1.0, -1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -1.0], [across, across, down, down]]
        )
        return np.asarray(inward / np.linalg.norm(inward, axis=0), np.float64)


@dataclass(frozen=True)
class Mount:
    """How the camera really sits against where the model has it; the core is not told.

    Attributes:
        rotation: (3, 3), model's optical frame from the real optical frame.
        translation: (3,) metres, of the real camera in the model's optical frame.
    """

    rotation: Floats = field(default_factory=lambda: np.eye(3))
    translation: Floats = field(default_factory=lambda: np.zeros(3))


@dataclass(frozen=True, slots=True, eq=False)
class Cast:
    """What the rays of one frame met.

    Attributes:
        depth: (h, w) metres along the optical axis, NaN where a ray met nothing.
        geom: (h, w) the met geom's id, -1 for none.
        position: (3,) metres, the camera in the world.
        rotation: (3, 3) world from optical frame.
    """

    depth: Floats
    geom: NDArray[np.int32]
    position: Floats
    rotation: Floats


class DepthCamera:
    """Casts a ray through every pixel.

    It sees the geoms of groups 0 to 2 with alpha above 0, the robot's own body included, except
    those of the body that carries the camera: that one would stand before its own lens.

    It saves two rays of three where it can: rays go through every second pixel of every second
    row first; where four neighbours of these lie on one flat face, what is between them does too,
    and 1 / depth is affine over it. All other pixels get rays of their own. Only an object less
    than two pixels wide can be missed so; `every_pixel` does without.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        camera: str,
        pinhole: Pinhole,
        mount: Mount | None = None,
        *,
        every_pixel: bool = False,
    ) -> None:
        """Prepare the rays.

        Args:
            model: the compiled world with the robot.
            camera: name of the camera in the model.
            pinhole: size and focal lengths.
            mount: how the real camera sits against the model's; default: exactly there.
            every_pixel: a ray of its own for every pixel.
        """
        self.pinhole = pinhole
        self._model = model
        self._camera = model.camera(camera).id
        self._body = int(model.cam_bodyid[self._camera])
        self._mount = mount or Mount()
        self._every_pixel = every_pixel
        self._directions = pinhole.directions()
        pixels = np.arange(len(self._directions)).reshape(pinhole.height, pinhole.width)
        first = pixels[::2, ::2]
        self._first_size = first.shape
        self._first_directions = self._directions[first.reshape(-1)]
        self._view = View(model, pinhole.borders())

    def pose(self, data: mujoco.MjData) -> tuple[Floats, Floats]:
        """Return the real camera's position (3,) and rotation (3, 3), world from optical frame."""
        nominal = data.cam_xmat[self._camera].reshape(3, 3) @ MUJOCO_FROM_OPTICAL
        position = data.cam_xpos[self._camera] + nominal @ self._mount.translation
        return position, nominal @ self._mount.rotation

    def cast(self, data: mujoco.MjData) -> Cast:
        """Return what each pixel's ray meets, by the poses that `data` holds."""
        position, rotation = self.pose(data)
        with self._view.alone(data, position, rotation):
            return self._cast(data, position, rotation)

    def _cast(self, data: mujoco.MjData, position: Floats, rotation: Floats) -> Cast:
        shape = (self.pinhole.height, self.pinhole.width)
        inverse = np.empty(shape)
        geom = np.full(shape, UNKNOWN, np.int32)
        if not self._every_pixel:
            self._cast_first(data, position, rotation, inverse, geom)
        rest = np.flatnonzero(geom == UNKNOWN)
        directions = self._directions.take(rest, axis=0)
        depth, met = self._rays(data, position, rotation, directions, None)
        inverse.reshape(-1)[rest] = 1.0 / depth
        geom.reshape(-1)[rest] = met
        return Cast(1.0 / inverse, geom, position, rotation)

    def _cast_first(
        self,
        data: mujoco.MjData,
        position: Floats,
        rotation: Floats,
        inverse: Floats,
        geom: NDArray[np.int32],
    ) -> None:
        """Fill 1 / depth and geom of every second pixel, and of those between them on flat faces.

        Args:
            data: the state.
            position: (3,) the camera's.
            rotation: (3, 3) world from optical frame.
            inverse: (h, w) is filled where known, NaN for nothing met.
            geom: (h, w) is filled where known.
        """
        rows, columns = self._first_size
        normal = np.empty((rows * columns, 3))
        depth, which = self._rays(data, position, rotation, self._first_directions, normal)
        near = 1.0 / depth
        inverse[::2, ::2] = near.reshape(rows, columns)
        geom[::2, ::2] = which.reshape(rows, columns)

        # Row by row in one line each: numpy is slow over short rows. The right neighbour of i is
        # i + 1, that below it i + columns; what a row's last one has on its right is cut off.
        faces = np.ascontiguousarray(normal.T)
        right = (which[1:] == which[:-1]) & _parallel(faces[:, 1:], faces[:, :-1])
        below = which[columns:] == which[:-columns]
        below &= _parallel(faces[:, columns:], faces[:, :-columns])
        twist = near[columns + 1 :] - near[columns:-1] - near[1:-columns] + near[: -columns - 1]
        # A cell is flat when its four corners are on one plane of one geom, or all on nothing.
        flat = np.zeros((rows - 1, columns), np.bool_)
        cells = flat.reshape(-1)
        cells[:-1] = right[columns:] & right[:-columns]
        cells[:-1] &= below[:-1]
        cells[:-1] &= ~(np.abs(twist) > FLATNESS)
        flat[:, -1] = False

        # What lies between two, three or four of them: in the middle of the line between.
        across = np.full_like(near, np.nan)
        np.add(near[1:], near[:-1], out=across[:-1])
        across *= 0.5
        middle = 0.5 * (across[columns:] + across[:-columns])
        down = 0.5 * (near[columns:] + near[:-columns])
        beside = np.zeros((rows, columns), np.bool_)
        beside[1:] = flat
        beside[:-1] |= flat
        above = flat.copy()
        above.reshape(-1)[1:] |= cells[:-1]
        odd, even = slice(1, None, 2), slice(0, None, 2)
        for places, known, values in (
            ((even, odd), beside, across),
            ((odd, even), above, down),
            ((odd, odd), flat, middle),
        ):
            known = known[:, : inverse[places].shape[1]]
            _fill(inverse[places], values.reshape(-1, columns), known)
            _fill(geom[places], which.reshape(rows, columns), known)

    def _rays(
        self,
        data: mujoco.MjData,
        position: Floats,
        rotation: Floats,
        directions: Floats,
        normal: Floats | None,
    ) -> tuple[Floats, NDArray[np.int32]]:
        """Return depth (n,), NaN for none, and geom (n,), -1 for none.

        Args:
            data: the state.
            position: (3,) the camera's.
            rotation: (3, 3) world from optical frame.
            directions: (n, 3) the rays in the optical frame, each with z = 1.
            normal: (n, 3) is filled with the normals of what was met, 0 for none.
        """
        count = len(directions)
        depth, geom = np.empty(count), np.empty(count, np.int32)
        # The rays are not normalised: MuJoCo's distance along a ray with z = 1 is the depth.
        mujoco.mj_multiRay(
            self._model,
            data,
            position,
            (directions @ rotation.T).reshape(-1),
            VISIBLE_GROUPS,
            True,
            self._body,
            geom,
            depth,
            None if normal is None else normal.reshape(-1),
            count,
            FAR,
        )
        nothing = geom < 0
        np.maximum(depth, NEAR, out=depth)
        depth[nothing] = np.nan
        if normal is not None:
            normal[nothing] = 0.0
        return depth, geom


def _fill(pixels: NDArray[Any], values: NDArray[Any], known: NDArray[np.bool_]) -> None:
    """Write the values that are known; row and column 0 of the three belong together."""
    rows, columns = known.shape
    np.copyto(pixels[:rows], values[:rows, :columns], where=known)


def _parallel(first: Floats, second: Floats) -> NDArray[np.bool_]:
    """Return where two rows of normals, (3, n) each, are the same but for rounding."""
    apart = np.abs(first - second)
    # Not `max(axis=0)`: numpy takes longer over so short an axis.
    parallel: NDArray[np.bool_] = np.maximum(np.maximum(apart[0], apart[1]), apart[2]) < FLATNESS
    return parallel
