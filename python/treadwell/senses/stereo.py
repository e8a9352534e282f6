"""The stereo camera's errors: from exact depth to what block matching would have measured."""

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from treadwell.senses.depth import Cast, Pinhole

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Mask = NDArray[np.bool_]

# The fixed pattern stays while the image stays and is another one when it has moved by about one
# pixel: lengths of its Gaussian correlation over the camera's turn (rad), the camera's way (m) and
# the disparity (px), each 1 / 2.15 of what moves the image by one pixel at 0.6 m.
PATTERN_TURN = 0.0046
PATTERN_WAY = 0.0028
PATTERN_DISPARITY = 0.23

# Share of a blank surface's matches that is decided anew in each frame.
VALIDITY_TEMPORAL = 0.4
TEXTURE_LEVELS = 256
CREASE_ITERATIONS = 4


@dataclass(frozen=True)
class StereoConfig:
    """Parameters of the stereo model.

    Attributes:
        baseline: metres between the eyes; the left one is the reference.
        window: pixels, odd: width and height of the matching window.
        disparity_noise_fixed: px, sigma of what is the same for the same scene and pose.
        disparity_noise_temporal: px, sigma of what is new in each frame.
        quantum: px, step of the sub-pixel interpolation; 0 for none.
        min_disparity: px, farther is not seen.
        max_disparity: px, nearer is not seen.
        mismatch_rate: share of the pixels whose match is anywhere.
        crease_bandwidth: px, surfaces closer than this in disparity blend inside a window.
        valid_textured: probability of a match where texture = 1.
        valid_blank: probability of a match where texture = 0.
    """

    baseline: float
    window: int = 5
    disparity_noise_fixed: float = 0.10
    disparity_noise_temporal: float = 0.05
    quantum: float = 0.125
    min_disparity: float = 1.5
    max_disparity: float = 24.0
    mismatch_rate: float = 0.007
    crease_bandwidth: float = 1.0
    valid_textured: float = 0.95
    valid_blank: float = 0.02

    def __post_init__(self) -> None:
        """Refuse what no camera could be."""
        if self.baseline <= 0.0:
            raise ValueError(f"camera.stereo.baseline must be > 0, got {self.baseline}")
        if self.window < 1 or self.window % 2 == 0:
            raise ValueError(f"camera.stereo.window must be odd and > 0, got {self.window}")
        if self.quantum < 0.0:
            raise ValueError(f"camera.stereo.quantum must be >= 0, got {self.quantum}")
        if not 0.0 < self.min_disparity < self.max_disparity:
            raise ValueError(
                "camera.stereo.min_disparity must be > 0 and < max_disparity, "
                f"got {self.min_disparity} and {self.max_disparity}"
            )
        if min(self.disparity_noise_fixed, self.disparity_noise_temporal) < 0.0:
            raise ValueError("camera.stereo.disparity_noise must be >= 0")
        if not 0.0 <= self.mismatch_rate <= 1.0:
            raise ValueError(
                f"camera.stereo.mismatch_rate must be within 0 and 1, got {self.mismatch_rate}"
            )
        if not 0.0 <= self.valid_blank <= self.valid_textured <= 1.0:
            raise ValueError(
                "camera.stereo.valid_textured must be within valid_blank and 1, "
                f"got {self.valid_textured}"
            )


def window_sum(image: Floats32, window: int) -> Floats32:
    """Return the sums over all whole windows: (h - window + 1, w - window + 1)."""
    rows = image.shape[0] - window + 1
    columns = image.shape[1] - window + 1
    over_rows = image[:rows].copy()
    for i in range(1, window):
        over_rows += image[i : i + rows]
    total = over_rows[:, :columns].copy()
    for i in range(1, window):
        total += over_rows[:, i : i + columns]
    return total


