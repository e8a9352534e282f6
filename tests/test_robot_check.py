"""Claims about what is refused: a robot.toml and an MJCF that do not fit each other."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from treadwell.data import data_folder
from treadwell.errors import InputError
from treadwell.robot.load import load_robot

Edit = Callable[[str, str, str], Path]


@pytest.fixture
def edited(tmp_path: Path) -> Edit:
    """A copy of qrio's folder in which one file had a text replaced."""

    def edit(file: str, old: str, new: str) -> Path:
        folder = tmp_path / "robot"
        if not folder.exists():
            shutil.copytree(data_folder("models") / "qrio", folder)
        text = (folder / file).read_text(encoding="utf-8")
        assert old in text
        (folder / file).write_text(text.replace(old, new), encoding="utf-8")
        return folder

    return edit


@pytest.mark.parametrize("file", ["robot.toml", "qrio.xml"])
def test_a_missing_file_is_named(edited: Edit, file: str) -> None:
    folder = edited("robot.toml", "qrio", "qrio")
    (folder / file).unlink()
    with pytest.raises(InputError, match=file):
        load_robot(folder)


BROKEN = [
    ("qrio.xml", "<worldbody>", "<worldbod>", r"qrio\.xml"),
    ("qrio.xml", 'mass="2.1"', 'mass="nan"', r"qrio\.xml"),
    ("qrio.xml", 'mass="2.1"', 'mass="-1"', r"qrio\.xml"),
    ("qrio.xml", 'timestep="0.002"', 'timestep="0"', "timestep must be > 0, got 0|time ?step"),
    ("qrio.xml", 'name="stand"', 'name="sit"', "no keyframe 'stand'"),
    ("qrio.xml", ' range="-0.05 2.5"', "", "'left_knee_pitch' needs a range"),
    ("qrio.xml", ' range="-0.05 2.5"', ' range="1.2 2.5"', "keyframe 'stand'.*'left_knee_pitch'"),
    ("qrio.xml", '<freejoint name="base"/>', "", "invalid qpos size"),
    (
        "qrio.xml",
        '<motor ctrlrange="-1 1"/>',
        '<motor ctrlrange="-2 2"/>',
        "motors.neck.*ctrlrange",
    ),
    (
        "robot.toml",
        '"waist_yaw", "waist_pitch"',
        '"waist_yaw", "waist"',
        "no joint 'waist'.*waist_p",
    ),
    ("robot.toml", '["neck_pan", "neck_tilt"]', '["neck_pan"]', "no group has.*neck_tilt"),
    ("robot.toml", '["neck_pan", "neck_tilt"]', '["neck_pan", "neck_tilt", "waist_yaw"]', "too"),
    (
        "robot.toml",
        '"left_knee_pitch", "left_ankle',
        '"right_knee_pitch", "left_ankle',
        "chain from the hip",
    ),
    (
        "robot.toml",
        '"left_hip_yaw", "left_hip_roll", "left_hip_pitch", "left_knee_pitch", "left_ankle',
        '"left_hip_pitch", "left_knee_pitch", "left_ankle',
        r"legs\.left\.joints",
    ),
    (
        "robot.toml",
        'link = "left_foot"',
        'link = "left_ankle"',
        r"legs\.left\.sole\.link.*'left_foot'",
    ),
    ("robot.toml", "[0.0, 0.0, -0.045]", "[0.0, 0.0, -0.04]", r"legs\.left\.sole.*5\.0 mm"),
    ("robot.toml", 'name = "camera"', 'name = "webcam"', r"camera\.name.*'webcam'.*has camera"),
    ("robot.toml", "horizontal_fov = 0.8203", "horizontal_fov = 1.2", "square"),
    (
        "robot.toml",
        'pan = "neck_pan"',
        'pan = "left_hip_yaw"',
        "head.pan.*does not move the camera",
    ),
    (
        "robot.toml",
        'forces = "left_sole_forces"',
        'forces = "gyro"',
        "legs.left.forces.*must be a <contact>",
    ),
    (
        "qrio.xml",
        'reduce="netforce" data="force pos"',
        'reduce="netforce" data="force"',
        "legs.left.forces.*must have num 1 and data 'force pos'",
    ),
    ("robot.toml", 'gyro = "gyro"', 'gyro = "accelerometer"', "imu.gyro.*must be a <gyro>"),
    (
        "robot.toml",
        "left_elbow_pitch = -0.5",
        "left_elbow_pitch = 0.5",
        "arms.rest.left_elbow_pitch",
    ),
    ("robot.toml", 'torso = "torso"', 'torso = "chest"', "body.torso.*no link 'chest'.*pelvis"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("file", "old", "new", "message"), BROKEN)
def test_a_broken_folder_is_refused_with_file_and_key(
    edited: Edit, file: str, old: str, new: str, message: str
) -> None:
    folder = edited(file, old, new)
    with pytest.raises(InputError, match=message) as error:
        load_robot(folder)
    assert str(folder) in str(error.value)
