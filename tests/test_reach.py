"""Claims about what legs can do: where they reach, what their motors bear."""

import pytest

from treadwell.robot.load import load_robot
from treadwell.robot.reach import Reach


@pytest.fixture(scope="module")
def qrio() -> Reach:
    return Reach(load_robot("qrio"))


def test_the_legs_reach_farther_than_the_gait_asks(qrio: Reach) -> None:
    assert qrio.gait["max_forward"] < qrio.longest_step_m() < 0.4
    assert qrio.gait["max_sideways"] < qrio.widest_step_m() < 0.4
    assert qrio.gait["max_turn"] < qrio.largest_turn_rad()


@pytest.mark.parametrize("name", ["qrio", "nao"])
def test_the_steps_that_a_robot_is_known_to_climb_are_possible(name: str) -> None:
    reach = Reach(load_robot(name))
    assert reach.rise(0.03).possible
    assert reach.rise(-0.03).possible


def test_a_higher_step_asks_more_of_the_knee_until_it_is_out_of_reach(qrio: Reach) -> None:
    rises = qrio.rises(1.0)
    torques = [rise.knee_torque_nm for rise in rises if rise.possible]
    assert torques == sorted(torques)
    # 7 kg over a knee that is bent by about a right angle.
    assert 3.0 < torques[0] < 6.0
    assert not rises[-1].possible
    assert not qrio.rise(0.2).possible


def test_a_weak_motor_ends_what_long_legs_would_reach(qrio: Reach) -> None:
    strong = qrio.rise(0.03)
    robot = load_robot("qrio")
    robot.limits.peak_torque[:] *= 0.3
    weak = Reach(robot).rise(0.03)
    assert strong.possible
    assert weak.reached
    assert not weak.possible
    assert weak.torque_share == pytest.approx(strong.torque_share / 0.3)
