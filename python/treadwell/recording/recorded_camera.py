"""What a run's depth camera sees: out of the robot's description in its log."""

import math
from pathlib import Path
from typing import Final, NamedTuple

from treadwell.careful_json import json_of
from treadwell.errors import InputError
from treadwell.recording.log_file import read_front
from treadwell.recording.observation_log import ROBOT, header_of

_NUMBERS: Final = ("width", "height", "focal")


class RecordedCamera(NamedTuple):
    """A camera with square pixels, whose axis goes through the image's middle.

    Attributes:
        width: columns, pixels.
        height: rows, pixels.
        focal: focal length, pixels.
    """

    width: int
    height: int
    focal: float

    @property
    def centre(self) -> tuple[float, float]:
        """Column and row of the axis; pixel centres are at integer coordinates."""
        return (self.width - 1.0) / 2.0, (self.height - 1.0) / 2.0


def recorded_camera(path: Path) -> RecordedCamera:
    """Return the camera of a run's `observations.mcap`.

    Raises:
        InputError: the file is missing, none of ours, or does not say it.
    """
    front = read_front(path)
    header_of(front, path)
    where = f"{path}: {ROBOT}"
    if ROBOT not in front.attachments:
        raise InputError(f"{path}: has no {ROBOT}, which says what the camera sees")
    robot = json_of(front.attachments[ROBOT], f"{where}: is broken")
    table = robot.get("camera") if isinstance(robot, dict) else None
    found = [table.get(key) if isinstance(table, dict) else None for key in _NUMBERS]
    if not all(isinstance(n, int | float) and math.isfinite(n) and 0 < n <= 1e6 for n in found):
        raise InputError(f"{where}: camera: must have {', '.join(_NUMBERS)}")
    width, height, focal = (float(n or 0) for n in found)
    return RecordedCamera(int(width), int(height), focal)
