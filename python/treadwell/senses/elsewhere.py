"""Geoms of types that the core does not draw: MuJoCo casts rays at them."""

import logging
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.senses.projection import VISIBLE_GROUPS

Floats = NDArray[np.float64]

HIDDEN_GROUP = 5
# Geoms that are wholly farther are not looked for, metres.
FAR = 20.0


class CastElsewhere:
    """Casts a ray through every pixel at a few geoms, and says so once."""

    def __init__(
        self,
        model: mujoco.MjModel,
        geoms: Sequence[int],
        directions: Floats,
        shape: tuple[int, int],
    ) -> None:
        """Say which geoms they are.

        Args:
            model: the compiled world with the robot.
            geoms: their ids.
            directions: (h * w, 3) the rays in the optical frame, each with z = 1.
            shape: the picture's rows and columns.
        """
        self._model = model
        self._groups = np.full(model.ngeom, HIDDEN_GROUP, model.geom_group.dtype)
        self._groups[list(geoms)] = 0
        self._lengths = np.linalg.norm(directions, axis=1)
        self._directions = directions / self._lengths[:, None]
        self._shape = shape
        names = [model.geom(geom).name or f"number {geom}" for geom in geoms]
        kinds = {mujoco.mjtGeom(int(model.geom_type[geom])).name for geom in geoms}
        logging.getLogger(__name__).warning(
            "MuJoCo casts the depth camera's rays, slowly, at geoms of type %s: %s",
            ", ".join(sorted(kinds)),
            ", ".join(names),
        )

    def cast(
        self, data: mujoco.MjData, position: Floats, rotation: Floats
    ) -> tuple[Floats, NDArray[np.int32]]:
        """Return depth (h, w) m along the axis, NaN for none, and geom (h, w), -1 for none.

        Args:
            data: the state, with all poses up to date.
            position: (3,) the camera's.
            rotation: (3, 3) world from optical frame.
        """
        count = len(self._directions)
        distance, geom = np.empty(count), np.empty(count, np.int32)
        before = self._model.geom_group.copy()
        self._model.geom_group[:] = self._groups
        try:
            # A distance field's rays are as long as the room that they march through: unit ones.
            mujoco.mj_multiRay(
                self._model,
                data,
                position,
                (self._directions @ rotation.T).reshape(-1),
                VISIBLE_GROUPS,
                True,
                -1,
                geom,
                distance,
                None,
                count,
                FAR,
            )
        finally:
            self._model.geom_group[:] = before
        depth = np.where(geom < 0, np.nan, distance / self._lengths)
        return depth.reshape(self._shape), geom.reshape(self._shape)
