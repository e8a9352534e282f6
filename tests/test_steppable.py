"""Claims about which surfaces in map.png are stairs: those that a robot of this size could take."""

import numpy as np
from episode_builders import flight, grid

from treadwell.map_memory import FLOOR, OBSTACLE, RememberedMap
from treadwell.recording.stair_memory import StairMemory
from treadwell.recording.steppable import StepLimits, contains, outline, step_limits, told_apart
from treadwell.robot.load import load_robot
from treadwell.scenario.loading import load_scenario
from treadwell.trace import StairTrace

LIMITS = StepLimits(floor=0.01, up=0.05, down=0.05, knee=0.16)


def surface(height: float, x: float = 0.0, depth: float = 0.2) -> StairTrace:
    """One surface of 40 cm across x, its front edge at `x`."""
    front, back = ([[at, 0.2, height], [at, -0.2, height]] for at in (x, x + depth))
    return StairTrace(
        np.array(front), np.array(back), front_fitted=True, back_fitted=False, steps_ago=0
    )


def floor_before(height: float, x: float = 0.0) -> RememberedMap:
    """Floor up to `x`, nothing known behind it."""
    found = grid()
    until = round((x + 1.0) / found.cell)
    found.kind[:, :until], found.height[:, :until] = FLOOR, height
    return found


def kinds(stair: StairTrace, remembered: RememberedMap, *others: StairTrace) -> tuple[bool, bool]:
    steps, too_high = told_apart([stair, *others], remembered, LIMITS)
    return stair in steps, stair in too_high


def test_a_step_that_the_robot_takes_is_a_stair_up_and_down() -> None:
    assert kinds(surface(0.04), floor_before(0.0)) == (True, False)
    assert kinds(surface(0.0), floor_before(0.04)) == (True, False)


def test_a_step_beyond_the_limit_is_told_as_too_high_and_the_top_of_a_wall_as_nothing() -> None:
    assert kinds(surface(0.055), floor_before(0.0)) == (False, True)
    assert kinds(surface(0.30), floor_before(0.0)) == (False, False)
    assert kinds(surface(0.66), floor_before(0.36)) == (False, False)


def test_what_goes_on_level_or_borders_on_nothing_known_is_no_stair() -> None:
    assert kinds(surface(0.004), floor_before(0.0)) == (False, False)
    assert kinds(surface(0.04), grid()) == (False, False)
    blocked = floor_before(0.0)
    blocked.kind[blocked.kind == FLOOR] = OBSTACLE
    assert kinds(surface(0.04), blocked) == (False, False)


def test_the_stairs_of_a_flight_are_told_by_each_other_and_a_landing_too_high_ends_it() -> None:
    flight_up = flight(4)
    steps, too_high = told_apart(flight_up, grid(), LIMITS)
    assert (steps, too_high) == ([*flight_up], [])
    above = surface(0.12 + 0.30, x=0.6 + 4 * 0.12)
    assert kinds(above, grid(), *flight_up) == (False, False)


def test_the_floor_behind_a_sill_makes_it_one_whose_front_was_never_seen() -> None:
    behind = grid()
    behind.kind[:, 32:], behind.height[:, 32:] = FLOOR, 0.0
    assert kinds(surface(0.04), behind) == (True, False)


def test_the_limits_are_those_of_robot_and_scenario() -> None:
    robot, scenario = load_robot("qrio"), load_scenario("stairs_up")
    own = step_limits(scenario, robot)
    assert own.steps(0.0502)
    assert not own.steps(0.055)
    assert own.steps(-0.03)
    assert 0.14 < own.knee < 0.18
    lower = load_scenario("stairs_up", overrides=["navigation.climbing.ascend.step_max_z=0.03"])
    assert not step_limits(lower, robot).steps(0.04)


def test_without_a_robot_every_stair_is_one() -> None:
    memory = StairMemory()
    memory.update([surface(0.66)], climbing=False)
    assert len(memory.told_apart(floor_before(0.0))[0]) == 1
    memory.limits = LIMITS
    assert memory.told_apart(floor_before(0.0)) == ([], [])


def test_a_point_is_inside_whichever_way_round_the_corners_are_given() -> None:
    corners = outline(surface(0.0))
    for way_round in (corners, corners[::-1]):
        assert contains(way_round, np.array([0.1, 0.0]))
        assert not contains(way_round, np.array([-0.1, 0.0]))
