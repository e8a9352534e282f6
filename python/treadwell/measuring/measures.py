"""What is measured of an episode without the simulator: errors of the pose, times of the stages."""

import math
from array import array
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from treadwell.judging.result import LocalizationErrors, Spread, Timing
from treadwell.protocols import Pose

Floats = NDArray[np.float64]


class PoseErrors:
    """Collects the poses of one camera frame after another."""

    def __init__(self) -> None:
        """Begin with none."""
        self._numbers = array("d")
        self._lost = 0

    def add_lost(self) -> None:
        """Say of the pose that was added last that the robot knew it to be nothing to act on."""
        self._lost += 1

    def add(self, estimate: Floats, odometry: Floats, truth: Floats) -> None:
        """Take in what was believed and what was so; (4, 4) each.

        Args:
            estimate: map_from_robot.
            odometry: the same by leg odometry alone, from the same start.
            truth: world_from_robot.
        """
        # Plain numbers: for so few of them numpy takes longer.
        (xx, xy, _, x), (yx, yy, _, y), (zx, zy, _, z), _ = truth.tolist()
        forward, place = estimate[:3, 0].tolist(), (x, y, z)
        ahead = xx * forward[0] + yx * forward[1] + zx * forward[2]
        aside = xy * forward[0] + yy * forward[1] + zy * forward[2]
        self._numbers.extend(
            (
                math.dist(estimate[:3, 3].tolist(), place),
                abs(math.atan2(aside, ahead)),
                math.dist(odometry[:3, 3].tolist(), place),
            )
        )

    def add_level(self, estimate: Pose, odometry: Pose, truth: Pose) -> None:
        """Do what `add` does with poses (x m, y m, z m, yaw rad): the same to the bit."""
        c, s = math.cos(truth[3]), math.sin(truth[3])
        ahead_c, ahead_s = math.cos(estimate[3]), math.sin(estimate[3])
        place = truth[:3]
        self._numbers.extend(
            (
                math.dist(estimate[:3], place),
                abs(math.atan2(c * ahead_s - s * ahead_c, c * ahead_c + s * ahead_s)),
                math.dist(odometry[:3], place),
            )
        )

    def errors(self) -> LocalizationErrors | None:
        """Return the errors so far, None without a pose."""
        if not self._numbers:
            return None
        columns = np.array(self._numbers).reshape(-1, 3).T
        translation, heading, odometry = (spread(column) for column in columns)
        return LocalizationErrors(
            translation_error=translation,
            heading_error=heading,
            odometry_translation_error=odometry,
            lost_share=self._lost / len(columns.T),
        )


def spread(values: Floats) -> Spread:
    """Return mean, standard deviation and maximum of values (n,), n > 0."""
    return Spread(mean=float(values.mean()), std=float(values.std()), max=float(values.max()))


def timing(seconds: Sequence[float]) -> Timing:
    """Return the table of a stage's times, given in seconds; NaN where it did not run."""
    values = 1e3 * np.asarray(seconds, dtype=np.float64)
    values = values[np.isfinite(values)]
    if not values.size:
        return Timing()
    return Timing(
        median=float(np.median(values)),
        p99=float(np.percentile(values, 99)),
        max=float(values.max()),
        count=int(values.size),
    )
