"""MuJoCo's geoms as shapes of the recording: sizes once, poses in one batch a kind and frame."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_KINDS: Final = {
    int(mujoco.mjtGeom.mjGEOM_BOX): "boxes",
    int(mujoco.mjtGeom.mjGEOM_CAPSULE): "capsules",
    int(mujoco.mjtGeom.mjGEOM_CYLINDER): "cylinders",
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID): "ellipsoids",
    int(mujoco.mjtGeom.mjGEOM_SPHERE): "ellipsoids",
}
_ARCHETYPES: Final[dict[str, Any]] = {
    "boxes": rr.Boxes3D,
    "capsules": rr.Capsules3D,
    "cylinders": rr.Cylinders3D,
    "ellipsoids": rr.Ellipsoids3D,
}
_SURFACES: Final = (int(mujoco.mjtGeom.mjGEOM_MESH), int(mujoco.mjtGeom.mjGEOM_HFIELD))
"""What is drawn as triangles."""
_COLLISION_GROUP: Final = 3
"""Geoms of this group and above are for touching, not for looking at."""


@dataclass(frozen=True, slots=True, eq=False)
class Batch:
    """Geoms of one kind.

    Attributes:
        kind: boxes, capsules, cylinders or ellipsoids.
        geoms: ids.
        sizes: (n, 3) MuJoCo's `geom_size`, m; for a sphere three times its radius.
        colours: (n, 4) uint8.
    """

    kind: str
    geoms: NDArray[np.intp]
    sizes: Floats
    colours: NDArray[np.uint8]


class Shapes:
    """Some geoms of a model, to be drawn under one entity.

    Attributes:
        entity: its path.
        geoms: ids, in the order in which they are logged.
    """

    def __init__(
        self, model: mujoco.MjModel, geoms: NDArray[np.intp], entity: str, *, opacity: float = 1.0
    ) -> None:
        """Sort the geoms.

        Args:
            model: the compiled course.
            geoms: ids of those to draw; planes are left out.
            entity: path of the entity.
            opacity: 0 to 1, of all but meshes.
        """
        self.entity = entity
        types = np.asarray(model.geom_type)[geoms]
        self._batches: list[Batch] = []
        for kind in sorted(set(_KINDS.values())):
            ids = geoms[[_KINDS.get(int(t)) == kind for t in types]]
            if len(ids):
                sizes = np.array(model.geom_size)[ids]
                spheres = np.asarray(model.geom_type)[ids] == mujoco.mjtGeom.mjGEOM_SPHERE
                sizes[spheres] = sizes[spheres, :1]
                shades = colours(model, ids)
                shades[:, 3] = np.round(shades[:, 3] * opacity)
                self._batches.append(Batch(kind, ids, sizes, shades))
        self._meshes = [int(g) for g in geoms[np.isin(types, _SURFACES)]]
        self._model = model
        posed = [geom for batch in self._batches for geom in batch.geoms.tolist()]
        self.geoms = np.array([*posed, *self._meshes], dtype=np.intp)
        self._body = np.array(model.geom_bodyid)[self.geoms]
        self._local = np.array(model.geom_pos)[self.geoms], np.array(model.geom_quat)[self.geoms]

    def draw(self, stream: rr.RecordingStream) -> None:
        """Log what never changes: sizes and colours."""
        solid = rr.components.FillMode.Solid
        for batch in self._batches:
            size, shade = batch.sizes, batch.colours
            shape: rr.AsComponents
            if batch.kind == "boxes":
                shape = rr.Boxes3D.from_fields(half_sizes=size, colors=shade, fill_mode=solid)
            elif batch.kind == "ellipsoids":
                shape = rr.Ellipsoids3D.from_fields(half_sizes=size, colors=shade, fill_mode=solid)
            else:
                shape = _ARCHETYPES[batch.kind].from_fields(
                    lengths=2 * size[:, 1], radii=size[:, 0], colors=shade, fill_mode=solid
                )
            stream.log(f"{self.entity}/{batch.kind}", shape, static=True)
        for geom in self._meshes:
            stream.log(f"{self.entity}/mesh_{geom}", self._mesh(geom), static=True)

    def posed(
        self, positions: Floats, orientations: Floats
    ) -> Iterator[tuple[str, type[Any], dict[str, Floats]]]:
        """Yield where the geoms are: entity, rerun's archetype, its fields, (frames, n, ...) each.

        Args:
            positions: (frames, nbody, 3) of MuJoCo's bodies, m.
            orientations: (frames, nbody, 4) wxyz.
        """
        if not self.geoms.size:
            return
        places, turns = self._poses(positions, orientations)
        xyzw = turns[..., [1, 2, 3, 0]]
        end = 0
        for batch in self._batches:
            first, end = end, end + len(batch.geoms)
            name, centres = "centers", places[:, first:end]
            if batch.kind == "capsules":
                # A capsule of the recording begins at its pose; MuJoCo's lies around it.
                axes = rotated(turns[:, first:end], (0.0, 0.0, 1.0))
                name, centres = "translations", centres - batch.sizes[:, 1:2] * axes
            fields = {name: centres, "quaternions": xyzw[:, first:end]}
            yield f"{self.entity}/{batch.kind}", _ARCHETYPES[batch.kind], fields
        for i, geom in enumerate(self._meshes, start=end):
            fields = {"translations": places[:, i : i + 1], "quaternions": xyzw[:, i : i + 1]}
            yield f"{self.entity}/mesh_{geom}", rr.InstancePoses3D, fields

    def _poses(self, positions: Floats, orientations: Floats) -> tuple[Floats, Floats]:
        """Return world positions and quaternions wxyz of the geoms, (frames, n, ...), in order."""
        turn = orientations[:, self._body]
        place, local_turn = self._local
        return positions[:, self._body] + rotated(turn, place), multiplied(turn, local_turn)

    def _mesh(self, geom: int) -> rr.Mesh3D:
        model = self._model
        shade = colours(model, np.array([geom]))[0]
        mesh = int(model.geom_dataid[geom])
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_HFIELD:
            corners, triangles = field_triangles(model, mesh)
            return rr.Mesh3D(
                vertex_positions=corners, triangle_indices=triangles, albedo_factor=shade
            )
        vertex, face = int(model.mesh_vertadr[mesh]), int(model.mesh_faceadr[mesh])
        return rr.Mesh3D(
            vertex_positions=model.mesh_vert[vertex : vertex + int(model.mesh_vertnum[mesh])],
            triangle_indices=model.mesh_face[face : face + int(model.mesh_facenum[mesh])],
            albedo_factor=shade,
        )


def field_triangles(
    model: mujoco.MjModel, field: int
) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Return the surface of a height field: corners (n, 3) m, in its frame, and faces (m, 3).

    Each cell is cut from its first corner to the one opposite, as MuJoCo cuts it.
    """
    rows, columns = int(model.hfield_nrow[field]), int(model.hfield_ncol[field])
    begin = int(model.hfield_adr[field])
    along, across, top, _ = model.hfield_size[field]
    x, y = np.meshgrid(np.linspace(-along, along, columns), np.linspace(-across, across, rows))
    z = top * model.hfield_data[begin : begin + rows * columns]
    corners = np.column_stack([x.ravel(), y.ravel(), z]).astype(np.float32)
    numbers = np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)
    first, right = numbers[:-1, :-1].ravel(), numbers[:-1, 1:].ravel()
    left, last = numbers[1:, :-1].ravel(), numbers[1:, 1:].ravel()
    faces = np.concatenate(
        [np.column_stack([first, right, last]), np.column_stack([first, last, left])]
    )
    return corners, faces


