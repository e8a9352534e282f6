"""Claims about what ground costs: by its shape against a robot's limits, by speed and curvature."""

import math
from typing import Any

import mujoco
import numpy as np
import pytest

from treadwell.costs import (
    GroundCosts,
    LocalRegression,
    PathWeights,
    SlipSense,
    gait_statistics,
    ground_costs,
)
from treadwell.errors import InputError
from treadwell.robot.load import load_robot

GRAVITY = 9.81
STEP = 0.001
SECONDS = 1.5
WAVELENGTH = 2.0
"""Of rough ground, in lengths of a sole: `costs.motion.wavelength`."""


def costs(robot: str = "qrio", settings: dict[str, Any] | None = None) -> GroundCosts:
    return ground_costs(robot, settings)


@pytest.mark.parametrize("robot", ["qrio", "nao"])
def test_a_robots_limits_follow_from_its_folder(robot: str) -> None:
    description = load_robot(robot).description()
    limits = costs(robot).limits
    assert limits["radius"] == description["body"]["radius"]
    gait = description["gait"]
    assert limits["speed"] == pytest.approx(gait["max_forward"] / gait["step_time"])
    assert limits["roughness"] == pytest.approx(0.5 * gait["step_height"])
    assert 0.2 < limits["com_height"] < 0.4


def test_a_map_of_heights_costs_more_where_it_is_harder_and_has_no_way_over_a_wall() -> None:
    heights = np.zeros((40, 60))
    heights[:, 50:] = 0.3
    heights[:10, :20] += np.linspace(0.0, 0.1, 20)
    heights[30:, 30] = np.nan
    found = costs().map(heights, 0.04)
    assert found.shape == heights.shape
    assert found[20, 10] == 1.0
    assert 1.0 < found[4, 10] < 3.0
    assert np.isinf(found[20, 49])
    assert np.isinf(costs().map(heights, 0.04, np.full(heights.shape, 0.3))).any()


def test_bad_settings_and_arrays_are_refused_by_name() -> None:
    with pytest.raises(InputError, match=r"costs\.limits\.slope must be"):
        costs(settings={"limits": {"slope": -1.0}})
    with pytest.raises(InputError, match="unknown field `slop`"):
        costs(settings={"traversability": {"slop": 1.0}})
    with pytest.raises(ValueError, match="cell must be > 0 m, got 0"):
        costs().map(np.zeros((4, 4)), 0.0)
    with pytest.raises(ValueError, match="head_room must have the shape of heights"):
        costs().map(np.zeros((4, 4)), 0.04, np.zeros((3, 4)))


def holds(
    limits: dict[str, float],
    slope: float,
    roughness: float,
    friction: float,
    speed: float,
    curvature: float,
) -> bool:
    """Carry a body of the robot's size on a turntable that heaves, and see whether it stays."""
    waves = 2.0 * math.pi / (WAVELENGTH * limits["sole"])
    amplitude = math.sqrt(2.0) * roughness
    lean = amplitude * waves
    tilt = math.atan(slope + lean)
    upright = tilt - math.atan(lean)  # what the ankles take up: the soles lie flat, the body stands
    height, half = limits["com_height"], limits["half_support"]
    radius = 1.0 / max(curvature, 0.2)
    turn = speed / radius if curvature else 0.0
    model = mujoco.MjModel.from_xml_string(f"""
    <mujoco><compiler angle="radian"/>
    <option timestep="{STEP}" cone="elliptic" noslip_iterations="20" impratio="20"/>
    <worldbody>
      <body name="table" gravcomp="1">
        <joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 0 1"/>
        <geom type="box" size="0.4 0.4 0.02" pos="{radius} 0 -0.02" axisangle="0 1 0 {tilt}"
          friction="{friction} 0.005 0.0001" mass="10000" condim="3" solref="0.004 1"/>
      </body>
      <body name="robot" pos="{radius} 0 0" axisangle="0 1 0 {tilt}"><freejoint/>
        <inertial pos="{-height * math.sin(upright)} 0 {height * math.cos(upright)}" mass="7"
          diaginertia="0.1 0.1 0.05"/>
        <geom type="box" size="{half} {half} 0.005" pos="0 0 0.005" condim="3"
          friction="{friction} 0.005 0.0001" solref="0.004 1"/>
      </body>
    </worldbody></mujoco>""")
    # The soles begin on the table, whose upper side goes through the point at the radius.
    data = mujoco.MjData(model)
    normal = np.array([math.sin(tilt), 0.0, math.cos(tilt)])
    model.geom_pos[0] = np.array([radius, 0.0, 0.0]) - 0.02 * normal
    rate = waves * speed
    mujoco.mj_forward(model, data)
    data.qvel[3] = turn * radius
    data.qvel[5:8] = data.xmat[2].reshape(3, 3).T @ np.array([0.0, 0.0, turn])
    data.qvel[2:5] = [0.0, turn * radius, 0.0]
    start: np.ndarray | None = None
    for step in range(round(SECONDS / STEP)):
        now = step * STEP
        data.qpos[0] = amplitude * (1.0 - math.cos(rate * now)) if speed else 0.0
        data.qvel[0] = amplitude * rate * math.sin(rate * now)
        data.qfrc_applied[0] = 10000.0 * amplitude * rate * rate * math.cos(rate * now)
        data.qpos[1], data.qvel[1] = turn * now, turn
        mujoco.mj_step(model, data)
        table = data.xmat[1].reshape(3, 3)
        place = table.T @ (data.xpos[2] - data.xpos[1])
        leant = table.T @ data.xmat[2].reshape(3, 3)[:, 2]
        if start is None and now > 0.1:  # it has settled
            start = place
        if float(leant @ normal) < math.cos(0.05):
            return False
        if start is not None and np.linalg.norm(place - start) > 0.005:
            return False
    return True


