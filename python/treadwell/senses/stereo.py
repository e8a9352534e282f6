"""The stereo camera's errors: from exact depth to what block matching would have measured."""

import json
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from treadwell import _core
from treadwell.senses.depth import Cast, Pinhole, place

Floats = NDArray[np.float64]


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


class StereoModel:
    """Turns what the rays met into the depth image that a stereo camera would give.

    The error has a fixed part, a smooth random function of the camera's pose, of the disparity
    and of the surface, and a part that is new in each frame.

    Attributes:
        errors: the core's.
    """

    def __init__(
        self,
        config: StereoConfig,
        pinhole: Pinhole,
        texture: Floats,
        pattern: np.random.Generator,
        noise: np.random.Generator,
    ) -> None:
        """Seed the errors.

        Args:
            config: the camera's parameters.
            pinhole: the left eye.
            texture: (n,) for each geom id, how well it can be matched, 0 (blank) to 1.
            pattern: seeds the fixed pattern.
            noise: seeds what is new in each frame.
        """
        self.errors = _core.DepthErrors.stereo(
            np.asarray(texture, np.float64),
            width=pinhole.width,
            height=pinhole.height,
            focal=pinhole.focal,
            settings=json.dumps(asdict(config)),
            pattern=seed(pattern),
            noise=seed(noise),
        )

    def see(self, cast: Cast) -> NDArray[np.float32]:
        """Return the measured depth, (h, w) metres along the optical axis, NaN for no match."""
        return self.errors.see(cast.depth, cast.geom, place(cast.position), cast.rotation)


def seed(stream: np.random.Generator) -> int:
    """Return a seed for the core from a component's own stream."""
    return int(stream.integers(2**63))
