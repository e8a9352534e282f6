"""What a source yields: one depth image, cloud or laser scan, and where its sensor was."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Layout = Literal["picture", "scan", "cloud"]


@dataclass(frozen=True, slots=True, eq=False)
class PinholeCamera:
    """A camera without distortion.

    Attributes:
        width: columns, pixels.
        height: rows, pixels.
        fx: focal length along the columns, pixels.
        fy: focal length along the rows, pixels.
        cx: column of the optical axis, pixels; pixel centres are at integer coordinates.
        cy: row of the optical axis, pixels.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float


@dataclass(frozen=True, slots=True, eq=False)
class RangeFrame:
    """What a range sensor saw at one time.

    Attributes:
        time: seconds, by the source's clock.
        world_from_sensor: (4, 4); large coordinates are in it, so that the points' are small.
        camera: of a depth image; None of points.
        depth: (h, w) m along the optical axis, NaN where nothing was seen; None of points.
        points: (n, 3) m in the sensor's frame, NaN in rows where nothing was seen; None of a depth
            image. A laser's frame has x forward and y left, with its scan in z = 0.
        layout: "picture": a depth image; "scan": points of one sweep of a laser, by its angle;
            "cloud": points in no order.
        colour: red, green, blue, (h, w, 3) or (n, 3) as what they belong to; None without.
        origin_known: whether the sensor stood at its frame's origin. False of one cloud whose
            file does not say where it was taken from, and of a height image: then that origin
            is only a place near the points, and nothing is known of lines of sight.
    """

    time: float
    world_from_sensor: Floats
    camera: PinholeCamera | None
    depth: NDArray[np.float32] | None
    points: NDArray[np.float32] | None
    layout: Layout
    colour: NDArray[np.uint8] | None = None
    origin_known: bool = True


class UnusableError(Exception):
    """A frame that cannot be used; its message is the reason, in a few words and without names."""


def translation(place: Floats | Sequence[float]) -> Floats:
    """Return the pose (4, 4) of a frame that is not turned, from its origin x, y, z m."""
    pose = np.eye(4)
    pose[:3, 3] = place
    return pose


def moved(pose: Floats, points: NDArray[Any]) -> Floats:
    """Return points (n, 3) in the frame that a pose (4, 4) leads into."""
    there: Floats = points @ pose[:3, :3].T + pose[:3, 3]
    return there
