"""A draft of a `robot.toml` for a folder that has none."""

from pathlib import Path

import mujoco

from treadwell.errors import InputError
from treadwell.files import write_text
from treadwell.robot.anatomy import Anatomy
from treadwell.robot.draft import Draft
from treadwell.robot.leg_faults import leg_faults
from treadwell.robot.model_file import compile_alone, find_model


def write_template(folder: Path, model: str | None = None) -> Path:
    """Write a draft of `robot.toml` into a folder that has none.

    Args:
        folder: with an MJCF or a URDF.
        model: name of its file; default: the one that is found.

    Raises:
        InputError: there is one, no MJCF, no two legs, or the folder cannot be written to.
    """
    path = folder / "robot.toml"
    if path.exists():
        raise InputError(f"{path}: is there already; a draft does not go over it")
    if not folder.is_dir():
        raise InputError(f"{folder}: there is no such folder")
    file = find_model(folder, model)
    text = draft(folder.resolve().name, file.name, compile_alone(file))
    try:
        write_text(path, text)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error
    return path


def draft(name: str, mjcf: str, model: mujoco.MjModel) -> str:
    """Return a draft of a `robot.toml`.

    Args:
        name: the robot's.
        mjcf: name of the model's file.
        model: compiled from it.

    Raises:
        InputError: the model has no two legs of five to seven hinges; a line for each reason.
    """
    anatomy = Anatomy.of(model)
    faults = leg_faults(anatomy)
    if faults:
        raise InputError("\n".join(f"{mjcf}: {fault}" for fault in faults))
    return Draft(name, mjcf, anatomy, anatomy.legs()).text()