@pytest.mark.parametrize("robot", ["qrio", "nao"])
def test_a_body_on_a_heaving_turntable_stays_where_neither_tipping_nor_slipping_is_told(
    robot: str,
) -> None:
    random = np.random.default_rng(5)
    model = costs(robot)
    told, right = [], []
    while len(told) < 60:
        slope, roughness = random.uniform(0.0, 0.25), random.uniform(0.0, 0.004)
        friction, speed = random.uniform(0.15, 1.0), random.uniform(0.0, 1.5)
        case = (slope, roughness, friction, speed, random.uniform(0.2, 3.0))
        demand = max(model.demand(*case))
        if not 0.9 < demand < 1.1:  # what is nearer to the limit is decided by the contact's model
            told.append(demand < 1.0)
            right.append(told[-1] == holds(model.limits, *case))
    assert 10 <= sum(told) <= 50
    assert sum(right) >= 57, sum(right)


def test_on_the_same_rough_patch_there_is_a_speed_below_which_the_body_stays() -> None:
    model = costs()
    limits = model.limits
    patch = (0.1, 0.001, 0.4)
    speeds = np.linspace(0.0, 1.5, 31)
    prices = [model.motion_cost(*patch, speed, 0.5) for speed in speeds * limits["speed"] / 1.5]
    assert (np.diff(prices) > 0.0).all()
    fastest = max(speed for speed in speeds if max(model.demand(*patch, speed, 0.5)) <= 1.0)
    assert 0.3 < fastest < 1.4
    assert holds(limits, *patch, 0.9 * fastest, 0.5)
    assert not holds(limits, *patch, 1.1 * fastest + 0.05, 0.5)


def test_a_bend_is_learned_from_noisy_measurements_and_what_was_never_met_has_the_prior() -> None:
    random = np.random.default_rng(2)
    inputs = random.uniform(0.0, 1.0, (400, 1))
    truth = np.where(inputs[:, 0] < 0.4, 3.0 - 5.0 * inputs[:, 0], 1.0)
    learned = LocalRegression(1, 7.0)
    learned.learn(inputs, truth + random.normal(0.0, 0.2, 400))
    told, support = learned.predict(inputs)
    assert np.sqrt(np.mean((told - truth) ** 2)) < 0.15
    assert (support > 5.0).all()
    far, nothing = learned.predict(np.array([[9.0]]))
    assert far[0] == pytest.approx(7.0)
    assert nothing[0] == pytest.approx(0.0)
    with pytest.raises(InputError, match="2 inputs, expected 1"):
        learned.predict(np.zeros((3, 2)))
    with pytest.raises(ValueError, match=r"inputs must be \(n, inputs\) and measured \(n,\)"):
        learned.learn(inputs, truth[1:])


def test_a_shown_way_comes_to_cost_less_than_the_straight_one() -> None:
    features = np.zeros((21, 21, 3))
    features[:, :, 0] = 1.0
    features[:8, :, 1] = 1.0
    features[13:, :, 2] = 1.0
    shown = np.array(
        [(10 + at, at) for at in range(7)]
        + [(16, col) for col in range(7, 15)]
        + [(30 - col, col) for col in range(15, 21)]
    )
    weights = PathWeights(np.zeros(3))
    seemed = [weights.learn_shown(features, shown, 0.1) for _ in range(60)]
    assert seemed[0] > seemed[-1]
    costs = weights.costs(features)
    assert costs[16, 10] < costs[10, 10] <= costs[3, 10]
    assert weights.prefer(np.array([1.0, 0, 0]), np.array([1.0, 1, 0]), 1.0)
    features[0, 0, 0] = np.nan
    assert np.isinf(weights.costs(features)[0, 0])
    with pytest.raises(InputError, match="a cell has 2 features, there are 3 weights"):
        weights.costs(features[:, 1:, :2])


def test_a_slip_sense_tells_what_changes_with_slip_and_refuses_other_shapes() -> None:
    random = np.random.default_rng(4)

    def statistics(slip: float) -> np.ndarray:
        wave = np.sin(np.arange(100) * math.tau / 100.0)[:, None]
        turns = random.normal(0.0, 0.02, (100, 3)) + 5.0 * slip * wave
        legs = random.normal(0.0, 0.02, (2, 100, 2, 6))
        return gait_statistics(turns, random.normal(0.0, 0.1, (100, 3)), *legs)

    slips = random.uniform(0.0, 0.05, 120)
    all_of = np.array([statistics(slip) for slip in slips])
    sense = SlipSense(all_of[:80], slips[:80])
    off = sense.slip(all_of[80:]) - slips[80:]
    assert np.sqrt(np.mean(off**2)) < 0.2 * slips.std()
    with pytest.raises(ValueError, match=r"statistics must be \(n, 27\)"):
        sense.slip(np.zeros((3, 4)))
    with pytest.raises(InputError, match="0 ticks, at least 3 are needed"):
        gait_statistics(*np.zeros((2, 0, 3)), *np.zeros((2, 0, 2, 6)))
