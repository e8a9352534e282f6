"""The Gymnasium environments: they pass its own check, repeat by seed, and keep the truth out."""

import gc
import subprocess
import sys
import weakref
from collections.abc import Iterator
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import treadwell
from treadwell._core import Situation
from treadwell.environment import environment_id
from treadwell.environment.actions import LONGEST_STEP, FootstepActions, VelocityActions, gaze_of
from treadwell.environment.commanded import NoPlanner
from treadwell.environment.course_env import FALL_REWARD, GOAL_REWARD, CourseEnv
from treadwell.environment.observations import FARTHEST_M, MOST, observation_space
from treadwell.environment.top_view import GOAL, GROUND, OBSTACLE, ROBOT, TopView
from treadwell.errors import InputError
from treadwell.robot.load import load_robot
from treadwell.scenario.loading import load_scenario, scenario_names

ENV = "treadwell/ObstacleCourse-v0"
AHEAD = np.array([1.0, 0.0, 0.0, 0.0, 0.0], dtype=np.float32)
STAND = np.zeros(5, dtype=np.float32)


@pytest.fixture
def env() -> Iterator[CourseEnv]:
    made = CourseEnv("slalom", render_mode="rgb_array")
    yield made
    made.close()


def towards_goal(seen: dict[str, Any]) -> np.ndarray[Any, Any]:
    ahead, left = seen["goal"]
    return np.array([1.0, 0.0, np.clip(2 * np.arctan2(left, ahead), -1, 1), 0, 0], np.float32)


def test_every_scenario_has_an_id_for_either_kind_of_action() -> None:
    assert environment_id("stairs_up") == "treadwell/StairsUp-v0"
    for name in scenario_names():
        for suffix, kind in (("", "velocity"), ("Footsteps", "footsteps")):
            spec = gymnasium.spec(environment_id(name, suffix))
            assert (spec.kwargs["scenario"], spec.kwargs["actions"]) == (name, kind)


@pytest.mark.parametrize("order", ["treadwell, gymnasium", "gymnasium, treadwell"])
def test_the_ids_are_there_whatever_is_imported_first(order: str) -> None:
    code = f"import {order}; gymnasium.spec('{ENV}')"
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)


