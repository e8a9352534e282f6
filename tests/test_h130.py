"""Claims about the robot h130: its size, its motors, and that it stands on them."""

from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest
from source_builders import DATA, needs_data

from treadwell.physics.simulation import Simulation
from treadwell.protocols import JointTargets
from treadwell.robot.load import Robot, load_robot

OF_T1 = {
    "hip_yaw": "Hip_Yaw",
    "hip_roll": "Hip_Roll",
    "hip_pitch": "Hip_Pitch",
    "knee_pitch": "Knee_Pitch",
    "ankle_pitch": "Ankle_Pitch",
    "ankle_roll": "Ankle_Roll",
}
MOST = 1.5


@pytest.fixture(scope="module")
def h130() -> Robot:
    return load_robot("h130")


def peak_torques(robot: Robot) -> dict[str, float]:
    motors = robot.file.motors.values()
    return {joint: motor.peak_torque for motor in motors for joint in motor.joints}


def test_it_has_the_size_of_a_robot_for_stairs_that_people_use(h130: Robot) -> None:
    model = h130.nominal
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    visible = [geom for geom in range(model.ngeom) if model.geom_group[geom] == 2]
    head = max(data.geom_xpos[geom, 2] + model.geom_size[geom].max() for geom in visible)
    assert head == pytest.approx(1.3, abs=0.02)
    assert model.body_mass.sum() >= 35.0


@needs_data
def test_its_legs_have_at_most_one_and_a_half_of_t1s_torques(h130: Robot) -> None:
    path = Path(str(DATA)) / "robots" / "booster_t1" / "t1.xml"
    if not path.is_file():
        pytest.skip("TREADWELL_DATA has no T1")
    joints = {joint.get("name"): joint for joint in ElementTree.parse(path).iter("joint")}
    ours = peak_torques(h130)
    for side in ("left", "right"):
        for joint, theirs in OF_T1.items():
            found = joints[f"{side.capitalize()}_{theirs}"]
            most = MOST * float(str(found.get("actuatorfrcrange")).split()[1])
            assert ours[f"{side}_{joint}"] <= most + 1e-9, joint


def test_it_stands_as_in_its_keyframe_on_half_of_its_torques(h130: Robot) -> None:
    simulation = Simulation(h130.nominal, h130)
    stand = np.array(simulation.joint_positions)
    still = np.zeros_like(stand)
    for _ in range(100):
        simulation.advance(JointTargets(stand, still, still))
    torques = np.abs(simulation.data.ctrl)
    peaks = peak_torques(h130)
    for name, torque in zip(h130.actuators, torques, strict=True):
        assert torque < 0.5 * peaks[name], name
    assert np.abs(simulation.joint_positions - stand).max() < 0.05
