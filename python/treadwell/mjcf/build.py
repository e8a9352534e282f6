"""MJCF files and meshes, read and compiled; a stranger's in a child process first."""

import hashlib
import warnings
from pathlib import Path

import mujoco
import numpy as np

from treadwell.errors import InputError
from treadwell.limited import limited

MESH_SUFFIXES = (".stl", ".obj")
URDF_SUFFIX = ".urdf"
MASSLESS = "; give that link an <inertial>, or a <geom> that has a mass"
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
        line = one_line(error)
        hint = MASSLESS if "mass and inertia" in line else ""
        raise InputError(f"{what}: MuJoCo cannot build it: {line}{hint}") from None
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
    spec = mesh_spec(Path(path)) if suffix in MESH_SUFFIXES else read_spec(Path(path), what)
    mujoco.MjData(compiled(spec, what))
    return True


def read_spec(path: Path, what: str) -> mujoco.MjSpec:
    """Return the specification of an MJCF or a URDF file.

    Of a URDF every link stays a link, and meshes are looked for by their names in its folder, too.

    Raises:
        InputError: MuJoCo cannot read it.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            spec = mujoco.MjSpec.from_file(str(path))
            if path.suffix.lower() == URDF_SUFFIX:
                _settle_urdf(spec, path.parent)
            return spec
    except (ValueError, RuntimeError, MemoryError) as error:
        raise InputError(f"{what}: MuJoCo cannot read it: {one_line(error)}") from None


def _settle_urdf(spec: mujoco.MjSpec, folder: Path) -> None:
    """Keep a URDF's root a link of its own, leave out what is only seen, and find its meshes."""
    spec.compiler.fusestatic = False
    spec.compiler.discardvisual = True
    meshes = list(spec.meshes)
    if not meshes:
        return
    found = {path.name: path for path in sorted(folder.rglob("*")) if path.is_file()}
    for mesh in meshes:
        # Whatever package or folder it says: nothing outside of this one is read.
        name = mesh.file.replace("\\", "/").rsplit("/", 1)[-1]
        mesh.file = str(found[name].resolve()) if name in found else name


def mesh_spec(path: Path) -> mujoco.MjSpec:
    """Return the specification of a world that is one mesh, hollow, and named `mesh`."""
    spec = mujoco.MjSpec()
    asset = spec.add_mesh(name="mesh", file=str(path))
    asset.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
    spec.worldbody.add_geom(name="mesh", type=mujoco.mjtGeom.mjGEOM_MESH, meshname="mesh")
    return spec
