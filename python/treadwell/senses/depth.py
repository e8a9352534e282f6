"""The depth camera without its errors: a ray through every pixel into the simulated world."""

from dataclasses import dataclass, field

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell import _core
from treadwell.senses.elsewhere import CastElsewhere
from treadwell.senses.projection import depth_camera

Floats = NDArray[np.float64]

# MuJoCo's camera looks along -z with y up, the optical frame along z with y down.
MUJOCO_FROM_OPTICAL = np.diag([1.0, -1.0, -1.0])
# Forward, left and up as the optical frame has them.
OPTICAL_FROM_AHEAD = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])


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


@dataclass(frozen=True, slots=True, eq=False)
class _Views:
    """What a camera reads of MuJoCo's data, as views, which cost at each frame.

    Attributes:
        data: whose they are.
        position: (3,) of the model's camera, world.
        rotation: (3, 3) of the same, as MuJoCo has cameras.
        geom_positions: (ngeom, 3).
        geom_rotations: (ngeom, 9).
    """

    data: mujoco.MjData
    position: Floats
    rotation: Floats
    geom_positions: Floats
    geom_rotations: Floats


class DepthCamera:
    """Looks through every pixel.

    It sees the geoms of groups 0 to 2 with alpha above 0, the robot's own body included, except
    those of the body that carries the camera: that one would stand before its own lens.

    Attributes:
        pinhole: its size and focal length.
    """

    def __init__(
        self, model: mujoco.MjModel, camera: str, pinhole: Pinhole, mount: Mount | None = None
    ) -> None:
        """Hand the model's geoms to the core.

        Args:
            model: the compiled world with the robot.
            camera: name of the camera in the model.
            pinhole: size and focal lengths.
            mount: how the real camera sits against the model's; default: exactly there.
        """
        self.pinhole = pinhole
        self._camera = model.camera(camera).id
        self._mount = mount or Mount()
        carrier = int(model.cam_bodyid[self._camera])
        self._rays = depth_camera(model, carrier, pinhole.width, pinhole.height, pinhole.focal)
        self._elsewhere: CastElsewhere | None = None
        self._views: _Views | None = None
        if self._rays.unknown:
            shape = (pinhole.height, pinhole.width)
            self._elsewhere = CastElsewhere(model, self._rays.unknown, pinhole.directions(), shape)

    def pose(self, data: mujoco.MjData) -> tuple[Floats, Floats]:
        """Return the real camera's position (3,) and rotation (3, 3), world from optical frame."""
        views = self._of(data)
        nominal = views.rotation @ MUJOCO_FROM_OPTICAL
        position = views.position + nominal @ self._mount.translation
        return position, nominal @ self._mount.rotation

    def knock(self, turn: Floats) -> None:
        """Turn the real camera where it sits.

        Args:
            turn: (3, 3), in the axes forward, left, up of the model's camera.
        """
        turned = OPTICAL_FROM_AHEAD @ turn @ OPTICAL_FROM_AHEAD.T @ self._mount.rotation
        self._mount = Mount(turned, self._mount.translation)

    def cast(self, data: mujoco.MjData) -> Cast:
        """Return what each pixel's ray meets, by the poses that `data` holds."""
        position, rotation = self.pose(data)
        depth, geom = self._rays.cast(
            data.geom_xpos,
            data.geom_xmat,
            place(position),
            rotation,
            others=self._others(data, position, rotation),
        )
        return Cast(depth, geom, position, rotation)

    def see(self, data: mujoco.MjData, errors: _core.DepthErrors) -> NDArray[np.float32]:
        """Return the depth (h, w) that a camera with these errors measures, m, NaN for none."""
        position, rotation = self.pose(data)
        views = self._of(data)
        return self._rays.see(
            views.geom_positions,
            views.geom_rotations,
            place(position),
            rotation,
            errors,
            others=self._others(data, position, rotation),
        )

    def _of(self, data: mujoco.MjData) -> "_Views":
        """Return the views of what was looked at last, made anew where that is something else."""
        if self._views is None or self._views.data is not data:
            self._views = _Views(
                data,
                data.cam_xpos[self._camera],
                data.cam_xmat[self._camera].reshape(3, 3),
                data.geom_xpos,
                data.geom_xmat,
            )
        return self._views

    def _others(
        self, data: mujoco.MjData, position: Floats, rotation: Floats
    ) -> tuple[Floats, NDArray[np.int32]] | None:
        if self._elsewhere is None:
            return None
        return self._elsewhere.cast(data, position, rotation)


def place(position: Floats) -> tuple[float, float, float]:
    """Return a position (3,) as the core takes it."""
    x, y, z = position.tolist()
    return x, y, z
