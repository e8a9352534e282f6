"""Claims about the robots' folders: qrio is what it should be, and broken folders are refused."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np
import pytest
from treadwell.data import data_folder
from treadwell.errors import InputError
from treadwell.robot import Robot, load_robot, robot_names

Edit = Callable[[str, str, str], Path]


@pytest.fixture(scope="module")
def qrio() -> Robot:
    return load_robot("qrio")


@pytest.fixture
def edited(tmp_path: Path) -> Edit:
    """A copy of qrio's folder in which one file had a text replaced."""

    def edit(file: str, old: str, new: str) -> Path:
        folder = tmp_path / "robot"
        if not folder.exists():
            shutil.copytree(data_folder("models") / "qrio", folder)
        text = (folder / file).read_text(encoding="utf-8")
        assert old in text
        (folder / file).write_text(text.replace(old, new), encoding="utf-8")
        return folder

    return edit


def pose(robot: Robot, angles: np.ndarray | None = None) -> mujoco.MjData:
    """The nominal model in the keyframe, or with its soles on the ground at other angles."""
    data = mujoco.MjData(robot.nominal)
    data.qpos[:] = robot.stand_qpos
    if angles is not None:
        data.qpos[7:] = angles
        mujoco.mj_kinematics(robot.nominal, data)
        data.qpos[2] -= data.site("left_sole").xpos[2]
    mujoco.mj_forward(robot.nominal, data)
    return data


def test_every_shipped_robot_loads_and_describes_itself_in_json() -> None:
    assert "qrio" in robot_names()
    for name in robot_names():
        assert json.loads(json.dumps(load_robot(name).description()))["name"] == name


def test_qrio_weighs_seven_kilograms_and_has_26_motors(qrio: Robot) -> None:
    assert qrio.nominal.body_subtreemass[1] == pytest.approx(7.0, abs=1e-9)
    assert len(qrio.joints) == qrio.nominal.nu == 26


def test_qrio_stands_58_centimetres_high_on_straight_legs(qrio: Robot) -> None:
    data = pose(qrio, np.zeros(26))
    model = qrio.nominal
    tops = []
    for geom in range(model.ngeom):
        rotation = data.geom_xmat[geom].reshape(3, 3)
        centre, half = model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]
        extent = np.abs(rotation[2]) @ half
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
            extent = np.linalg.norm(rotation[2] * model.geom_size[geom])
        tops.append(data.geom_xpos[geom, 2] + rotation[2] @ centre + extent)
    assert max(tops) == pytest.approx(0.58, abs=1e-3)


def test_in_the_keyframe_the_soles_lie_flat_and_the_weight_is_over_them(qrio: Robot) -> None:
    data = pose(qrio)
    for side, y in (("left", 0.0425), ("right", -0.0425)):
        site = data.site(f"{side}_sole")
        assert site.xpos == pytest.approx([0.0, y, 0.0], abs=1e-5)
        assert site.xmat.reshape(3, 3) == pytest.approx(np.eye(3), abs=1e-5)
    assert data.subtree_com[1][:2] == pytest.approx([0.0, 0.0], abs=2e-3)
    assert data.xpos[1][2] == pytest.approx(0.223, abs=1e-4)


def test_the_axes_of_each_hip_and_ankle_meet_in_a_point(qrio: Robot) -> None:
    links = {link["name"]: link for link in qrio.description()["links"]}
    for side in ("left", "right"):
        for link in ("hip_roll_link", "thigh", "foot"):
            assert links[f"{side}_{link}"]["position"] == [0.0, 0.0, 0.0]
        assert np.linalg.norm(links[f"{side}_shank"]["position"]) == pytest.approx(0.1)
        assert np.linalg.norm(links[f"{side}_ankle"]["position"]) == pytest.approx(0.105)


def test_the_sole_of_the_file_is_the_box_that_touches_the_ground(qrio: Robot) -> None:
    for leg in (qrio.file.legs.left, qrio.file.legs.right):
        geom = qrio.nominal.geom(leg.joints[0].split("_")[0] + "_sole")
        assert qrio.nominal.body(int(geom.bodyid[0])).name == leg.sole.link
        assert 2.0 * geom.size[:2] == pytest.approx([leg.sole.length, leg.sole.width])
        bottom = geom.pos - [0.0, 0.0, geom.size[2]]
        assert bottom == pytest.approx(leg.sole.position, abs=1e-9)


def test_the_camera_stands_at_half_a_metre_and_looks_ahead(qrio: Robot) -> None:
    data = pose(qrio)
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


def test_a_specification_is_fresh_each_time_and_takes_a_course(qrio: Robot) -> None:
    spec = qrio.spec()
    body = spec.worldbody.add_body()
    body.add_geom(size=[0.1, 0.1, 0.1])
    body.add_freejoint()
    assert spec.compile().nq == qrio.nominal.nq + 7
    assert qrio.spec().compile().nq == qrio.nominal.nq


