"""Where a depth camera is in a map of one's own."""

import json
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from treadwell import _core
from treadwell.errors import InputError
from treadwell.mapping.camera import Camera
from treadwell.mapping.checks import checked_depth

Floats = NDArray[np.float64]

_ROUND: Final = 1e-3
"""How far rows of a rotation may be from unit vectors at right angles."""
_MOST_SEED: Final = 2**53
_STRUCTURED_LIGHT: Final = 1.5e-3
"""1/m: how ranges of structured light err at a metre (Khoshelham and Elberink 2012: 1.4 mm)."""


class Spread(NamedTuple):
    """How sure a pose is.

    Attributes:
        place: standard deviation of the place along its least certain level direction, m; infinite
            while nothing tells where the camera may be.
        heading: standard deviation of the heading, rad.
        lost: whether the pose is not to be acted on: several places fit, or none does any more.
    """

    place: float
    heading: float
    lost: bool


class MonteCarlo:
    """Follows a depth camera through a known map, or finds it there: Monte Carlo localization.

    After Maier, Hornung and Bennewitz 2012, in six dimensions and without a robot: nothing feels
    which way is down, so that the beams correct roll and pitch with the place.

    >>> camera = Camera(width=640, height=480, fx=525.0, fy=525.0, cx=319.5, cy=239.5)
    >>> where = MonteCarlo("house.bt", camera, start=start)            # doctest: +SKIP
    >>> for depth, previous_from_current in frames:                    # doctest: +SKIP
    ...     pose, spread = where.update(depth, previous_from_current)
    """

    def __init__(
        self,
        file: str | PathLike[str],
        camera: Camera,
        start: ArrayLike | None = None,
        seed: int = 0,
        overrides: Mapping[str, Any] | None = None,
    ) -> None:
        """Read the map.

        Args:
            file: an OctoMap file, `.bt` or `.ot`, z upward, metres.
            camera: the camera that takes the pictures.
            start: (4, 4) map from camera at the first picture, the optical axis along z. None: the
                camera is anywhere on a floor of the map; it is found while it looks around, and
                the first picture that shows floor tells how it is held.
            seed: of all that is drawn. The same calls with the same seed give the same poses.
            overrides: settings of `[navigation.monte_carlo]`, as in
                `{"range_model": "likelihood_field"}`, and under the key `static_map` those of
                `[navigation.static_map]`, as in `{"static_map": {"surfaces": "faces"}}`. Without
                `range_noise_growth` the camera is taken for one of structured light, whose ranges
                err by 1.5 mm at a metre and more with the square of the distance; a narrow stereo
                camera errs several times as much.

        Raises:
            InputError: the file cannot be read, or an argument cannot be used; it is named.
        """
        if not 0 <= seed < _MOST_SEED:
            raise InputError(f"seed: found {seed!r}; a whole number from 0 to 2^53 is needed")
        given = dict(overrides or {})
        static_map = given.pop("static_map", {})
        of_camera = {"seed": seed, "range_noise_growth": _STRUCTURED_LIGHT}
        tables = {"monte_carlo": {**of_camera, **given}, "static_map": static_map}
        try:
            settings = json.dumps(tables, allow_nan=False)
        except (TypeError, ValueError) as error:
            raise InputError(f"overrides: found {overrides!r}; {error}") from None
        self._file = path = Path(file)
        tree = _core.Octree.read(str(path))
        self._size = (int(camera.height), int(camera.width))
        try:
            self._core = _core.MonteCarlo(
                tree,
                size=(int(camera.width), int(camera.height)),
                focal=(float(camera.fx), float(camera.fy)),
                centre=(float(camera.cx), float(camera.cy)),
                start=None if start is None else _pose("start", start),
                settings=settings,
            )
        except InputError as error:
            raise InputError(f"{path}: {error}") from None

    def __repr__(self) -> str:
        return f"<MonteCarlo in {self._file}>"

    def update(self, depth: ArrayLike, previous_from_current: ArrayLike) -> tuple[Floats, Spread]:
        """Take in a picture.

        Args:
            depth: (h, w) metres along the optical axis, of any float type and stride; NaN or 0
                where nothing was seen.
            previous_from_current: (4, 4) how the camera moved since the last picture, as odometry
                says: the current camera in the frame of the previous one. At the first picture,
                how it moved since `start`: the identity, as a rule.

        Returns:
            pose: (4, 4) map from camera, the optical axis along z. Without a start, all NaN until
                a picture has shown a floor.
            spread: how sure it is.

        Raises:
            InputError: the picture has another size than the camera's or no metres, or the motion
                is no rigid one.
        """
        picture = checked_depth(depth, self._size)
        found = self._core.update(picture, _pose("previous_from_current", previous_from_current))
        if found is None:
            return np.full((4, 4), np.nan), Spread(np.inf, np.inf, lost=True)
        pose, place, heading, lost = found
        return pose, Spread(place, heading, lost)


def _pose(name: str, given: ArrayLike) -> Floats:
    """Return a rigid motion as the core takes it."""
    pose = np.ascontiguousarray(given, dtype=np.float64)
    if pose.shape != (4, 4) or not np.isfinite(pose).all():
        raise InputError(f"{name}: found {pose.shape}; a finite (4, 4) matrix is needed")
    turn = pose[:3, :3]
    if (
        np.abs(turn @ turn.T - np.eye(3)).max() > _ROUND
        or np.linalg.det(turn) < 0.0
        or np.abs(pose[3] - (0.0, 0.0, 0.0, 1.0)).max() > _ROUND
    ):
        raise InputError(f"{name}: found a matrix that is no rotation and translation")
    return pose
