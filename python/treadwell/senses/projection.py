"""The core's depth camera for a model: what its rays meet, handed over once as plain arrays."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell import _core

# MuJoCo's own default of what is shown: groups 3 to 5 hold what only collides, and marks.
VISIBLE_GROUPS = np.array([1, 1, 1, 0, 0, 0], np.uint8)


def depth_camera(
    model: mujoco.MjModel, carrier: int, width: int, height: int, focal: float
) -> _core.DepthCamera:
    """Return a camera that sees a model's geoms of groups 0 to 2 with alpha above 0.

    Args:
        model: the compiled world with the robot.
        carrier: the body that carries the camera, whose own geoms it does not see.
        width: columns.
        height: rows.
        focal: focal length, pixels.
    """
    return _core.DepthCamera(
        model.geom_type,
        model.geom_size,
        seen_geoms(model, carrier),
        model.geom_dataid,
        [_mesh(model, mesh) for mesh in range(model.nmesh)],
        [_height_field(model, field) for field in range(model.nhfield)],
        width=width,
        height=height,
        focal=focal,
    )


def seen_geoms(model: mujoco.MjModel, carrier: int) -> NDArray[np.bool_]:
    """Return which geoms (n,) rays meet, as MuJoCo's rays do; arguments as for `depth_camera`."""
    groups = np.clip(model.geom_group, 0, len(VISIBLE_GROUPS) - 1)
    alpha = model.geom_rgba[:, 3].copy()
    painted = model.geom_matid >= 0
    alpha[painted] = model.mat_rgba[model.geom_matid[painted], 3]
    seen: NDArray[np.bool_] = VISIBLE_GROUPS[groups] != 0
    seen &= (alpha != 0.0) & (model.geom_bodyid != carrier)
    return seen


def _mesh(model: mujoco.MjModel, mesh: int) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Return a mesh's vertices, (n, 3) m, and faces, (m, 3), in the frame of its geoms."""
    vertex, face = model.mesh_vertadr[mesh], model.mesh_faceadr[mesh]
    vertices = model.mesh_vert[vertex : vertex + model.mesh_vertnum[mesh]]
    return vertices, model.mesh_face[face : face + model.mesh_facenum[mesh]]


def _height_field(
    model: mujoco.MjModel, field: int
) -> tuple[NDArray[np.float32], tuple[float, float, float, float]]:
    """Return a height field's heights, (rows, columns), and its sizes, m."""
    rows, columns = int(model.hfield_nrow[field]), int(model.hfield_ncol[field])
    begin = int(model.hfield_adr[field])
    heights = model.hfield_data[begin : begin + rows * columns].reshape(rows, columns)
    along, across, top, base = (float(size) for size in model.hfield_size[field])
    return heights, (along, across, top, base)
