"""What the robot's senses tell it at one control tick: all that the core is given. No pose."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Frame:
    """One image of the depth camera.

    Attributes:
        exposure_ns: time at which the camera saw this, nanoseconds since the start.
        arrival_ns: time at which the frame was handed over; never before the exposure.
        depth: (h, w) float32, metres along the optical axis, row 0 at the top, column 0 at the
            left; NaN where nothing was seen.
        intensity: (h, w) uint8, how bright each pixel is, 0 where nothing is in view; None unless
            the scenario asks for it (`sensors.intensity`).
    """

    exposure_ns: int
    arrival_ns: int
    depth: NDArray[np.float32]
    intensity: NDArray[np.uint8] | None = None

    @property
    def shape(self) -> tuple[int, ...]:
        """Rows and columns of the image."""
        return self.depth.shape

    @property
    def dtype(self) -> np.dtype[np.float32]:
        """Type of the image's numbers."""
        return self.depth.dtype

    def __repr__(self) -> str:
        rows, cols = self.shape[:2]
        return f"<Frame {cols} x {rows}, seen at {1e-9 * self.exposure_ns:.2f} s>"

    def __array__(
        self, dtype: np.dtype[Any] | None = None, copy: bool | None = None
    ) -> NDArray[Any]:
        """Return the image: a frame can stand wherever numpy takes an array."""
        return np.array(self.depth, dtype=dtype, copy=copy)

    def __getitem__(self, index: Any) -> Any:  # noqa: ANN401
        """Return pixels of the image, as numpy indexes them."""
        return self.depth[index]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Observation:
    """The measurements of one control tick.

    Attributes:
        time_ns: nanoseconds since the start.
        joint_positions: (n,) rad, by the robot's joint order, as the encoders read.
        joint_velocities: (n,) rad/s, by the robot's joint order.
        angular_velocity: (3,) rad/s, in the IMU's frame.
        specific_force: (3,) m/s², in the IMU's frame; at rest it points up with 9.81.
        foot_forces: (2, 4) N, rows left and right; columns front left, front right, rear left,
            rear right.
        depth: the frame that arrived at this tick, if one did.
    """

    time_ns: int
    joint_positions: Floats
    joint_velocities: Floats
    angular_velocity: Floats
    specific_force: Floats
    foot_forces: Floats
    depth: Frame | None

    def __repr__(self) -> str:
        joints, newtons = len(self.joint_positions), np.sum(self.foot_forces, axis=-1)
        seen = "no depth image" if self.depth is None else repr(self.depth)
        feet = " and ".join(f"{force:.0f}" for force in newtons)
        now = f"{1e-9 * self.time_ns:.2f} s"
        return f"<Observation at {now}: {joints} joints, feet bear {feet} N, {seen}>"
