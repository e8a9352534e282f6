"""Environments are copied and pickled, amid an episode too; what is no action is named."""

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from sweep_builders import short

from treadwell.environment.actions import FootstepActions, VelocityActions
from treadwell.environment.course_env import CourseEnv
from treadwell.errors import InputError, SimulationError

AHEAD = np.array([1.0, 0.0, 0.2, 0.1, 0.0], dtype=np.float32)
COPIES: dict[str, Callable[[Any], Any]] = {
    "pickle": lambda env: pickle.loads(pickle.dumps(env)),
    "deepcopy": copy.deepcopy,
}


def assert_same(one: dict[str, Any], other: dict[str, Any]) -> None:
    for name, value in one.items():
        assert np.array_equal(value, other[name]), name


@pytest.mark.parametrize("way", COPIES)
def test_a_copy_goes_on_where_the_episode_is(way: str) -> None:
    env = gymnasium.make("treadwell/ObstacleCourse-v0", scenario="slalom")
    env.reset(seed=3)
    action = AHEAD.copy()
    for _ in range(3):
        env.step(action)
    action[:] = 0.0  # what was done is done
    other = COPIES[way](env)
    for _ in range(3):
        mine, theirs = env.step(AHEAD), other.step(AHEAD)
        assert_same(mine[0], theirs[0])
        assert mine[1:] == theirs[1:]
    mine, theirs = env.reset(), other.reset()  # the next episode is the same one, too
    assert mine[1] == theirs[1]
    assert_same(mine[0], theirs[0])


@pytest.mark.parametrize("way", COPIES)
def test_one_that_has_not_begun_is_copied_and_so_is_one_that_is_closed(way: str) -> None:
    env = CourseEnv("slalom", actions="footsteps", render_mode="rgb_array")
    other = COPIES[way](env)
    assert other.action_space == env.action_space
    assert np.array_equal(env.render(), other.render())
    assert_same(env.reset(seed=1)[0], other.reset(seed=1)[0])
    env.close()
    closed = COPIES[way](env)
    with pytest.raises(gymnasium.error.ResetNeeded):
        closed.step(closed.action_space.sample())
    closed.reset(seed=1)


def test_one_whose_episode_is_over_stays_so(tmp_path: Path) -> None:
    env = CourseEnv(short(tmp_path))
    env.reset(seed=1)
    while not env.step(AHEAD)[3]:
        pass
    with pytest.raises(gymnasium.error.ResetNeeded):
        copy.deepcopy(env).step(AHEAD)


def test_a_copy_that_comes_elsewhere_says_so(tmp_path: Path) -> None:
    """As on another processor; here the scenario's file changed in between."""
    file = Path(short(tmp_path))
    env = CourseEnv(str(file))
    env.reset(seed=1)
    env.step(AHEAD)
    kept = pickle.dumps(env)
    file.write_text(file.read_text().replace("position = [0.0, 0.0]", "position = [0.3, 0.0]"))
    with pytest.raises(SimulationError, match="not come to the same state after the same 1"):
        pickle.loads(kept)


WRONG = {
    "too few": (
        np.zeros(3),
        r"found an array of shape \(3,\); must be 5 finite numbers: forward",
    ),
    "too many": (np.zeros((1, 5)), r"found an array of shape \(1, 5\)"),
    "a number": (0.5, r"found an array of shape \(\)"),
    "nothing": (None, "found None"),
    "words": (["0"] * 5, r'found \["0"'),
    "a table": ({"foot": 1}, "found a table"),
    "ragged": ([[1.0], 2.0, 3.0, 4.0, 5.0], "found "),
    "NaN": (np.array([0.0, np.nan, 0.0, 0.0, 0.0]), r"found \[0\.0, NaN, .*finite numbers"),
    "infinite": (np.array([0.0, 0.0, 0.0, 0.0, -np.inf]), r"found \[.*; must be 5 finite"),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_is_no_velocity_is_named(case: str) -> None:
    action, message = WRONG[case]
    with pytest.raises(InputError, match=f"^action: {message}"):
        VelocityActions(8).decision(action)


STEP = {"foot": 1, "step": np.zeros(4), "gaze": np.zeros(2)}
WRONG_STEPS = {
    "an array": (np.zeros(7), "^action: found ndarray; must be a dict of foot, step and gaze"),
    "a part missing": ({"foot": 1, "step": np.zeros(4)}, "^action: found foot, step; must be"),
    "a part too many": (STEP | {"head": 0}, "^action: found foot, step, gaze, head"),
    "a third foot": (STEP | {"foot": 3}, "^action: foot: found 3; must be 0 to stand, 1 left"),
    "half a foot": (STEP | {"foot": 0.5}, "^action: foot: found 0.5"),
    "two feet": (STEP | {"foot": [1, 2]}, r"^action: foot: found an array of shape \(2,\)"),
    "a short step": (STEP | {"step": np.zeros(3)}, r"^action: step: .*\(3,\); must be 4 finite"),
    "NaN": (
        STEP | {"gaze": [np.nan, 0.0]},
        r"^action: gaze: found \[NaN, 0\.0\]; must be 2",
    ),
}


@pytest.mark.parametrize("case", WRONG_STEPS)
def test_what_is_no_footstep_is_named(case: str) -> None:
    action, message = WRONG_STEPS[case]
    with pytest.raises(InputError, match=message):
        FootstepActions(8, 0.09, 0.12).decision(action)


@pytest.mark.parametrize("action", [AHEAD.tolist(), AHEAD.astype(np.float64), np.zeros(5, int)])
def test_numbers_of_any_type_are_an_action(action: Any) -> None:  # noqa: ANN401
    assert VelocityActions(8).decision(action).state in {"walk", "stand"}


def test_a_wrong_action_does_nothing(tmp_path: Path) -> None:
    env = CourseEnv(short(tmp_path))
    env.reset(seed=1)
    with pytest.raises(InputError, match="action: found an array of shape"):
        env.step(np.zeros(4))
    _, _, _, _, info = env.step(AHEAD)
    assert info["time"] < 0.15
