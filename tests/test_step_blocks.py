"""Claims about the blocks that stand for steps: who touches them is named."""

import mujoco
import pytest

from treadwell.robot.load import load_robot
from treadwell.robot.reach import Reach
from treadwell.robot.step_blocks import Steps, add_steps


@pytest.mark.parametrize(("height_m", "touches"), [(0.03, False), (0.2, True), (-0.03, False)])
def test_a_standing_robot_is_clear_of_a_low_step_and_inside_a_high_one(
    height_m: float, touches: bool
) -> None:
    robot = load_robot("qrio")
    spec = robot.spec()
    names = add_steps(spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    steps = Steps(model, robot, names)
    data.qpos[:] = robot.stand_qpos
    # A block as high as the hips reaches back under the robot that leans over its edge.
    data.qpos[0] = 0.1 if touches else 0.0
    steps.place(data, height_m)
    mujoco.mj_kinematics(model, data)
    found = steps.touched(data)
    assert (found is not None) == touches, found


def test_a_knee_that_would_lie_on_the_next_step_ends_what_legs_could_reach() -> None:
    last = Reach(load_robot("qrio")).rises(1.0)[-1]
    assert last.touches is not None
    assert last.reached
    assert "shank" in last.touches
