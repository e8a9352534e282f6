"""Meshes and MJCF worlds from files that a scenario names: read with care, as plain pieces."""

from pathlib import Path

import mujoco
import numpy as np

from treadwell.course.height_field import FieldPiece, FieldTop, height_field
from treadwell.course.outlines import Floats
from treadwell.course.pieces import Piece, Top, about_z, level
from treadwell.mjcf.build import check_builds, compiled, mesh_spec, read_spec
from treadwell.mjcf.xml import check_xml
from treadwell.scenario.elements import Mesh


def mesh_piece(mesh: Mesh, folder: Path, what: str) -> tuple[Piece, Floats, Floats]:
    """Return a mesh's piece, and the vertices (n, 3) and faces (m, 3) of its visible shape.

    MuJoCo collides with the convex hull, so the piece is that. All is in the world frame.

    Raises:
        InputError: the file is broken.
    """
    path = (folder / mesh.file).resolve()
    check_builds(path, what)
    model = compiled(mesh_spec(path), what)
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, model.geom("mesh").quat)
    cosine, sine = np.cos(mesh.yaw), np.sin(mesh.yaw)
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    local = model.mesh_vert.astype(np.float64) @ rotation.reshape(3, 3).T + model.geom("mesh").pos
    vertices = local @ turn.T + np.array(mesh.position)
    hull = vertices
    if model.mesh_graphadr[0] >= 0:
        count = int(model.mesh_graph[0])
        hull = vertices[model.mesh_graph[2 + count : 2 + 2 * count]]
    piece = Piece("hull", "mesh", hull, np.zeros(3), np.zeros(3), about_z(0.0))
    return piece, vertices, model.mesh_face.copy()


def read_mjcf(folder: Path, file: str, what: str) -> mujoco.MjSpec:
    """Return an MJCF world's specification, without what is not a course's to say.

    Raises:
        InputError: it is broken, names files outside the folder, or could grow without bounds.
    """
    path = (folder / file).resolve()
    check_xml(path, folder.resolve(), what)
    check_builds(path, what)
    spec = read_spec(path, what)
    for items in (spec.keys, spec.actuators, spec.sensors, spec.cameras):
        for item in list(items):
            spec.delete(item)
    taken = {geom.name for geom in spec.geoms}
    for number, geom in enumerate(geom for geom in spec.geoms if not geom.name):
        # Found again by its name after it was attached.
        name = f"geom {number + 1}"
        geom.name = name if name not in taken else f"{name} of {len(taken)}"
    spec.memory = -1
    compiled(spec.copy(), what)
    return spec


def multiply(spec: mujoco.MjSpec, factor: float) -> None:
    """Multiply all lengths of an MJCF world, in place: places, sizes, meshes and height fields."""
    if factor == 1.0:
        return
    for items in (spec.bodies, spec.joints, spec.geoms, spec.sites, spec.lights, spec.frames):
        for item in items:
            item.pos = factor * np.asarray(item.pos)
    for items in (spec.geoms, spec.sites):
        for item in items:
            item.size = factor * np.asarray(item.size)
            item.fromto = factor * np.asarray(item.fromto)
    for mesh in spec.meshes:
        mesh.scale = factor * np.asarray(mesh.scale)
    for field in spec.hfields:
        field.size = factor * np.asarray(field.size)


def mjcf_pieces(
    model: mujoco.MjModel, data: mujoco.MjData, geom_ids: list[int]
) -> tuple[list[Piece], list[Top]]:
    """Return the pieces of an MJCF world's geoms, and the tops of upright boxes and height fields.

    What is tilted has no top.

    Args:
        model: the compiled course.
        data: after `mj_forward`.
        geom_ids: the world's geoms; each gives one piece: a box itself, another shape its box.
    """
    pieces: list[Piece] = []
    tops: list[Top] = []
    signs = np.array([[x, y, z] for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    for geom in geom_ids:
        rotation = data.geom_xmat[geom].reshape(3, 3)
        center = data.geom_xpos[geom] + rotation @ model.geom_aabb[geom, :3]
        size = model.geom_aabb[geom, 3:]
        vertices = center + (signs * size) @ rotation.T
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, data.geom_xmat[geom])
        name = model.geom(geom).name.rpartition("/")[2]
        upright = rotation[2, 2] > 0.9999
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_HFIELD and upright:
            field = height_field(model, data, geom)
            common = (name, vertices, center, size.copy(), quaternion)
            pieces.append(FieldPiece("hull", *common, field))
            outline = level(name, field.corners, float(field.heights.mean()))
            tops.append(FieldTop(name, outline.polygon, field))
            continue
        pieces.append(Piece("box", name, vertices, center, size.copy(), quaternion))
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_BOX and upright:
            tops.append(level(name, vertices[4:, :2], float(vertices[4, 2])))
    return pieces, tops
