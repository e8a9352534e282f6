"""A camera of one's own."""

import math
from dataclasses import dataclass

from treadwell.errors import InputError
from treadwell.sources.frame import PinholeCamera


@dataclass(frozen=True, slots=True)
class Camera(PinholeCamera):
    """A depth camera without distortion; pixel centres are at integer coordinates.

    >>> from treadwell import mapping
    >>> camera = mapping.Camera(width=640, height=480, fx=525.0, fy=525.0, cx=319.5, cy=239.5)

    Attributes:
        width: columns, pixels.
        height: rows, pixels.
        fx: focal length along the columns, pixels.
        fy: focal length along the rows, pixels.
        cx: column of the optical axis, pixels.
        cy: row of the optical axis, pixels.

    Raises:
        InputError: a number that no camera has; it is named.
    """

    def __post_init__(self) -> None:
        """Refuse what is no camera."""
        for name in ("width", "height"):
            value = getattr(self, name)
            if isinstance(value, bool) or int(value) != value or not 2 <= value <= 10_000:
                raise InputError(
                    f"Camera: {name} must be a whole number from 2 to 10000, got {value!r}"
                )
        for name in ("fx", "fy"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"Camera: {name} must be finite and > 0 pixels, got {value!r}")
        for name in ("cx", "cy"):
            value = getattr(self, name)
            if not math.isfinite(value):
                raise InputError(f"Camera: {name} must be finite, got {value!r}")
