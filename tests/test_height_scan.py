"""The heights around the robot as it believes them: where they lie, and that unknown is marked."""

import math
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from hypothesis import given, settings
from hypothesis import strategies as st

from treadwell.environment.course_env import CourseEnv
from treadwell.environment.height_scan import HIGHEST_M, KNOWN, SCAN, HeightScan
from treadwell.errors import InputError

STAND = np.zeros(5, np.float32)


class Plain:
    """A map with one cell on another level, and one that is not known."""

    origin = (-2.0, -1.0)
    cell = 0.1
    kind = np.ones((40, 60), np.uint8)
    height = np.full((40, 60), 0.5, np.float32)

    def __init__(self, *raised: tuple[float, float]) -> None:
        self.height = self.height.copy()
        for x, y in raised:
            self.height[self._index(x, y)] = 0.6

    def forget(self, x: float, y: float) -> None:
        self.height[self._index(x, y)] = np.nan

    def _index(self, x: float, y: float) -> tuple[int, int]:
        return (
            math.floor((y - self.origin[1]) / self.cell),
            math.floor((x - self.origin[0]) / self.cell),
        )


def test_rows_go_ahead_and_columns_to_the_left_from_where_the_robot_is() -> None:
    scan = HeightScan(length=0.4, width=0.2, spacing=0.1, ahead=0.2)
    assert scan.shape == (5, 3)
    robot = (1.05, 1.05, 0.5, math.pi / 2)  # it faces along y; left of it is -x
    world = Plain((1.05, 1.35), (0.95, 1.05))
    world.forget(1.15, 1.45)
    seen = scan.observed(world, robot)
    expected = np.zeros((5, 3), np.float32)
    expected[3, 1] = 0.1  # three rows ahead, in the middle
    expected[0, 2] = 0.1  # beside it, to the left
    assert seen[SCAN] == pytest.approx(expected, abs=1e-6)
    assert seen[KNOWN][4, 0] == 0
    assert seen[KNOWN].sum() == 14


@settings(deadline=None, max_examples=60)
@given(
    x=st.floats(-3.0, 5.0),
    y=st.floats(-2.0, 4.0),
    z=st.floats(-9.0, 9.0),
    yaw=st.floats(-7.0, 7.0),
)
def test_whatever_the_pose_a_scan_is_in_its_space_and_unknown_is_zero(
    x: float, y: float, z: float, yaw: float
) -> None:
    scan, world = HeightScan(), Plain()
    seen = scan.observed(world, (x, y, z, yaw))
    for name, space in scan.spaces().items():
        assert space.contains(seen[name])
    known = seen[KNOWN] == 1
    assert (seen[SCAN][~known] == 0.0).all()
    assert seen[SCAN][known] == pytest.approx(np.clip(0.5 - z, -HIGHEST_M, HIGHEST_M), abs=1e-5)


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"spacing": 0.0}, r"height_scan\.spacing: must be finite and > 0, found 0"),
        ({"length": math.inf}, r"height_scan\.length: must be finite"),
        ({"ahead": math.nan}, r"height_scan\.ahead: must be finite, found nan"),
        ({"spacing": 1e-4}, r"height_scan\.spacing: makes more than 100000 points"),
        ({"spacin": 0.1}, r"height_scan\.spacin: unknown key: .* did you mean 'spacing'"),
        ({"width": "wide"}, r"height_scan\.width: must be a number, found 'wide'"),
        (0.05, r"height_scan: must be True, False or a table, found 0\.05"),
    ],
)
def test_a_grid_that_is_none_is_bad_input(asked: Any, message: str) -> None:  # noqa: ANN401
    with pytest.raises(InputError, match=message):
        CourseEnv("open_floor", height_scan=asked)


def test_an_environment_has_it_only_where_it_is_asked_for() -> None:
    env = CourseEnv("open_floor")
    assert not {SCAN, KNOWN} & set(env.observation_space.spaces)
    assert not {SCAN, KNOWN} & set(env.reset(seed=1)[0])
    env.close()
    made = gymnasium.make("treadwell/OpenFloor-v0", height_scan=True)
    assert made.observation_space[SCAN].shape == (25, 17)
    made.close()


def test_it_passes_gymnasiums_own_check() -> None:
    env = CourseEnv("open_floor", height_scan={"spacing": 0.1}, overrides=("time_limit=2",))
    check_env(env, skip_render_check=True)
    env.close()


def test_the_steps_of_stairs_appear_where_they_are_and_what_nobody_saw_is_marked() -> None:
    grid = {"length": 1.2, "width": 0.4, "spacing": 0.05, "ahead": 0.6}
    near = ("start.position=[0.2, 0.0]", "start.yaw=0.0", "sensors.depth=ideal")
    env = CourseEnv("stairs_up", height_scan=grid, overrides=near)
    seen, _ = env.reset(seed=3)
    for down in (0.6, 0.4, 0.2):
        for _ in range(10):
            seen, *_ = env.step(np.array([0.0, 0.0, 0.0, 0.0, down], np.float32))
    known = seen[KNOWN] == 1
    assert 0.2 < known.mean() < 1.0
    assert (seen[SCAN][~known] == 0.0).all()
    episode = env._episode
    assert episode is not None
    x, y, _, yaw = seen["pose"]
    truth = {
        round(float(t.polygon[:, 2].max()), 3) for e in episode.course.elements for t in e.tops
    }
    first = min(height for height in truth if height > 0.005)
    assert np.isclose(seen[SCAN][known], 0.0, atol=0.008).mean() > 0.2
    on_first = known & np.isclose(seen[SCAN], first, atol=0.008)
    assert on_first.sum() > 5
    ahead = 0.6 + 0.05 * (np.nonzero(on_first)[0] - 12)
    tops = [t.polygon for e in episode.course.elements for t in e.tops]
    step = next(p for p in tops if abs(float(p[:, 2].max()) - first) < 1e-3)
    turned = np.array([math.cos(yaw), math.sin(yaw)])
    true_ahead = (step[:, :2] - (x, y)) @ turned
    assert true_ahead.min() - 0.06 < np.median(ahead) < true_ahead.max() + 0.06
    env.close()