def _window_extreme(image: Floats32, window: int, extreme: np.ufunc) -> Floats32:
    """Return the largest (np.maximum) or smallest (np.minimum) value of all whole windows."""
    rows = image.shape[0] - window + 1
    columns = image.shape[1] - window + 1
    over_rows = image[:rows].copy()
    for i in range(1, window):
        extreme(over_rows, image[i : i + rows], out=over_rows)
    result = over_rows[:, :columns].copy()
    for i in range(1, window):
        extreme(result, over_rows[:, i : i + columns], out=result)
    return result


def blend_creases(disparity: Floats32, window: int, bandwidth: float) -> Floats32:
    """Return the disparity that matching whole windows finds: (h - window + 1, w - window + 1).

    A mean shift over the window's disparities, with a flat kernel, that starts at the nearest
    (largest) one. Where all of a window lies within the bandwidth this is its mean.

    Args:
        disparity: (h, w) px, finite.
        window: pixels, odd.
        bandwidth: px.
    """
    nearest = _window_extreme(disparity, window, np.maximum)
    spread = nearest - _window_extreme(disparity, window, np.minimum)
    blended = window_sum(disparity, window)
    blended *= np.float32(1.0 / window**2)
    at = np.flatnonzero(spread >= bandwidth)
    if at.size == 0:
        return blended
    width = disparity.shape[1]
    row, column = np.divmod(at, blended.shape[1])
    offsets = (np.arange(window)[:, None] * width + np.arange(window)).reshape(-1)
    inside = np.take(disparity.reshape(-1), offsets[:, None] + (row * width + column))
    mode = nearest.reshape(-1)[at]
    for _ in range(CREASE_ITERATIONS):
        near = (np.abs(inside - mode) < bandwidth).astype(np.float32)
        mode = np.einsum("ij,ij->j", near, inside) / near.sum(axis=0)
    blended.reshape(-1)[at] = mode
    return blended


def occluded(disparity: Floats32) -> Mask:
    """Return which pixels of the left image the right eye cannot see, (h, w).

    Pixel u appears at u - d in the right image; it is hidden when a pixel further right in the
    left image appears at the same place or left of it.

    Args:
        disparity: (h, w) px, finite.
    """
    place = np.arange(disparity.shape[1], dtype=np.float32) - disparity
    hidden = np.zeros(disparity.shape, np.bool_)
    # In most rows each pixel appears right of the one before: nothing is hidden there.
    rows = np.flatnonzero((place[:, 1:] <= place[:, :-1]).any(axis=1))
    place = place[rows]
    leftmost = np.minimum.accumulate(place[:, ::-1], axis=1)[:, ::-1]
    hidden[rows, :-1] = leftmost[:, 1:] <= place[:, :-1]
    return hidden


