"""Claims about the judge: falls, arrival, stillness, being stuck, and that it changes nothing."""

import math
from pathlib import Path

import mujoco
import numpy as np
import pytest
from episode_builders import STEP, World, qrio, world

from treadwell.episode import Episode
from treadwell.judging.judge import STUCK_SECONDS, Judge
from treadwell.protocols import JointTargets


def judge_of(made: World) -> Judge:
    return Judge(made.model, made.course, made.scenario, qrio())


def watch(made: World, judge: Judge, seconds: float, legs: float = 1.0) -> None:
    """Stand for a while under the judge's eyes; `legs` scales the targets, 0 straightens them."""
    robot, n = qrio(), len(qrio().joints)
    targets = JointTargets(legs * robot.stand, np.zeros(n), np.zeros(n))
    for _ in range(round(seconds / 0.01)):
        made.simulation.advance(targets)
        judge.watch(made.simulation.data, 1e-9 * made.simulation.time_ns)


def test_a_robot_that_stands_neither_falls_nor_collides() -> None:
    made = world()
    judge = judge_of(made)
    watch(made, judge, 1.0)
    assert judge.falls == 0
    assert judge.collisions == []
    assert judge.touch.left
    assert judge.touch.right
    assert judge.path_length == 0.0


def test_a_robot_that_topples_has_fallen_once() -> None:
    made = world()
    judge = judge_of(made)
    made.simulation.data.qvel[0] = 1.5
    watch(made, judge, 3.0)
    assert judge.falls == 1
    assert judge.fallen
    assert judge.fall is not None
    assert "leaned by" in judge.fall or "touched the floor" in judge.fall


def test_arrival_needs_a_second_of_standing_still_on_both_soles() -> None:
    made = world(goal="position = [0.05, 0.0]\nradius = 0.1")
    judge = judge_of(made)
    watch(made, judge, 0.9)
    assert not judge.goal_reached(made.simulation.data)
    watch(made, judge, 0.6)
    assert judge.goal_reached(made.simulation.data)


def test_standing_still_elsewhere_is_no_arrival() -> None:
    made = world(goal="position = [0.15, 0.0]\nradius = 0.1")
    judge = judge_of(made)
    watch(made, judge, 1.5)
    assert judge.standing_still
    assert not judge.goal_reached(made.simulation.data)
    assert judge.distance_to_goal == pytest.approx(0.15, abs=0.01)


@pytest.mark.parametrize("height", [0.03, None])
def test_a_goal_on_a_platform_is_reached_there(height: float | None) -> None:
    goal = "position = [1.0, 0.0]" + (f"\nheight = {height}" if height is not None else "")
    made = world(STEP, goal, "position = [1.0, 0.0]")
    judge = judge_of(made)
    watch(made, judge, 1.5)
    assert judge.goal_reached(made.simulation.data)


def test_a_goal_at_another_level_is_not_reached_from_this_one() -> None:
    made = world(
        STEP, "position = [0.65, 0.0]\nradius = 0.2\nheight = 0.0", "position = [0.8, 0.0]"
    )
    judge = judge_of(made)
    watch(made, judge, 1.5)
    assert judge.distance_to_goal < 0.2
    assert judge.standing_still
    assert not judge.goal_reached(made.simulation.data)


STAIRS = """
[[course]]
kind = "stairs"
name = "stairs"
position = [0.6, 0.0]
"""


@pytest.mark.parametrize(("height", "reached"), [(0.105, True), (0.135, True), (0.09, False)])
def test_the_soles_may_be_twenty_millimetres_off_the_goals_height(
    height: float, reached: bool
) -> None:
    made = world(STAIRS, "position = [1.125, 0.0]", "position = [1.125, 0.0]")
    goal = made.scenario.goal.model_copy(update={"height": height})
    made.scenario = made.scenario.model_copy(update={"goal": goal})
    judge = judge_of(made)
    watch(made, judge, 1.5)
    assert judge.frame.z == pytest.approx(0.12, abs=2e-3)
    assert judge.goal_reached(made.simulation.data) is reached


@pytest.mark.parametrize("step", [1, 2, 3, 4])
def test_a_robot_carried_up_a_staircase_has_climbed_each_step_and_touched_no_riser(
    step: int,
) -> None:
    made = world(STAIRS)
    judge, data = judge_of(made), made.simulation.data
    time = 0.0
    for place in [*range(step + 1), *reversed(range(step))]:
        x = 0.5 if place == 0 else 0.6 + 0.12 * place - 0.06
        for lift in (0.02, *8 * (-0.0005,)):
            data.qpos[:] = made.course.qpos
            data.qpos[0] += x
            data.qpos[2] += 0.03 * place + lift
            mujoco.mj_forward(made.model, data)
            time += 0.01
            judge.watch(data, time)
    assert (judge.stairs_climbed, judge.stairs_descended) == (step, step)
    assert judge.falls == 0
    assert judge.collisions == []


def test_a_robot_that_steps_off_a_landing_falls() -> None:
    made = world(STAIRS, start="position = [1.23, 0.0]\nyaw = 0.0")
    judge = judge_of(made)
    made.simulation.data.qvel[0] = 1.2
    watch(made, judge, 2.0)
    assert judge.falls == 1


def test_who_stays_in_one_place_for_long_is_stuck() -> None:
    made = world()
    judge = judge_of(made)
    watch(made, judge, 0.1)
    judge.watch(made.simulation.data, STUCK_SECONDS - 1.0)
    assert not judge.stuck
    judge.watch(made.simulation.data, STUCK_SECONDS + 1.0)
    assert judge.stuck


def test_the_paths_length_is_that_of_the_way_without_its_sways() -> None:
    made = world()
    judge, data = judge_of(made), made.simulation.data
    judge.watch(data, 0.0)
    for tick in range(1, 201):
        sway = 0.004 * math.sin(2.0 * tick)
        data.xpos[:, 0] += 0.005
        data.xpos[:, 1] += sway
        judge.watch(data, 0.01 * tick)
        data.xpos[:, 1] -= sway
    assert judge.path_length == pytest.approx(1.0, rel=0.05)


def test_a_robot_that_is_carried_has_neither_walked_nor_climbed_what_lies_between(
    tmp_path: Path,
) -> None:
    carried = '[[event]]\nat = 0.5\ndo = "kidnap"\nposition = [1.0, 0.0]\nyaw = 0.0\n'
    file = tmp_path / "carried.toml"
    file.write_text(
        f'schema = 1\nname = "carried"\n[start]\n[goal]\nposition = [2.0, 0.0]\n{STEP}{carried}'
    )
    episode = Episode(file)
    for _ in range(100):
        episode.tick()
    judge = episode.judge
    assert judge.frame.x == pytest.approx(1.0, abs=0.05)
    assert judge.path_length < 0.1
    assert (judge.stairs_climbed, judge.stairs_descended) == (0, 0)


def test_watching_leaves_the_physics_as_it_is() -> None:
    watched, alone = (
        world(STEP, start="position = [0.55, 0.0]"),
        world(STEP, start="position = [0.55, 0.0]"),
    )
    judge = judge_of(watched)
    for made in (watched, alone):
        made.simulation.data.qvel[0] = 0.8
    watch(watched, judge, 1.0)
    alone.stand(1.0)
    assert np.array_equal(watched.simulation.data.qpos, alone.simulation.data.qpos)