def test_the_ids_are_there_after_somebody_asked_whether_gymnasium_is() -> None:
    code = (
        "import importlib.util, treadwell; importlib.util.find_spec('gymnasium'); "
        f"import gymnasium; gymnasium.spec('{ENV}')"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_treadwell_alone_does_not_import_gymnasium() -> None:
    code = "import sys, treadwell; assert 'gymnasium' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_without_gymnasium_the_message_says_what_to_install() -> None:
    code = (
        "import sys; sys.modules['gymnasium'] = None\n"
        "try:\n    import treadwell.environment\n"
        "except ImportError as error:\n    assert 'pip install' in str(error)\n"
        "    assert 'gymnasium>=' in str(error)\n"
        "else:\n    raise SystemExit(1)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.slow
@pytest.mark.parametrize("suffix", ["", "Footsteps"])
def test_gymnasiums_check_finds_nothing_to_warn_of(suffix: str) -> None:
    made = gymnasium.make(f"treadwell/OpenFloor{suffix}-v0", render_mode="rgb_array")
    check_env(made.unwrapped)
    made.close()


@pytest.mark.parametrize("mode", ["sync", "async"])
def test_several_are_stepped_at_once(mode: str) -> None:
    several = gymnasium.make_vec(ENV, 2, vectorization_mode=mode, scenario="open_floor")
    seen, _ = several.reset(seed=5)
    assert seen["depth"].shape == (2, 72, 88)
    assert not np.array_equal(seen["depth"][0], seen["depth"][1])
    _, reward, ended, truncated, info = several.step(np.stack([AHEAD, STAND]))
    assert reward.shape == (2,)
    assert not (ended | truncated).any()
    assert info["scenario_seed"][0] != info["scenario_seed"][1]
    several.close()


def rollout(made: CourseEnv, seed: int) -> list[Any]:
    seen, info = made.reset(seed=seed)
    everything: list[Any] = [info["scenario_seed"], *seen.values()]
    for _ in range(8):
        seen, reward, *_ = made.step(AHEAD)
        everything += [reward, *seen.values()]
    return everything


def test_a_seed_repeats_a_rollout_and_another_gives_another(env: CourseEnv) -> None:
    first, second, other = rollout(env, 3), rollout(env, 3), rollout(env, 4)
    assert all(np.array_equal(a, b) for a, b in zip(first, second, strict=True))
    assert first[0] != other[0]
    assert not all(np.array_equal(a, b) for a, b in zip(first[1:], other[1:], strict=True))


def test_an_episodes_own_seed_is_that_of_the_command_line(env: CourseEnv) -> None:
    seen, info = env.reset(options={"scenario_seed": 7})
    assert info["scenario_seed"] == 7
    step = treadwell.Episode("slalom", seed=7).tick()
    assert np.array_equal(seen["joint_positions"], step.observation.joint_positions)


def test_observations_are_in_their_space_and_dropouts_are_zero(env: CourseEnv) -> None:
    seen, _ = env.reset(seed=1)
    space = observation_space(load_robot("qrio"))
    assert set(space.spaces) == {*MOST, "depth"}
    assert seen in space
    assert (seen["depth"] == 0.0).any()
    assert 0.2 < np.median(seen["depth"][seen["depth"] > 0.0]) < FARTHEST_M


def test_nothing_that_is_observed_is_the_truth() -> None:
    """Another true pose with the same senses is no other observation: the pose is the belief's."""
    made = CourseEnv("kidnapped", overrides=("event.0.at=0.5",))
    seen, _ = made.reset(seed=1)
    for _ in range(10):
        seen, *_ = made.step(STAND)
    assert made._episode is not None
    frame = made._episode.judge.frame
    assert np.hypot(*(seen["pose"][:2] - (frame.x, frame.y))) > 0.2


def test_the_goal_is_told_from_where_the_robot_believes_to_be(env: CourseEnv) -> None:
    seen, _ = env.reset(seed=1)
    x, y, _, yaw = seen["pose"]
    ahead, left = seen["goal"]
    cos, sin = np.cos(yaw), np.sin(yaw)
    found = (x + cos * ahead - sin * left, y + sin * ahead + cos * left)
    assert found == pytest.approx((2.8, 0.0))


def test_the_robot_walks_to_the_goal_and_earns_the_way() -> None:
    made = CourseEnv("open_floor", overrides=("goal.position=[0.6, 0.0]", "start.yaw=0.0"))
    seen, _ = made.reset(seed=1)
    rewards, ended, truncated, info = [], False, False, {}
    while not (ended or truncated):
        seen, reward, ended, truncated, info = made.step(towards_goal(seen))
        rewards.append(reward)
        assert len(rewards) < 200
    assert (ended, truncated, info["outcome"]) == (True, False, "goal_reached")
    assert sum(rewards) - GOAL_REWARD == pytest.approx(0.5, abs=0.15)
    assert max(rewards[:-1]) < 0.05
    with pytest.raises(gymnasium.error.ResetNeeded):
        made.step(STAND)


def test_the_time_limit_truncates() -> None:
    made = CourseEnv("open_floor", overrides=("time_limit=0.3",))
    made.reset(seed=1)
    ends = [made.step(STAND)[2:4] for _ in range(4)]
    assert ends == [(False, False)] * 3 + [(False, True)]


def test_a_fall_terminates_and_costs() -> None:
    push = '{at=0.2, do="push", impulse=[0.0, 40.0, 0.0]}'
    made = CourseEnv("open_floor", overrides=(f"event=[{push}]",))
    made.reset(seed=1)
    ended, reward, info = False, 0.0, {}
    for _ in range(60):
        _, reward, ended, _, info = made.step(STAND)
        if ended:
            break
    assert info["outcome"] == "fell"
    assert reward == pytest.approx(FALL_REWARD, abs=0.6)


def test_a_footstep_is_taken_at_once() -> None:
    made = CourseEnv("open_floor", actions="footsteps")
    made.reset(seed=2)
    step = np.array([0.5, 0.0, 0.0, 0.0], dtype=np.float32)
    _, _, ended, _, info = made.step({"foot": 1, "step": step, "gaze": np.zeros(2)})
    assert made._episode is not None
    assert made._episode.pilot.stepping.landed == 1
    assert not ended
    assert 1.0 < info["time"] < 4.0
    left, right = made._episode.judge.truth.soles(made._episode.simulation.data)
    apart = np.hypot(left.x - right.x, left.y - right.y)
    stance = 0.085
    assert apart == pytest.approx(np.hypot(0.5 * LONGEST_STEP[0], stance), abs=0.01)


def test_actions_stand_for_metres_and_radians() -> None:
    velocity = VelocityActions(8)
    assert velocity.decision(STAND).velocity is None
    assert velocity.decision(AHEAD).velocity == pytest.approx((0.15, 0.0, 0.0))
    assert gaze_of(-1.0, -1.0) == pytest.approx((-0.8, 0.0))
    steps = FootstepActions(8, 0.085, 0.1)
    asked = {"foot": 2, "step": np.array([1, 1, 1, -1]), "gaze": np.zeros(2)}
    (step,) = steps.decision(asked).footsteps
    assert step[:4] == ("right", 0.1, pytest.approx(-0.0725), -0.3)
    assert step[4:] == (-0.05, -0.05, 0.05, "careful", (0.0, 0.0))
    assert steps.decision(asked | {"foot": 0}).footsteps == ()


def test_actions_of_a_larger_robot_stand_for_more_metres_and_as_many_radians() -> None:
    turning = np.array([1.0, 0.0, 1.0, 0.0, 0.0], np.float32)
    assert VelocityActions(8, 4.0).decision(turning).velocity == pytest.approx((0.3, 0.0, 0.25))
    steps = FootstepActions(8, 0.34, 0.4, 4.0)
    asked = {"foot": 1, "step": np.ones(4), "gaze": np.zeros(2)}
    (step,) = steps.decision(asked).footsteps
    assert step[1:5] == pytest.approx((0.4, 0.29, 0.3, 0.2))


def test_a_via_point_is_passed_by_belief() -> None:
    made = CourseEnv("open_floor", overrides=("goal.via=[[0.1, 0.0]]", "start.position=[0.0, 0.0]"))
    made.reset(seed=1)
    made.step(STAND)
    assert made._episode is not None
    assert made._episode.pilot.goals_passed == 1
    situation = made._behaviour.situation
    assert isinstance(situation, Situation)
    assert situation.no_way is None or situation.no_way.endswith(
        NoPlanner().plan(*[None] * 4).reason  # type: ignore[arg-type]
    )


def test_the_picture_shows_course_robot_and_goal(env: CourseEnv) -> None:
    env.reset(seed=1)
    picture = env.render()
    assert picture is not None
    assert (picture.dtype, picture.shape[2]) == (np.uint8, 3)
    for colour in (GROUND, OBSTACLE, GOAL, ROBOT):
        assert (picture == colour).all(axis=-1).sum() > 20
    for _ in range(20):
        env.step(AHEAD)
    later = env.render()
    assert not np.array_equal(picture, later)
    assert env._episode is not None
    assert TopView(env._episode).draw().shape == picture.shape
    assert CourseEnv("slalom").render() is None


def test_a_reset_lets_the_episode_before_go(env: CourseEnv) -> None:
    env.reset(seed=1)
    gone = weakref.ref(env._episode)  # type: ignore[arg-type]
    env.render()
    env.reset(seed=2)
    gc.collect()
    assert gone() is None


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (('vary.robot={choice=["qrio", "nao"]}',), "draws a robot whose observations"),
        (("time_limit=0.02", "sensors.latency=0.5"), "is over before the first picture arrives"),
    ],
)
def test_a_reset_that_cannot_be_is_told_and_leaves_nothing_to_step(
    overrides: tuple[str, ...], message: str
) -> None:
    made = CourseEnv("open_floor", overrides=overrides)
    robots = [load_scenario("open_floor", seed=s, overrides=overrides).robot for s in range(9)]
    seed = next((s for s, name in enumerate(robots) if name != robots[0]), 0)
    with pytest.raises(InputError, match=message):
        made.reset(options={"scenario_seed": seed})
    with pytest.raises(gymnasium.error.ResetNeeded):
        made.step(STAND)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"render_mode": "human"}, "render_mode: found 'human'"),
        ({"actions": "thoughts"}, "actions: found 'thoughts'"),
        ({"scenario": "slalon"}, "slalon"),
        ({"overrides": ("start.jaw=1",)}, "jaw"),
    ],
)
def test_bad_options_are_bad_input(options: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        CourseEnv(**options)
