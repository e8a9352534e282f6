"""`camera.toml`: what a depth camera of somebody else's sees, in pixels."""

import os
from pathlib import Path
from typing import Annotated, Final

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, ValidationError

from treadwell.errors import InputError
from treadwell.scenario.loading import read_toml
from treadwell.scenario.messages import shortened, shown
from treadwell.sources.frame import PinholeCamera

NAME: Final = "camera.toml"
MOST_PIXELS: Final = 8192
"""Along a side: of an image that no depth camera has; four such images fill a gigabyte."""

Side = Annotated[int, Field(ge=1, le=MOST_PIXELS)]
Focal = Annotated[FiniteFloat, Field(gt=0.0, le=1e6)]
Centre = Annotated[FiniteFloat, Field(ge=-1e6, le=1e6)]


class CameraFile(BaseModel):
    """The file: a camera without distortion, and what the numbers of its images mean."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    width: Side
    """Columns, pixels."""
    height: Side
    """Rows, pixels."""
    fx: Focal
    """Focal length along the columns, pixels."""
    fy: Focal
    """Focal length along the rows, pixels."""
    cx: Centre
    """Column of the optical axis, pixels."""
    cy: Centre
    """Row of the optical axis, pixels."""
    depth_scale: Annotated[FiniteFloat, Field(gt=0.0, le=1e9)] | None = None
    """Units a metre of an image of integers: 1000 of one in millimetres."""

    def camera(self) -> PinholeCamera:
        """Return the camera."""
        return PinholeCamera(self.width, self.height, self.fx, self.fy, self.cx, self.cy)


def read_camera(path: Path) -> CameraFile:
    """Read and check a file.

    Raises:
        InputError: it is missing, no TOML, or lacks a key; a line for each fault.
    """
    if not os.path.lexists(path):
        raise InputError(
            f"{path}: missing; it says what the camera sees: {', '.join(CameraFile.model_fields)} "
            "(units a metre, as 1000 for millimetres; 5000 of the TUM benchmark). Another file may "
            "be named by --camera"
        )
    table = read_toml(path)
    try:
        return CameraFile.model_validate(table)
    except ValidationError as error:
        raise InputError("\n".join(faults(path, error, CameraFile))) from None
    except RecursionError:
        raise InputError(f"{path}: nested too deep") from None


def faults(path: Path, error: ValidationError, table: type[BaseModel]) -> list[str]:
    """Return a line for each fault of a file that holds one table without tables in it."""
    lines = []
    for fault in error.errors(include_url=False)[:20]:
        key = shortened(".".join(str(part) for part in fault["loc"][:1]))
        if fault["type"] == "missing":
            lines.append(f"{path}: {key}: missing, it is required")
        elif fault["type"] == "extra_forbidden":
            allowed = ", ".join(table.model_fields)
            lines.append(f"{path}: {key}: unknown key; allowed: {allowed}")
        else:
            text = fault["msg"].replace("Input should be", "must be")
            lines.append(f"{path}: {key}: found {shown(fault['input'])}; {text}")
    return lines
