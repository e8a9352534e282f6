"""The errors of a structured-light camera: from exact depth to what a Kinect or Xtion measures.

A projector beside the camera throws a pattern of dots; each small window of the image is found in
the picture of the pattern that is stored. Its place there is a disparity, in steps of an eighth of
a pixel of the 640 pixels wide sensor: Z = f b / d, sigma_Z = Z^2 sigma_d / (f b) (Khoshelham and
Oude Elberink, Sensors 12, 2012). At the borders of surfaces a window may be found on either of
them (the lateral noise of Nguyen, Izadi and Lovell, 3DIMPVT 2012). Texture does not matter: the
light brings its own.
"""

import json
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from treadwell import _core
from treadwell.senses.depth import Cast, Pinhole, place
from treadwell.senses.stereo import seed


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


class StructuredLightModel:
    """Turns what the rays met into the depth image that a structured-light camera would give.

    Attributes:
        errors: the core's.
    """

    def __init__(
        self, config: StructuredLightConfig, pinhole: Pinhole, noise: np.random.Generator
    ) -> None:
        """Seed the errors.

        Args:
            config: the camera's parameters.
            pinhole: the camera.
            noise: seeds what is new in each frame: all of it.
        """
        self.errors = _core.DepthErrors.structured_light(
            width=pinhole.width,
            height=pinhole.height,
            focal=pinhole.focal,
            settings=json.dumps(asdict(config)),
            noise=seed(noise),
        )

    def see(self, cast: Cast) -> NDArray[np.float32]:
        """Return the measured depth, (h, w) metres along the optical axis, NaN for none."""
        return self.errors.see(cast.depth, cast.geom, place(cast.position), cast.rotation)
