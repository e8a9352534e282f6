"""A robot stands where its soles are, wherever its root is."""

import math
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from episode_builders import qrio, scenario
from hypothesis import given, settings
from hypothesis import strategies as st

from treadwell.course.build import build_course
from treadwell.errors import InputError
from treadwell.judging.ground_truth import GroundTruth
from treadwell.physics.simulation import Simulation, Start
from treadwell.robot.load import Robot, load_robot
from treadwell.robot.standing import standing_root

BEHIND = '[[course]]\nkind = "box"\nposition = [{x}, 0.0]\nsize = [0.1, 0.4, 0.3]\n'


def moved(by: float) -> Robot:
    """qrio whose soles are said to be so far ahead of where they are."""
    legs, file = qrio().file.legs, qrio().file
    ahead = {}
    for side in ("left", "right"):
        leg = getattr(legs, side)
        x, y, z = leg.sole.position
        sole = leg.sole.model_copy(update={"position": (x + by, y, z)})
        ahead[side] = leg.model_copy(update={"sole": sole})
    return replace(qrio(), file=file.model_copy(update={"legs": legs.model_copy(update=ahead)}))


@pytest.mark.parametrize("name", ["qrio", "nao"])
def test_a_course_checks_the_robot_where_the_simulation_puts_it(name: str) -> None:
    robot = load_robot(name)
    made = scenario(start="position = [0.3, -0.2]\nyaw = 0.7")
    course = build_course(made, robot)
    start = Start(*course.start.position, yaw=course.start.yaw, height=course.start.height)
    assert np.array_equal(Simulation(course.model, robot, start).data.qpos, course.qpos)


@settings(max_examples=25, deadline=None)
@given(
    ahead=st.floats(-0.1, 0.1), x=st.floats(-5.0, 5.0), y=st.floats(-5.0, 5.0),
    yaw=st.floats(-7.0, 7.0),
)  # fmt: skip
def test_the_middle_of_the_soles_is_where_the_robot_stands(
    ahead: float, x: float, y: float, yaw: float
) -> None:
    robot = moved(ahead)
    data = mujoco.MjData(robot.nominal)
    data.qpos[:] = robot.stand_qpos
    data.qpos[:7] = standing_root(robot, (x, y, 0.1), yaw)
    mujoco.mj_kinematics(robot.nominal, data)
    truth = GroundTruth(robot.nominal, robot)
    frame = truth.frame(truth.soles(data))
    assert (frame.x, frame.y, frame.z) == pytest.approx((x, y, 0.1), abs=1e-9)
    assert math.remainder(frame.yaw - yaw, math.tau) == pytest.approx(0.0, abs=1e-6)


def test_an_obstacle_is_in_the_way_of_the_body_where_its_soles_put_it() -> None:
    free = scenario(BEHIND.format(x=0.13))
    build_course(free, moved(0.1))  # its body is 10 cm behind its soles
    with pytest.raises(InputError, match="would start inside the obstacle 'box'"):
        build_course(scenario(BEHIND.format(x=-0.13)), moved(0.1))
    build_course(scenario(BEHIND.format(x=-0.2)), moved(-0.1))