def test_legs_touch_each_other_but_a_leg_does_not_touch_itself(qrio: Robot) -> None:
    angles = qrio.stand.copy()
    angles[1], angles[7] = -0.3, 0.3
    data = pose(qrio, angles)
    pairs = {
        frozenset(qrio.nominal.geom(int(geom)).name for geom in contact.geom)
        for contact in data.contact
    }
    assert pairs
    assert all({name.split("_")[0] for name in pair} == {"left", "right"} for pair in pairs)
    assert pose(qrio).ncon == 0


def test_an_unknown_robot_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(InputError, match=r"'qroi'.*qrio.*did you mean 'qrio'"):
        load_robot("qroi")


@pytest.mark.parametrize("file", ["robot.toml", "qrio.xml"])
def test_a_missing_file_is_named(edited: Edit, file: str) -> None:
    folder = edited("robot.toml", "qrio", "qrio")
    (folder / file).unlink()
    with pytest.raises(InputError, match=file):
        load_robot(folder)


BROKEN = [
    ("qrio.xml", "<worldbody>", "<worldbod>", r"qrio\.xml"),
    ("qrio.xml", 'mass="2.1"', 'mass="nan"', r"qrio\.xml"),
    ("qrio.xml", 'mass="2.1"', 'mass="-1"', r"qrio\.xml"),
    ("qrio.xml", 'timestep="0.002"', 'timestep="0.005"', "timestep must be 0.002, got 0.005"),
    ("qrio.xml", 'name="stand"', 'name="sit"', "no keyframe 'stand'"),
    ("qrio.xml", ' range="-0.05 2.5"', "", "'left_knee_pitch' needs a range"),
    ("qrio.xml", ' range="-0.05 2.5"', ' range="1.2 2.5"', "keyframe 'stand'.*'left_knee_pitch'"),
    ("qrio.xml", '<freejoint name="base"/>', "", "invalid qpos size"),
    (
        "qrio.xml",
        '<motor ctrlrange="-1 1"/>',
        '<motor ctrlrange="-2 2"/>',
        "motors.neck.*ctrlrange",
    ),
    ("robot.toml", "[head]", "[head", "TOML"),
    ("robot.toml", "kp = 150.0", "kp = 0.0", r"motors\.hip_and_knee\.kp.*greater than 0, got 0"),
    ("robot.toml", "kp = 150.0", "kp = nan", r"motors\.hip_and_knee\.kp"),
    ("robot.toml", "kp = 150.0", "kb = 150.0", r"motors\.hip_and_knee\.kb: unknown key"),
    ("robot.toml", "period = 0.08", "period = 0.085", "multiple of the control tick"),
    ("robot.toml", "stall_torque = 1.4", "stall_torque = 0.4", "must not be below peak_torque"),
    (
        "robot.toml",
        '"waist_yaw", "waist_pitch"',
        '"waist_yaw", "waist"',
        "no joint 'waist'.*waist_p",
    ),
    ("robot.toml", '["neck_pan", "neck_tilt"]', '["neck_pan"]', "no group has.*neck_tilt"),
    ("robot.toml", '["neck_pan", "neck_tilt"]', '["neck_pan", "neck_tilt", "waist_yaw"]', "too"),
    (
        "robot.toml",
        '"left_knee_pitch", "left_ankle',
        '"right_knee_pitch", "left_ankle',
        "chain of six",
    ),
    (
        "robot.toml",
        '"left_hip_yaw", "left_hip_roll", "left_hip_pitch", "left_knee_pitch", "left_ankle',
        '"left_hip_roll", "left_hip_pitch", "left_knee_pitch", "left_ankle',
        r"legs\.left\.joints",
    ),
    (
        "robot.toml",
        'link = "left_foot"',
        'link = "left_ankle"',
        r"legs\.left\.sole\.link.*'left_foot'",
    ),
    ("robot.toml", "[0.0, 0.0, -0.045]", "[0.0, 0.0, -0.04]", r"legs\.left\.sole.*5\.0 mm"),
    ("robot.toml", 'name = "camera"', 'name = "webcam"', r"camera\.name.*'webcam'.*has camera"),
    ("robot.toml", "horizontal_fov = 0.8203", "horizontal_fov = 1.2", "square"),
    (
        "robot.toml",
        'pan = "neck_pan"',
        'pan = "left_hip_yaw"',
        "head.pan.*does not move the camera",
    ),
    ("robot.toml", 'gyro = "gyro"', 'gyro = "accelerometer"', "imu.gyro.*must be a <gyro>"),
    (
        "robot.toml",
        "left_elbow_pitch = -0.5",
        "left_elbow_pitch = 0.5",
        "arms.rest.left_elbow_pitch",
    ),
    ("robot.toml", 'torso = "torso"', 'torso = "chest"', "body.torso.*no link 'chest'.*pelvis"),
    ("robot.toml", 'model = "qrio.xml"', 'model = "../qrio.xml"', r"robot\.model"),
]


@pytest.mark.parametrize(("file", "old", "new", "message"), BROKEN)
def test_a_broken_folder_is_refused_with_file_and_key(
    edited: Edit, file: str, old: str, new: str, message: str
) -> None:
    folder = edited(file, old, new)
    with pytest.raises(InputError, match=message) as error:
        load_robot(folder)
    assert str(folder) in str(error.value)
