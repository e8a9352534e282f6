"""The file of a robot's folder that holds its model: which one it is, and how it is compiled."""

from pathlib import Path

import mujoco

from treadwell.errors import InputError
from treadwell.mjcf.build import compiled
from treadwell.robot.load import robot_spec
from treadwell.robot.loops import drivers
from treadwell.robot.model_gaps import fill_gaps
from treadwell.scenario.loading import read_toml
from treadwell.scenario.messages import nearest

PATTERNS = ("*.xml", "*.urdf")
MOST_FILES = 20
"""Files of a folder that are looked into to see which one is the robot."""


def models_in(folder: Path) -> list[str]:
    """Return the names of a folder's files that may hold a model, in alphabetical order."""
    return sorted(path.name for pattern in PATTERNS for path in folder.glob(pattern))


def find_model(folder: Path, name: str | None = None) -> Path:
    """Return the model's file: the one named, that `robot.toml` names, or else what is the robot.

    Of several files those count that hold a robot on a free root and no floor; first those with
    motors, then those with a short name: not the scene around it, nor a variant of it.

    Args:
        folder: the robot's.
        name: of the file.

    Raises:
        InputError: there is none, or no telling which.
    """
    if name is not None:
        there = models_in(folder)
        if Path(name).name not in there or Path(name).parent not in (Path(), folder):
            raise InputError(
                f"{folder / name}: there is no such model in {folder}; "
                f"there {'is' if len(there) == 1 else 'are'} {', '.join(there) or 'none'}"
                f"{nearest(name, there)}"
            )
        return folder / Path(name).name
    try:
        told = read_toml(folder / "robot.toml")["robot"]["model"]
        if isinstance(told, str) and (folder / Path(told).name).is_file():
            return folder / Path(told).name
    except (OSError, ValueError, KeyError, TypeError, InputError):
        pass  # whoever reads the file for what it says tells what is wrong with it
    files = [folder / each for each in models_in(folder)]
    same = [file for file in files if file.stem == folder.resolve().name]
    if len(files) == 1 or same:
        return (same or files)[0]
    if files:
        robots = sorted(filter(None, (_rank(file) for file in files[:MOST_FILES])))
        if robots:
            return folder / robots[0][-1]
    if not files:
        raise InputError(
            f"{folder}: has no MJCF (*.xml) or URDF; name the robot's "
            f"{folder.resolve().name}.xml, or say [robot] model = in a robot.toml"
        )
    raise InputError(
        f"{folder}: has {len(files)} MJCF files, of which none is a robot on a free root without "
        f"a floor ({', '.join(file.name for file in files[:MOST_FILES])}); "
        f"name the robot's {folder.resolve().name}.xml, or say [robot] model = in a robot.toml"
    )


def _rank(file: Path) -> tuple[bool, int, str] | None:
    """Return what a file is sorted by: motors, then its name; None where it holds no robot."""
    try:
        spec = robot_spec(file.parent, file)
        floors = [geom for geom in spec.worldbody.geoms if geom.type == mujoco.mjtGeom.mjGEOM_PLANE]
        if floors:
            return None
        fill_gaps(spec)
        model = compiled(spec, str(file))
    except InputError:
        return None
    if model.njnt < 2 or model.jnt_type[0] != mujoco.mjtJoint.mjJNT_FREE:
        return None
    has_motors = model.nu > 0 and bool(drivers(model))
    return (not has_motors, len(file.name), file.name)


def compile_alone(file: Path) -> mujoco.MjModel:
    """Compile a model as it is, but for the world around it.

    Raises:
        InputError: MuJoCo cannot.
    """
    spec = robot_spec(file.parent, file)
    fill_gaps(spec)
    return compiled(spec, str(file))
