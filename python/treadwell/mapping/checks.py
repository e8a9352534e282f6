"""What the library takes: arrays of any type and stride, poses, settings."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import ValidationError

from treadwell.errors import InputError
from treadwell.plugins import check_component, load_component
from treadwell.scenario.messages import describe_in, report
from treadwell.scenario.model import Navigation
from treadwell.scenario.overrides import Overrides, assign, read_overrides
from treadwell.sources.depth_image import FARTHEST_DEPTH_M, lies_beyond
from treadwell.sources.frame import Floats, PinholeCamera

_FARTHEST_M: Final = 10_000.0
"""Depths beyond this are no metres."""
_SQUARE_WITHIN: Final = 1e-3
"""How far the columns of a rotation may be off being of length one, and square to each other."""


def depth_picture(depth: ArrayLike, camera: PinholeCamera) -> NDArray[np.float32]:
    """Return depths as the core takes them, (h, w) m, NaN where nothing was seen.

    Args:
        depth: (h, w) m along the optical axis, of any float type and stride; NaN, 0, negative or
            infinite where nothing was seen.
        camera: whose picture it is.

    Raises:
        InputError: it is no picture of that camera.
    """
    return checked_depth(depth, (camera.height, camera.width))


def checked_depth(depth: ArrayLike, expected: tuple[int, int]) -> NDArray[np.float32]:
    """Return depths as the core takes them: as `depth_picture` does, for rows and columns.

    Raises:
        InputError: they are no picture of that size, or no metres.
    """
    given = np.asarray(depth)
    integers = given.dtype.kind in "iu"
    if given.dtype.kind != "f" or given.shape != expected:
        raise InputError(
            f"depth must be floats {expected} (rows, columns of the camera), in metres; got "
            f"{given.dtype} {given.shape}"
            + (": divide by its units a metre, 1000 for millimetres" if integers else "")
        )
    seen = np.isfinite(given) & (given > 0)
    farthest = given.max(where=seen, initial=0.0)
    if farthest > _FARTHEST_M:
        raise InputError(f"depth must be metres, at most {_FARTHEST_M:g}; got {farthest:g}")
    metres = np.ascontiguousarray(np.where(seen, given, np.nan), np.float32)
    if lies_beyond(metres, int(np.count_nonzero(seen))):
        raise InputError(
            f"depth must be metres, but half of the picture lies beyond {FARTHEST_DEPTH_M:g}, its "
            f"median at {float(np.nanmedian(metres)):.4g}, farther than a depth camera sees: "
            "divide by its units a metre, 1000 for millimetres"
        )
    return metres


def cloud_points(points: ArrayLike) -> NDArray[np.float32]:
    """Return points as the core takes them, (n, 3) m.

    Raises:
        InputError: they are none.
    """
    given = np.asarray(points)
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in "fiu":
        raise InputError(f"points must be numbers (n, 3), got {given.dtype} {given.shape}")
    return np.ascontiguousarray(given, np.float32)


def pose_matrix(pose: ArrayLike, name: str) -> Floats:
    """Return a pose as (4, 4) float64.

    Raises:
        InputError: it is no rigid motion.
    """
    given = np.asarray(pose)
    if given.shape != (4, 4) or given.dtype.kind not in "fiu" or not np.isfinite(given).all():
        raise InputError(f"{name} must be a finite (4, 4) matrix, got {given.dtype} {given.shape}")
    matrix = np.ascontiguousarray(given, np.float64)
    turn = matrix[:3, :3]
    square = np.abs(turn.T @ turn - np.eye(3)).max() < _SQUARE_WITHIN
    if not square or np.linalg.det(turn) < 0.0 or not np.allclose(matrix[3], [0, 0, 0, 1]):
        raise InputError(
            f"{name} must be a rotation and a translation, with 0 0 0 1 as its last row, "
            f"got {np.array2string(matrix, precision=4, separator=' ').replace(chr(10), '')}"
        )
    return matrix


def finite_numbers(name: str, numbers: Sequence[float], count: int) -> tuple[float, ...]:
    """Return numbers of which there must be so many.

    Raises:
        InputError: there are not, or one is not finite.
    """
    try:
        found = tuple(float(number) for number in numbers)
    except (TypeError, ValueError):
        found = ()
    if len(found) != count or not all(map(math.isfinite, found)):
        raise InputError(f"{name} must be {count} finite numbers, got {numbers!r}")
    return found


def positive(name: str, value: float) -> float:
    """Return a number that must be > 0.

    Raises:
        InputError: it is not.
    """
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(f"{name} must be finite and > 0, got {value!r}")
    return float(value)


def raw_tables(overrides: Overrides) -> dict[str, Any]:
    """Return overrides as tables within tables, as a scenario's `[navigation]` has them.

    Args:
        overrides: `{"fog.cell": 0.02}`, `{"fog": {"cell": 0.02}}` or `["fog.cell=0.02"]`; a key may
            begin with `navigation.`.

    Raises:
        InputError: a key that cannot be.
    """
    raw: dict[str, Any] = {}
    for key, value in read_overrides(overrides):
        assign(raw, key.removeprefix("navigation."), value)
    return raw


def checked_tables(raw: Mapping[str, Any]) -> dict[str, Any]:
    """Return tables within tables as checked parameters of `[navigation]`; names of parts apart.

    Raises:
        InputError: an unknown part or table, or a value that cannot be; with the nearest spelling.
    """
    try:
        return Navigation.model_validate(raw).parameters()
    except ValidationError as error:
        details = error.errors(include_url=False)
        lines = [describe_in("navigation", Navigation, detail, raw) for detail in details]
        raise InputError(report("mapping", list(dict.fromkeys(lines)))) from None


def own_part(
    slot: str, given: str | type | object, raw: dict[str, Any]
) -> tuple[object | None, str]:
    """Return a part of the user's, None where it is one of the list; and its name.

    Args:
        slot: which component it is to be.
        given: a name of the list, `package.module:Class`, a class, or an object.
        raw: overrides; the table of the class's name is taken out, for it.

    Raises:
        InputError: it cannot be made, or lacks a method of its protocol.
    """
    if isinstance(given, str) and ":" not in given:
        return None, given
    named = given.rpartition(":")[2] if isinstance(given, str) else None
    kind = given if isinstance(given, type) else type(given)
    name = named or kind.__name__
    parameters = raw.pop(name, {})
    if isinstance(given, str):
        return load_component(slot, given, parameters), name
    if isinstance(given, type):
        try:
            given = given(**parameters)
        except Exception as error:
            raise InputError(f"{slot}: cannot make {name}: {error!r}") from error
    check_component(slot, given)
    return given, name
