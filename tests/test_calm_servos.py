"""Claims about dampings: what several servos take from one motion in a step is bounded."""

import mujoco
import numpy as np
import pytest
from biped_builders import SIX, biped

from treadwell.robot.calm_servos import MOST, STEP_S, calmed
from treadwell.robot.loops import drivers


def taken(model: mujoco.MjModel, dampings: dict[int, float]) -> float:
    """The largest share of a motion that the servos take away in a step."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    inverse = np.zeros((model.nv, model.nv))
    mujoco.mj_solveM(model, data, inverse, np.eye(model.nv))
    braking = np.zeros((model.nv, model.nv))
    for joint, damping in dampings.items():
        dof = int(model.jnt_dofadr[joint])
        braking[dof, dof] = damping
    return STEP_S * float(np.abs(np.linalg.eigvals(inverse @ braking)).max())


@pytest.mark.parametrize("damping", [0.01, 1.0, 100.0])
def test_no_motion_is_overdone_and_what_was_calm_is_left_alone(damping: float) -> None:
    model = mujoco.MjModel.from_xml_string(biped(SIX))
    asked = dict.fromkeys(sorted(drivers(model)), damping)
    found = calmed(model, model.qpos0, asked, {})
    assert taken(model, found) <= MOST * 1.001
    assert all(0.0 < found[joint] <= damping for joint in asked)
    if taken(model, asked) <= MOST:
        assert found == asked
    else:
        assert taken(model, found) == pytest.approx(MOST, rel=0.05)


def test_a_heavier_rotor_may_be_damped_more_and_the_model_stays_as_it_is() -> None:
    model = mujoco.MjModel.from_xml_string(biped(SIX))
    before = model.dof_armature.copy()
    asked = dict.fromkeys(sorted(drivers(model)), 100.0)
    knee = int(model.joint("left_3_knee").id)
    light, heavy = (calmed(model, model.qpos0, asked, more)[knee] for more in ({}, {knee: 0.1}))
    assert heavy > light
    assert np.array_equal(model.dof_armature, before)
