"""Claims about trajectories: the TUM format, and rotations as quaternions."""

from pathlib import Path

import mujoco
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from treadwell.errors import InputError
from treadwell.poses import pose_matrix
from treadwell.recording.trajectory import Trajectory, jumps, quaternion, read_trajectory


def test_a_line_is_time_position_and_quaternion(tmp_path: Path) -> None:
    trajectory = Trajectory()
    trajectory.add(80_000_000, pose_matrix(1.0, -2.0, 0.03, np.pi / 2))
    trajectory.write(tmp_path / "t.tum")
    comment, line = (tmp_path / "t.tum").read_text().splitlines()
    assert comment.startswith("#")
    assert [float(word) for word in line.split()] == pytest.approx(
        [0.08, 1.0, -2.0, 0.03, 0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)]
    )


def test_what_is_written_is_read(tmp_path: Path) -> None:
    trajectory = Trajectory()
    for i in range(50):
        trajectory.add(80_000_000 * i, pose_matrix(0.01 * i, 0.02 * i, 0.0, 0.1 * i))
    trajectory.write(tmp_path / "t.tum")
    assert read_trajectory(tmp_path / "t.tum") == pytest.approx(trajectory.rows, abs=1e-8)
    assert trajectory.positions().shape == (50, 3)


def test_an_empty_trajectory_has_no_positions(tmp_path: Path) -> None:
    Trajectory().write(tmp_path / "t.tum")
    assert read_trajectory(tmp_path / "t.tum").shape == (0, 8)
    assert Trajectory().positions().shape == (0, 3)


@pytest.mark.parametrize(
    "text",
    [
        "-1 0 0 0 0 0 0 1",
        "1e300 0 0 0 0 0 0 1",
        "1 2 3",
        "0 0 0 0 0 0 0 x",
        "0 0 0 nan 0 0 0 1",
        "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1",
    ],
)
def test_a_broken_line_is_named(tmp_path: Path, text: str) -> None:
    path = tmp_path / "t.tum"
    path.write_text(text)
    with pytest.raises(InputError, match="line"):
        read_trajectory(path)


@given(st.tuples(*[st.floats(-10.0, 10.0)] * 4))
@example((0.0, 0.0, 0.0, 0.0))
@example((0.0, 0.0, 0.0, np.pi))
def test_a_level_pose_is_kept_to_the_bit_as_its_matrix_is(
    pose: tuple[float, float, float, float],
) -> None:
    level, general = Trajectory(), Trajectory()
    level.add_level(10, pose)
    general.add(10, pose_matrix(*pose))
    assert level.rows.tobytes() == general.rows.tobytes()


@given(st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4))
def test_a_quaternion_turns_as_its_matrix_does(numbers: list[float]) -> None:
    wxyz = np.array(numbers)
    if np.linalg.norm(wxyz) < 1e-3:
        wxyz = np.array([0.0, 1.0, 0.0, 0.0])
    wxyz /= np.linalg.norm(wxyz)
    matrix, back = np.empty(9), np.empty(9)
    mujoco.mju_quat2Mat(matrix, wxyz)
    x, y, z, w = quaternion(matrix.reshape(3, 3))
    assert w >= 0.0
    mujoco.mju_quat2Mat(back, np.array([w, x, y, z]))
    assert back == pytest.approx(matrix, abs=1e-9)


def test_a_jump_is_farther_than_the_robot_comes_in_the_time_of_a_frame() -> None:
    rows = np.zeros((7, 8))
    rows[:, 0] = [0.0, 0.08, 0.16, 0.24, 0.56, 0.64, 0.72]  # three frames are missing
    rows[:, 1] = [0.0, 0.05, 0.10, 1.0, 1.35, 1.40, 1.45]
    assert jumps(rows, 0.1).tolist() == [3]
    assert jumps(rows, 0.05 / 2).tolist() == [1, 2, 3, 4, 5, 6]
    assert jumps(rows, np.inf).tolist() == []
    assert jumps(rows[:1], 0.1).tolist() == []
