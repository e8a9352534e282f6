"""Claims about joints without a motor of their own: which ties are taken and which refused."""

from collections.abc import Callable
from pathlib import Path

import pytest

from treadwell.data import data_folder
from treadwell.errors import InputError
from treadwell.robot.followers import followers
from treadwell.robot.load import load_robot

Edit = Callable[[str, str], Path]


@pytest.fixture
def edited(tmp_path: Path) -> Edit:
    """A copy of nao's folder in which its MJCF had a text replaced."""

    def edit(old: str, new: str) -> Path:
        for source in (data_folder("models") / "nao").iterdir():
            text = source.read_text(encoding="utf-8")
            assert source.suffix != ".xml" or old in text
            if source.suffix == ".xml":
                text = text.replace(old, new)
            (tmp_path / source.name).write_text(text, encoding="utf-8")
        return tmp_path

    return edit


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('polycoef="0 1 0 0 0"', 'polycoef="0 0 0 0 0"'),
        ('polycoef="0 1 0 0 0"', 'polycoef="0 1 0.5 0 0"'),
        ('joint2="left_hip_yaw_pitch"', 'joint2="right_hip_roll" active="false"'),
        ('joint1="right_hip_yaw_pitch"', 'joint1="right_hip_roll"'),
    ],
)
def test_joints_that_are_tied_otherwise_are_refused(edited: Edit, old: str, new: str) -> None:
    with pytest.raises(InputError, match="'hip_yaw_pitch' must tie a joint1 without a motor"):
        load_robot(edited(old, new))


def test_a_follower_in_a_group_of_motors_is_refused(edited: Edit) -> None:
    folder = edited("<", "<")
    toml = (folder / "robot.toml").read_text(encoding="utf-8")
    (folder / "robot.toml").write_text(
        toml.replace(
            '"right_hip_roll", "right_ankle_roll",',
            '"right_hip_roll", "right_ankle_roll", "right_hip_yaw_pitch",',
        ),
        encoding="utf-8",
    )
    with pytest.raises(InputError, match="'right_hip_yaw_pitch' has no motor of its own"):
        load_robot(folder)


def test_a_robot_with_a_motor_for_each_joint_has_no_followers() -> None:
    assert followers(load_robot("qrio").nominal) == {}
