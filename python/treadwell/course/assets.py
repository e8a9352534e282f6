"""Meshes and MJCF worlds from files that a scenario names: read with care, as plain pieces."""

import hashlib
import warnings
from pathlib import Path

import mujoco
import numpy as np

from treadwell.course.outlines import Floats
from treadwell.course.pieces import Piece, Top, about_z, level
from treadwell.course.xml import check_xml
from treadwell.errors import InputError
from treadwell.limited import limited
from treadwell.scenario.elements import Mesh

MESH_SUFFIXES = (".stl", ".obj")
MOST_BESIDE = 2000
"""Files of a folder that are looked at."""


def one_line(error: Exception) -> str:
    """Return an error's text on one short line."""
    return " ".join(str(error).split())[:300]


def compiled(spec: mujoco.MjSpec, what: str) -> mujoco.MjModel:
    """Compile a specification.

    Raises:
        InputError: MuJoCo refuses it, or a size or mass in it is not finite.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            model = spec.compile()
    except (ValueError, RuntimeError, MemoryError) as error:
        raise InputError(f"{what}: MuJoCo cannot build it: {one_line(error)}") from None
    check_finite(model, what)
    return model


def check_finite(model: mujoco.MjModel, what: str) -> None:
    """Refuse a model with a number that is none.

    Raises:
        InputError: NaN or infinity is in it; names the field.
    """
    for owner in (model, model.opt, model.stat):
        for field in dir(owner):
            value = None if field.startswith("_") else getattr(owner, field)
            if isinstance(value, np.ndarray | float):
                numbers = np.asarray(value)
                if numbers.dtype.kind == "f" and not np.isfinite(numbers).all():
                    raise InputError(f"{what}: a number is not finite ({field})")


def check_builds(path: Path, what: str) -> None:
    """Let a child process with limits build what a stranger's file holds, once for each content.

    Args:
        path: an MJCF file, or a mesh.
        what: begins the message.

    Raises:
        InputError: it cannot be built, or not within the limits.
    """
    key = _content_key(path)
    if key not in _BUILT:
        limited(build_files, [str(path), what], what)
        _BUILT.add(key)


_BUILT: set[str] = set()
"""Contents of folders of files that were built within the limits."""


def _content_key(path: Path) -> str:
    """Return a hash of a file, and of all beside it by name, size and time."""
    digest = hashlib.sha256(str(path).encode())
    beside = sorted(p for p in path.parent.rglob("*") if p.is_file())
    for other in beside[:MOST_BESIDE]:
        stat = other.stat()
        digest.update(f"{other}\0{stat.st_size}\0{stat.st_mtime_ns}\0".encode())
    return digest.hexdigest()


def build_files(path: str, what: str) -> bool:
    """Build an MJCF file or a mesh alone, and allocate its state: what a child process does.

    Raises:
        InputError: MuJoCo cannot, or a number is not finite.
    """
    suffix = Path(path).suffix.lower()
    spec = _mesh_spec(Path(path)) if suffix in MESH_SUFFIXES else read_spec(Path(path), what)
    mujoco.MjData(compiled(spec, what))
    return True


def read_spec(path: Path, what: str) -> mujoco.MjSpec:
    """Return the specification of an MJCF file.

    Raises:
        InputError: MuJoCo cannot read it.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return mujoco.MjSpec.from_file(str(path))
    except (ValueError, RuntimeError, MemoryError) as error:
        raise InputError(f"{what}: MuJoCo cannot read it: {one_line(error)}") from None


def _mesh_spec(path: Path) -> mujoco.MjSpec:
    spec = mujoco.MjSpec()
    asset = spec.add_mesh(name="mesh", file=str(path))
    asset.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
    spec.worldbody.add_geom(name="mesh", type=mujoco.mjtGeom.mjGEOM_MESH, meshname="mesh")
    return spec


def mesh_piece(mesh: Mesh, folder: Path, what: str) -> tuple[Piece, Floats, Floats]:
    """Return a mesh's piece, and the vertices (n, 3) and faces (m, 3) of its visible shape.

    MuJoCo collides with the convex hull, so the piece is that. All is in the world frame.

    Raises:
        InputError: the file is broken.
    """
    path = (folder / mesh.file).resolve()
    check_builds(path, what)
    model = compiled(_mesh_spec(path), what)
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


def mjcf_pieces(
    model: mujoco.MjModel, data: mujoco.MjData, geom_ids: list[int]
) -> tuple[list[Piece], list[Top]]:
    """Return the pieces of an MJCF world's geoms and the tops of its upright boxes.

    Args:
        model: the compiled course.
        data: after `mj_forward`.
        geom_ids: the world's geoms; each gives one piece: a box itself, another shape its box.
    """
    pieces, tops = [], []
    signs = np.array([[x, y, z] for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    for geom in geom_ids:
        rotation = data.geom_xmat[geom].reshape(3, 3)
        center = data.geom_xpos[geom] + rotation @ model.geom_aabb[geom, :3]
        size = model.geom_aabb[geom, 3:]
        vertices = center + (signs * size) @ rotation.T
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, data.geom_xmat[geom])
        name = model.geom(geom).name.rpartition("/")[2]
        pieces.append(Piece("box", name, vertices, center, size.copy(), quaternion))
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_BOX and rotation[2, 2] > 0.9999:
            tops.append(level(name, vertices[4:, :2], float(vertices[4, 2])))
    return pieces, tops