class StereoModel:
    """Turns what the rays met into the depth image that a stereo camera would give.

    The error has a fixed part, a smooth random function of the camera's pose, of the disparity
    and of the surface, and a part that is new in each frame.
    """

    def __init__(
        self,
        config: StereoConfig,
        pinhole: Pinhole,
        pattern: np.random.Generator,
        noise: np.random.Generator,
    ) -> None:
        """Prepare the fixed pattern.

        Args:
            config: the camera's parameters.
            pinhole: the left eye.
            pattern: decides the fixed pattern; read here only.
            noise: what is new in each frame.
        """
        self.config = config
        self._pinhole = pinhole
        self._noise = noise
        shape = (pinhole.height, pinhole.width)
        count = pinhole.height * pinhole.width
        # Random Fourier features: one wave per pixel, whose phase runs with pose and disparity.
        self._wave_pose = pattern.standard_normal((count, 12))
        self._wave_disparity = pattern.standard_normal(shape) / PATTERN_DISPARITY
        self._wave_phase = pattern.uniform(0.0, 2.0 * np.pi, shape)
        self._surface_step = pattern.uniform(0.0, 2.0 * np.pi)
        share = np.linspace(config.valid_blank, config.valid_textured, TEXTURE_LEVELS)
        share = np.clip(share, 1e-12, 1.0 - 1e-12)
        normal = NormalDist()
        self._match_below = np.array([normal.inv_cdf(float(p)) for p in share])
        self._columns = np.arange(pinhole.width, dtype=np.float32)

    def see(self, cast: Cast, texture: Floats) -> Floats32:
        """Return the measured depth, (h, w) metres along the optical axis, NaN for no match.

        Args:
            cast: the exact depth, the geoms met, and the camera's pose.
            texture: for each geom id, how well it can be matched, 0 (blank) to 1.
        """
        config = self.config
        border = config.window // 2
        inner = (
            slice(border, self._pinhole.height - border),
            slice(border, self._pinhole.width - border),
        )
        focal = self._pinhole.focal * config.baseline
        exact = (focal / cast.depth).astype(np.float32)
        exact[np.isnan(exact)] = 0.0
        error, luck = self._fields(cast, exact)

        measured = blend_creases(exact, config.window, config.crease_bandwidth)
        measured += error
        seen = luck < self._threshold(cast, texture)[inner]
        self._mismatch(measured, seen)
        if config.quantum > 0.0:
            steps = np.rint(measured / np.float32(config.quantum))
            measured = steps * np.float32(config.quantum)

        seen &= ~occluded(exact)[inner]
        seen &= cast.geom[inner] >= 0
        seen &= (measured >= config.min_disparity) & (measured <= config.max_disparity)
        seen &= self._columns[inner[1]] - measured >= border
        depth = np.full(exact.shape, np.nan, np.float32)
        np.divide(np.float32(focal), measured, out=depth[inner], where=seen)
        return depth

    def _fields(self, cast: Cast, disparity: Floats32) -> tuple[Floats32, Floats32]:
        """Return the disparity error (px) and a unit normal field that decides on matches."""
        config = self.config
        pose = np.concatenate(
            [
                cast.position / PATTERN_WAY,
                cast.rotation.reshape(-1) / (np.sqrt(2.0) * PATTERN_TURN),
            ]
        )
        phase = (self._wave_pose @ pose).reshape(disparity.shape)
        phase += self._wave_phase
        phase += self._wave_disparity * disparity
        phase += self._surface_step * cast.geom
        turns = 1.0 / (2.0 * np.pi)
        phase -= np.floor(phase * turns) / turns
        angle = phase.astype(np.float32)
        # A sum over n x n independent values has n times their sigma; a cosine's is sqrt(1/2).
        unit = 1.0 / config.window
        fixed = np.float32(np.sqrt(2.0) * unit)
        error = np.cos(angle)
        error *= fixed * np.float32(config.disparity_noise_fixed)
        new = self._noise.standard_normal(disparity.shape, np.float32)
        error += new * np.float32(unit * config.disparity_noise_temporal)
        luck = np.sin(angle)
        luck *= fixed * np.float32(np.sqrt(1.0 - VALIDITY_TEMPORAL**2))
        new = self._noise.standard_normal(disparity.shape, np.float32)
        luck += new * np.float32(unit * VALIDITY_TEMPORAL)
        return window_sum(error, config.window), window_sum(luck, config.window)

    def _threshold(self, cast: Cast, texture: Floats) -> Floats:
        """Return below which value of a unit normal a pixel is matched, (h, w)."""
        level = np.rint(np.clip(texture, 0.0, 1.0) * (TEXTURE_LEVELS - 1)).astype(np.intp)
        # Where nothing was met geom is -1: wrapped, as plain indexing has it, which takes longer.
        return self._match_below[level].take(cast.geom, mode="wrap")

    def _mismatch(self, measured: Floats32, seen: Mask) -> None:
        """Put a few of the matched pixels anywhere in the range of disparities."""
        config = self.config
        count = int(self._noise.binomial(measured.size, config.mismatch_rate))
        at = self._noise.integers(0, measured.size, count)
        values = self._noise.uniform(config.min_disparity, config.max_disparity, count)
        measured.reshape(-1)[at] = np.where(seen.reshape(-1)[at], values, 0.0)
