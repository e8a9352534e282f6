"""What lies in a camera's picture: MuJoCo's rays are spared the rest."""

from collections.abc import Iterator
from contextlib import contextmanager

import mujoco
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# MuJoCo's own default of what is shown: groups 3 to 5 hold what only collides, and marks.
VISIBLE_GROUPS = np.array([1, 1, 1, 0, 0, 0], np.uint8)
HIDDEN_GROUP = 5
# What misses the picture by less is looked for all the same, metres.
VIEW_MARGIN = 1e-3


class View:
    """Hides from rays what they cannot meet.

    For every ray MuJoCo looks at every body and then at the body's geoms. Most of them lie beside
    the picture: those geoms are hidden, and a body without others is said to have none.
    """

    def __init__(self, model: mujoco.MjModel, borders: Floats) -> None:
        """Prepare the boxes around the geoms.

        Args:
            model: the compiled world.
            borders: (3, 4) unit normals inwards of the planes through the outermost rays, optical.
        """
        self._model = model
        self._borders = borders
        # Planes have no box around them: they reach everywhere.
        self._endless = model.geom_rbound <= 0.0
        self._box_centre = np.repeat(model.geom_aabb[:, :3].T, 4, axis=0)
        self._box_half = np.repeat(model.geom_aabb[:, 3:].T, 4, axis=0)
        # What turns rotations (9, n) into their axes' components along the borders, (3 * 4, n).
        self._components = np.zeros((12, 9))
        self._borders_in_it = np.einsum("abia->aib", self._components.reshape(3, 4, 3, 3))

    def beside(self, data: mujoco.MjData, position: Floats, rotation: Floats) -> NDArray[np.bool_]:
        """Return which geoms (n,) no ray can meet, by the boxes around them.

        Args:
            data: the state, with all poses up to date.
            position: (3,) the camera's.
            rotation: (3, 3) world from optical frame.
        """
        inwards = rotation @ self._borders
        self._borders_in_it[:] = inwards
        along = self._components @ data.geom_xmat.T
        reach = np.abs(along) * self._box_half
        reach += along * self._box_centre
        inside = inwards.T @ (data.geom_xpos - position).T
        inside += reach[:4] + reach[4:8] + reach[8:]
        beside: NDArray[np.bool_] = inside.min(axis=0) < -VIEW_MARGIN
        beside[self._endless] = False
        return beside

    @contextmanager
    def alone(self, data: mujoco.MjData, position: Floats, rotation: Floats) -> Iterator[None]:
        """Let rays look at nothing else while this is open; arguments as for `beside`."""
        model = self._model
        groups, counts, trees = model.geom_group, model.body_geomnum, model.body_bvhadr
        before = groups.copy(), counts.copy(), trees.copy()
        groups[self.beside(data, position, rotation)] = HIDDEN_GROUP
        empty = np.ones(model.nbody, np.bool_)
        empty[model.geom_bodyid[VISIBLE_GROUPS[groups] != 0]] = False
        counts[empty], trees[empty] = 0, -1
        try:
            yield
        finally:
            groups[:], counts[:], trees[:] = before
