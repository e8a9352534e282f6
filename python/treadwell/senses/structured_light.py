"""The errors of a structured-light camera: from exact depth to what a Kinect or Xtion measures.

A projector beside the camera throws a pattern of dots; each small window of the image is found in
the picture of the pattern that is stored. Its place there is a disparity, in steps of an eighth of
a pixel of the 640 pixels wide sensor: Z = f b / d, sigma_Z = Z^2 sigma_d / (f b) (Khoshelham and
Oude Elberink, Sensors 12, 2012). At the borders of surfaces a window may be found on either of
them (the lateral noise of Nguyen, Izadi and Lovell, 3DIMPVT 2012). Texture does not matter: the
light brings its own.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from treadwell.senses.depth import Cast, Pinhole
from treadwell.senses.stereo import occluded

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class StructuredLightConfig:
    """Parameters of the model.

    Attributes:
        baseline: metres from the camera to the projector, which is on its right.
        window: pixels a side over which the noise is the same.
        disparity_noise: px, sigma of the whole error of a disparity, its rounding included.
        quantum: px, step of the disparities; 0 for none.
        nearest: metres, nearer is not seen.
        farthest: metres, farther is not seen.
        lateral_noise: px, sigma of where a border is seen.
        edge_jump: px, a larger step in disparity between neighbours is a border.
        edge_dropout: share of the pixels at borders that are missing.
        steepest: rad, what is looked at more slantingly is not seen; from the surface's normal.
    """

    baseline: float
    window: int = 2
    disparity_noise: float = 0.03125
    quantum: float = 0.0625
    nearest: float = 0.5
    farthest: float = 4.0
    lateral_noise: float = 0.4
    edge_jump: float = 0.5
    edge_dropout: float = 0.015
    steepest: float = 1.396

    def __post_init__(self) -> None:
        """Refuse what no camera could be."""
        rounding = self.quantum / np.sqrt(12.0)
        allowed = {
            "baseline": self.baseline > 0.0,
            "window": self.window >= 1,
            "disparity_noise": self.disparity_noise >= rounding,
            "quantum": self.quantum >= 0.0,
            "nearest": 0.0 < self.nearest < self.farthest,
            "lateral_noise": self.lateral_noise >= 0.0,
            "edge_jump": self.edge_jump > 0.0,
            "edge_dropout": 0.0 <= self.edge_dropout <= 1.0,
            "steepest": 0.0 < self.steepest <= 0.5 * np.pi,
        }
        for key, fits in allowed.items():
            if not fits:
                value = getattr(self, key)
                raise ValueError(f"camera.structured_light.{key} cannot be {value}")


def _slopes(disparity: Floats32, axis: int) -> Floats32:
    """Return the slope along an axis, px/px: the smaller one of those to the two neighbours."""
    steps = np.diff(disparity, axis=axis)
    first, last = np.take(steps, [0], axis=axis), np.take(steps, [-1], axis=axis)
    ahead, behind = np.concatenate([steps, last], axis), np.concatenate([first, steps], axis)
    return np.where(np.abs(ahead) < np.abs(behind), ahead, behind)


class StructuredLightModel:
    """Turns what the rays met into the depth image that a structured-light camera would give."""

    def __init__(
        self, config: StructuredLightConfig, pinhole: Pinhole, noise: np.random.Generator
    ) -> None:
        """Prepare the rays.

        Args:
            config: the camera's parameters.
            pinhole: the camera.
            noise: what is new in each frame: all of it.
        """
        self.config = config
        self._pinhole = pinhole
        self._noise = noise
        rays = pinhole.directions().astype(np.float32)
        shape = (pinhole.height, pinhole.width)
        self._across = np.ascontiguousarray(rays[:, 0].reshape(shape)) * np.float32(pinhole.focal)
        self._down = np.ascontiguousarray(rays[:, 1].reshape(shape)) * np.float32(pinhole.focal)
        self._ray_length = np.linalg.norm(rays, axis=1).reshape(shape)
        self._rows, self._columns = np.indices(shape)

    def see(self, cast: Cast, _texture: Floats) -> Floats32:
        """Return the measured depth, (h, w) metres along the optical axis, NaN for none.

        Args:
            cast: the exact depth and the geoms met.
            _texture: for each geom id; of no matter.
        """
        config = self.config
        scale = np.float32(self._pinhole.focal * config.baseline)
        exact = (scale / cast.depth).astype(np.float32)
        exact[np.isnan(exact)] = 0.0
        found, border = self._at_borders(exact)

        measured = found + self._disparity_noise(exact.shape)
        if config.quantum > 0.0:
            quantum = np.float32(config.quantum)
            measured = np.rint(measured / quantum) * quantum
        seen = found > 0.0
        seen &= ~occluded(exact)
        seen &= self._facing(exact)
        seen &= ~(border & (self._noise.random(exact.shape, np.float32) < config.edge_dropout))
        seen &= (measured >= scale / config.farthest) & (measured <= scale / config.nearest)
        depth = np.full(exact.shape, np.nan, np.float32)
        np.divide(scale, measured, out=depth, where=seen)
        return depth

    def _disparity_noise(self, shape: tuple[int, ...]) -> Floats32:
        """Return what is added before rounding, px: the rounding's own error is part of sigma."""
        config, window = self.config, self.config.window
        sigma = np.sqrt(max(config.disparity_noise**2 - config.quantum**2 / 12.0, 0.0))
        size = [-(-length // window) for length in shape]
        noise = self._noise.standard_normal(size, np.float32) * np.float32(sigma)
        wide = np.repeat(np.repeat(noise, window, axis=0), window, axis=1)
        return wide[: shape[0], : shape[1]]

    def _at_borders(self, exact: Floats32) -> tuple[Floats32, Mask]:
        """Return the disparities with jittered borders, and which pixels are at one.

        A pixel takes the place of one beside it where that is on another surface; within one
        surface the axial noise is all that was measured, so it stays what it is.
        """
        rows, columns = exact.shape
        step = np.float32(self.config.lateral_noise)
        shift = np.rint(self._noise.standard_normal((2, *exact.shape), np.float32) * step)
        row = np.clip(self._rows + shift[0].astype(np.intp), 0, rows - 1)
        column = np.clip(self._columns + shift[1].astype(np.intp), 0, columns - 1)
        beside = exact[row, column]
        jump = self.config.edge_jump
        found = np.where(np.abs(beside - exact) > jump, beside, exact)

        border = np.zeros(exact.shape, np.bool_)
        down = np.abs(np.diff(exact, axis=0)) > jump
        across = np.abs(np.diff(exact, axis=1)) > jump
        border[1:] |= down
        border[:-1] |= down
        border[:, 1:] |= across
        border[:, :-1] |= across
        return found, border

    def _facing(self, exact: Floats32) -> Mask:
        """Return which pixels see their surface steeply enough.

        On a plane n . P = k the disparity is d = (f b / k) n . ray, so that its slopes tell n.
        """
        focal = np.float32(self._pinhole.focal)
        across, down = _slopes(exact, 1), _slopes(exact, 0)
        ahead = (exact - across * self._across - down * self._down) / focal
        normal = np.sqrt(across**2 + down**2 + ahead**2)
        least = np.float32(np.cos(self.config.steepest))
        facing: Mask = exact >= least * focal * self._ray_length * normal
        return facing