def robot_geoms(model: mujoco.MjModel, root: str) -> NDArray[np.intp]:
    """Return the ids of a robot's visible geoms, all of them if none is marked as visible.

    Args:
        model: the compiled course.
        root: name of the robot's root link.
    """
    links = np.asarray(model.body_rootid)[np.asarray(model.geom_bodyid)] == model.body(root).id
    visible = links & (np.asarray(model.geom_group) < _COLLISION_GROUP)
    return np.flatnonzero(visible if visible.any() else links)


def colours(model: mujoco.MjModel, geoms: NDArray[np.intp]) -> NDArray[np.uint8]:
    """Return the geoms' colours by material or their own, (n, 4)."""
    rgba = np.array(model.geom_rgba)[geoms]
    material = np.asarray(model.geom_matid)[geoms]
    if model.nmat:
        has = material >= 0
        rgba[has] = np.asarray(model.mat_rgba)[material[has]]
    scaled: NDArray[np.uint8] = np.round(255 * np.clip(rgba, 0.0, 1.0)).astype(np.uint8)
    return scaled


def rotated(quaternions: Floats, vectors: Floats | tuple[float, float, float]) -> Floats:
    """Return vectors (..., 3) or (3,) turned by quaternions (..., 4) wxyz."""
    w, u = quaternions[..., :1], quaternions[..., 1:]
    v = np.broadcast_to(np.asarray(vectors, dtype=np.float64), u.shape)
    t = 2.0 * _cross(u, v)
    turned: Floats = v + w * t + _cross(u, t)
    return turned


def multiplied(first: Floats, second: Floats) -> Floats:
    """Return the quaternion products (..., 4) wxyz: the second turn comes first."""
    a, b = first, np.broadcast_to(second, first.shape)
    w = a[..., :1] * b[..., :1] - (a[..., 1:] * b[..., 1:]).sum(axis=-1, keepdims=True)
    v = a[..., :1] * b[..., 1:] + b[..., :1] * a[..., 1:] + _cross(a[..., 1:], b[..., 1:])
    product: Floats = np.concatenate([w, v], axis=-1)
    return product


def _cross(first: Floats, second: Floats) -> Floats:
    """Return the cross products (..., 3). For so few vectors `np.cross` takes ten times as long."""
    ahead, behind = [1, 2, 0], [2, 0, 1]
    product: Floats = (
        first[..., ahead] * second[..., behind] - first[..., behind] * second[..., ahead]
    )
    return product
