"""A grid of heights around the robot, as it believes them: what its own map says."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Final, Self

import gymnasium
import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.protocols import FloorMap, Pose
from treadwell.scenario.messages import nearest

SCAN: Final = "height_scan"
"""Name of the heights among the observations."""
KNOWN: Final = "height_scan_known"
"""Name of what tells which of them are known."""
HIGHEST_M: Final = 2.0
"""Heights beyond, of either sign, are cut to this."""
MOST_POINTS: Final = 100_000


@dataclass(frozen=True, slots=True)
class HeightScan:
    """Where heights are asked for: a grid in the robot's heading frame, that turns with it.

    Attributes:
        length: m, from the hindmost row to the foremost.
        width: m, from the rightmost column to the leftmost.
        spacing: m, from one row or column to the next.
        ahead: m, from the robot forward to the grid's middle.
    """

    length: float = 1.2
    width: float = 0.8
    spacing: float = 0.05
    ahead: float = 0.3

    def __post_init__(self) -> None:
        """Refuse what is no grid.

        Raises:
            InputError: a number is not finite or not above 0, or there would be too many points.
        """
        for name, value in asdict(self).items():
            must = "be finite" if name == "ahead" else "be finite and > 0"
            if not math.isfinite(value) or (name != "ahead" and value <= 0.0):
                raise InputError(f"height_scan.{name}: must {must}, found {value}")
        if (self.length / self.spacing + 1) * (self.width / self.spacing + 1) > MOST_POINTS:
            raise InputError(f"height_scan.spacing: makes more than {MOST_POINTS} points")

    @classmethod
    def read(cls, asked: Mapping[str, float] | bool) -> Self | None:
        """Return what an environment was asked for.

        Args:
            asked: False: no scan; True: the usual one; else some attributes by name.

        Raises:
            InputError: a name is unknown, or a value is no number or cannot be.
        """
        if isinstance(asked, bool):
            return cls() if asked else None
        if not isinstance(asked, Mapping):
            raise InputError(f"height_scan: must be True, False or a table, found {asked!r}")
        names = [field.name for field in fields(cls)]
        for name, value in asked.items():
            if name not in names:
                raise InputError(
                    f"height_scan.{name}: unknown key: allowed are {', '.join(names)}"
                    f"{nearest(str(name), names)}"
                )
            if isinstance(value, bool) or not isinstance(value, int | float):
                raise InputError(f"height_scan.{name}: must be a number, found {value!r}")
        return cls(**asked)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows, from behind to ahead, and columns, from right to left."""
        return 1 + round(self.length / self.spacing), 1 + round(self.width / self.spacing)

    def spaces(self) -> dict[str, gymnasium.Space[NDArray[np.generic]]]:
        """Return name -> space of the observations that a scan makes."""
        heights = gymnasium.spaces.Box(-HIGHEST_M, HIGHEST_M, self.shape, np.float32)
        known = gymnasium.spaces.Box(0, 1, self.shape, np.uint8)
        return {SCAN: heights, KNOWN: known}

    def observed(self, view: FloorMap, pose: Pose) -> dict[str, NDArray[np.generic]]:
        """Return what is believed of the ground around the robot.

        Args:
            view: the map's.
            pose: (x m, y m, z m, yaw rad): where the robot believes to be, on which height.

        Returns:
            `height_scan`: (rows, columns) float32 m above the ground on which the robot believes to
            stand, of floor and of obstacles; 0 where nothing is known. `height_scan_known`: the
            same shape, uint8, 1 where the height is known.
        """
        x, y, z, yaw = pose
        rows, cols = self.shape
        forward = self.ahead + self.spacing * (np.arange(rows) - 0.5 * (rows - 1))[:, None]
        left = self.spacing * (np.arange(cols) - 0.5 * (cols - 1))[None, :]
        cos, sin = math.cos(yaw), math.sin(yaw)
        row = np.floor((y + sin * forward + cos * left - view.origin[1]) / view.cell).astype(int)
        col = np.floor((x + cos * forward - sin * left - view.origin[0]) / view.cell).astype(int)
        heights = np.asarray(view.height)
        inside = (row >= 0) & (row < heights.shape[0]) & (col >= 0) & (col < heights.shape[1])
        seen = np.full(self.shape, np.nan)
        seen[inside] = heights[row[inside], col[inside]] - z
        known = np.isfinite(seen)
        clipped = np.clip(np.where(known, seen, 0.0), -HIGHEST_M, HIGHEST_M)
        return {SCAN: clipped.astype(np.float32), KNOWN: known.astype(np.uint8)}
