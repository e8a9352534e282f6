"""Claims about what the core is told of a robot: it is the MJCF's body, in plain data."""

import json

import mujoco
import numpy as np
import pytest

from treadwell.robot.load import Robot, load_robot, robot_names


@pytest.fixture(scope="module")
def qrio() -> Robot:
    return load_robot("qrio")


def test_every_shipped_robot_describes_itself_in_json() -> None:
    for name in robot_names():
        assert json.loads(json.dumps(load_robot(name).description()))["name"] == name


def test_the_axes_of_each_hip_and_ankle_meet_in_a_point(qrio: Robot) -> None:
    links = {link["name"]: link for link in qrio.description()["links"]}
    for side in ("left", "right"):
        for link in ("hip_roll_link", "thigh", "foot"):
            assert links[f"{side}_{link}"]["position"] == [0.0, 0.0, 0.0]
        assert np.linalg.norm(links[f"{side}_shank"]["position"]) == pytest.approx(0.1)
        assert np.linalg.norm(links[f"{side}_ankle"]["position"]) == pytest.approx(0.105)


def test_the_camera_stands_at_half_a_metre_and_looks_ahead(qrio: Robot) -> None:
    data = mujoco.MjData(qrio.nominal)
    data.qpos[:] = qrio.stand_qpos
    mujoco.mj_kinematics(qrio.nominal, data)
    mujoco.mj_camlight(qrio.nominal, data)
    camera = qrio.description()["camera"]
    assert data.cam_xpos[0][2] == pytest.approx(0.5, abs=0.01)
    rotation = np.empty(9)
    mujoco.mju_quat2Mat(rotation, np.array(camera["orientation"]))
    right, down, forward = rotation.reshape(3, 3).T
    assert forward == pytest.approx([1.0, 0.0, 0.0], abs=1e-9)
    assert right == pytest.approx([0.0, -1.0, 0.0], abs=1e-9)
    assert down == pytest.approx([0.0, 0.0, -1.0], abs=1e-9)
    assert camera["focal"] == pytest.approx(101.4, abs=0.5)


def test_the_gaze_reaches_from_20_to_65_degrees_down_and_60_to_each_side(qrio: Robot) -> None:
    ranges = {
        link["joint"]["name"]: link["joint"]["range"]
        for link in qrio.description()["links"]
        if link["joint"]
    }
    assert ranges["neck_tilt"][0] < np.radians(20.0)
    assert ranges["neck_tilt"][1] > np.radians(65.0)
    assert ranges["neck_pan"][0] < -np.radians(60.0)
    assert ranges["neck_pan"][1] > np.radians(60.0)


def test_the_description_gives_mujocos_kinematics_and_mass_matrix(qrio: Robot) -> None:
    description = qrio.description()
    rng = np.random.default_rng(3)
    angles = rng.uniform(-0.5, 0.5, 26)
    data = mujoco.MjData(qrio.nominal)
    data.qpos[7:] = angles
    mujoco.mj_forward(qrio.nominal, data)
    order = {name: i for i, name in enumerate(description["joints"])}
    places: list[np.ndarray] = []
    centre = np.zeros(3)
    for index, link in enumerate(description["links"]):
        place = np.eye(4)
        if link["parent"] is None:
            place[:3, 3] = data.xpos[1]
        else:
            assert link["parent"] < index
            place[:3, 3] = link["position"]
            place[:3, :3] = matrix(link["orientation"])
            joint = link["joint"]
            turn = np.eye(4)
            quat = np.empty(4)
            mujoco.mju_axisAngle2Quat(quat, np.array(joint["axis"]), angles[order[joint["name"]]])
            turn[:3, :3] = matrix(quat)
            anchor = np.array(joint["anchor"])
            turn[:3, 3] = anchor - turn[:3, :3] @ anchor
            place = places[link["parent"]] @ place @ turn
        places.append(place)
        assert place[:3, 3] == pytest.approx(data.body(link["name"]).xpos, abs=1e-9)
        centre += link["mass"] * (place[:3, :3] @ link["center_of_mass"] + place[:3, 3])
        ixx, iyy, izz = link["inertia"][:3]
        assert 0.0 < max(ixx, iyy, izz) <= 0.5 * (ixx + iyy + izz)
    assert centre / 7.0 == pytest.approx(data.subtree_com[1], abs=1e-9)


def matrix(quat: np.ndarray | list[float]) -> np.ndarray:
    rotation = np.empty(9)
    mujoco.mju_quat2Mat(rotation, np.array(quat, dtype=float))
    return rotation.reshape(3, 3)
