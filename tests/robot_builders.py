"""Robots for tests: qrio as somebody else might have modelled it."""

import re
import shutil
from pathlib import Path

from treadwell.data import data_folder

STAND = """
[stand]
left_hip_pitch = -0.533155
left_knee_pitch = 1.03843
left_ankle_pitch = -0.505278
right_hip_pitch = -0.533155
right_knee_pitch = 1.03843
right_ankle_pitch = -0.505278
left_shoulder_pitch = 0.25
left_shoulder_roll = 0.08
left_elbow_pitch = -0.5
right_shoulder_pitch = 0.25
right_shoulder_roll = -0.08
right_elbow_pitch = -0.5

[ranges]
left_knee_pitch = [-0.05, 2.5]
neck_pan = [-1.6, 1.6]
"""
IMU = 'link = "torso"\nposition = [-0.01, 0.0, 0.05]\n'
MOUNT = '[camera.mount]\nlink = "head"\nposition = [0.038, 0.03, 0.025]\n'


def qrio_copy(folder: Path) -> Path:
    """A copy of qrio's folder, named qrio."""
    return Path(shutil.copytree(data_folder("models") / "qrio", folder / "qrio"))


def foreign_mjcf(text: str) -> str:
    """qrio's MJCF without what a model from elsewhere may not have, driven by MuJoCo's servos."""
    text = re.sub(r"<keyframe>.*</keyframe>", "", text, flags=re.DOTALL)
    text = re.sub(r"<sensor>.*</sensor>", "", text, flags=re.DOTALL)
    text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    text = re.sub(r"<camera [^>]*/>", "", text)
    text = text.replace('<site name="imu" class="mark" pos="-0.01 0 0.05"/>', "")
    text = text.replace('<freejoint name="base"/>', "<freejoint/>")
    text = text.replace('name="left_knee_pitch" class="leg_joint" axis="0 1 0" range="-0.05 2.5"',
                        'name="left_knee_pitch" class="leg_joint" axis="0 1 0"')  # fmt: skip
    text = re.sub(r'(<joint name="neck_pan"[^>]*) range="[^"]*"', r"\1", text)
    text = re.sub(r'<default class="\w+_motor">.*?</default>', "", text, flags=re.DOTALL)
    return re.sub(
        r'<motor name="(\w+)" joint="(\w+)" class="\w+"/>',
        r'<position name="\1" joint="\2" kp="20" forcerange="-5 5"/>',
        text,
    )


def foreign_toml(text: str) -> str:
    """qrio's robot.toml, which says what `foreign_mjcf` took out."""
    text = re.sub(r'\nforces = "\w+"', "", text)
    text = text.replace('site = "imu"\ngyro = "gyro"\naccelerometer = "accelerometer"\n', IMU)
    text = text.replace("[camera.stereo]", MOUNT + "[camera.stereo]")
    return text + STAND


def foreign_robot(folder: Path) -> Path:
    """A folder with the robot that the two texts above are."""
    robot = qrio_copy(folder)
    for file, change in (("qrio.xml", foreign_mjcf), ("robot.toml", foreign_toml)):
        path = robot / file
        path.write_text(change(path.read_text(encoding="utf-8")), encoding="utf-8")
    return robot
