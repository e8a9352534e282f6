"""Claims about what `robot.toml` adds: a model that lacks much becomes the same robot."""

from pathlib import Path

import mujoco
import numpy as np
import pytest
from robot_builders import foreign_robot, qrio_copy

from treadwell.errors import InputError
from treadwell.robot.load import Robot, load_robot
from treadwell.robot.model_gaps import (
    GEAR_SOLREF,
    SOLE_SOLREF,
    prepare_feet,
    straighten_ties,
)


@pytest.fixture(scope="module")
def foreign(tmp_path_factory: pytest.TempPathFactory) -> Robot:
    return load_robot(foreign_robot(tmp_path_factory.mktemp("foreign")))


def test_a_model_that_lacks_much_is_told_to_the_core_as_the_one_that_has_it(
    foreign: Robot,
) -> None:
    ours, theirs = load_robot("qrio").description(), foreign.description()
    for mount in (ours["camera"], theirs["camera"]):
        # A turn and its negative are one.
        mount["orientation"] = np.abs(np.round(mount["orientation"], 9)).tolist()
    assert theirs == ours


def test_its_stance_puts_the_soles_on_the_ground(foreign: Robot) -> None:
    assert foreign.stand_qpos == pytest.approx(load_robot("qrio").stand_qpos, abs=1e-5)
    assert foreign.base == "base"


def test_servos_of_mujoco_become_motors_with_the_peak_torque_of_the_file(foreign: Robot) -> None:
    model, ours = foreign.nominal, load_robot("qrio").nominal
    assert model.nu == ours.nu == len(foreign.actuators)
    assert not model.actuator_biastype.any()
    for joint in foreign.joints:
        found = [
            robot.actuator_ctrlrange[
                list(robot.actuator_trnid[:, 0]).index(robot.joint(joint).id)
            ].tolist()
            for robot in (model, ours)
        ]
        assert found[0] == found[1]


def test_sensors_under_the_soles_and_of_the_unit_are_added(foreign: Robot) -> None:
    data = mujoco.MjData(foreign.nominal)
    data.qpos[:] = foreign.stand_qpos
    mujoco.mj_forward(foreign.nominal, data)
    for name, size in (("left_sole_forces", 6), ("right_sole_forces", 6), ("gyro", 3)):
        assert data.sensor(name).data.size == size


def _with(folder: Path, file: str, old: str, new: str) -> Path:
    robot = qrio_copy(folder)
    text = (robot / file).read_text(encoding="utf-8")
    assert old in text
    (robot / file).write_text(text.replace(old, new), encoding="utf-8")
    return robot


@pytest.mark.slow
@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[gait]", "[stand]\nknee = 1.0\n[gait]", "stand.knee: there is no such joint"),
        ("[gait]", "[ranges]\nneck_pan = [-1, 1]\n[gait]", "ranges.neck_pan: qrio.xml has a range"),
        ("[gait]", "[ranges]\nneck = [-1, 1]\n[gait]", "ranges.neck: there is no such joint"),
        ('site = "imu"', 'site = "imu"\nlink = "torso"', "imu.link: qrio.xml has a site 'imu'"),
        ('site = "imu"', 'site = "x"\nlink = "chest"', "imu.link: there is no link 'chest'"),
        (
            "[camera.stereo]",
            '[camera.mount]\nlink = "head"\nposition = [0, 0, 0]\n[camera.stereo]',
            "camera.mount: qrio.xml has a camera 'camera'",
        ),
    ],
)
def test_what_the_model_has_is_not_said_twice(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        load_robot(_with(tmp_path, "robot.toml", old, new))


def test_motors_may_say_their_joints_damping_friction_and_armature(tmp_path: Path) -> None:
    change = "[motors.neck]\ndamping = 0.2\nfriction = 0.3\narmature = 0.4"
    model = load_robot(_with(tmp_path, "robot.toml", "[motors.neck]", change)).nominal
    neck = int(model.joint("neck_pan").dofadr[0])
    knee = int(model.joint("left_knee_pitch").dofadr[0])
    found = (model.dof_damping[neck], model.dof_frictionloss[neck], model.dof_armature[neck])
    assert found == (0.2, 0.3, 0.4)
    assert model.dof_damping[knee] == 0.1


def test_a_mounted_camera_looks_down_by_what_it_is_tipped(tmp_path: Path) -> None:
    robot = foreign_robot(tmp_path)
    path = robot / "robot.toml"
    text = path.read_text(encoding="utf-8").replace("[camera.mount]", "[camera.mount]\ndown = 0.5")
    path.write_text(text, encoding="utf-8")
    model = load_robot(robot).nominal
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    right, up, back = data.cam_xmat[0].reshape(3, 3).T
    assert -back == pytest.approx([np.cos(0.5), 0.0, -np.sin(0.5)], abs=1e-9)
    assert right == pytest.approx([0.0, -1.0, 0.0], abs=1e-9)
    assert up[2] > 0.8


def test_a_model_gets_the_testbeds_physics_but_for_what_it_says_itself(
    tmp_path: Path,
) -> None:
    robot = qrio_copy(tmp_path)
    text = (robot / "qrio.xml").read_text(encoding="utf-8")
    begin, end = text.index("<option"), text.index("</option>") + len("</option>")
    (robot / "qrio.xml").write_text(text[:begin] + text[end:], encoding="utf-8")
    bare, ours = load_robot(robot).nominal.opt, load_robot("qrio").nominal.opt
    assert bare.cone == ours.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
    assert bare.noslip_iterations == ours.noslip_iterations == 6
    (robot / "qrio.xml").write_text(
        text[:begin] + '<option impratio="3"/>' + text[end:], encoding="utf-8"
    )
    merged = load_robot(robot).nominal.opt
    assert merged.impratio == 3.0
    assert merged.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
    assert merged.noslip_iterations == 6


def test_a_robot_that_has_nothing_to_be_seen_is_seen_as_what_collides(tmp_path: Path) -> None:
    assert (load_robot("qrio").nominal.geom_group == 3).any()
    robot = qrio_copy(tmp_path)
    text = (robot / "qrio.xml").read_text(encoding="utf-8").replace('group="2"', 'group="4"')
    (robot / "qrio.xml").write_text(text, encoding="utf-8")
    assert (load_robot(robot).nominal.geom_group == 2).all()


def test_the_floor_of_a_scene_is_no_part_of_a_robot(tmp_path: Path) -> None:
    floor = '<worldbody><geom name="floor" type="plane" size="1 1 1"/>'
    model = load_robot(_with(tmp_path, "qrio.xml", "<worldbody>", floor)).nominal
    assert model.ngeom == load_robot("qrio").nominal.ngeom


def test_a_gear_is_rigid_where_its_model_does_not_say_how_it_gives() -> None:
    def solved(says: str) -> float:
        spec = mujoco.MjSpec.from_string(f"""
            <mujoco><worldbody><body><geom size="0.1"/><joint name="motor"/>
              <body pos="0 0 1"><geom size="0.1"/><joint name="leg"/></body></body></worldbody>
              <actuator><motor joint="motor"/></actuator>
              <equality><joint joint1="leg" joint2="motor" polycoef="0 2 0 0 0" {says}/></equality>
            </mujoco>""")
        straighten_ties(spec, {"motor"}, "gear")
        return float(spec.compile().eq_solref[0, 0])

    assert solved("") == GEAR_SOLREF[0]
    assert solved('solref="0.03 1"') == 0.03


_FEET = """<mujoco><option integrator="implicitfast"/><worldbody>
    <geom name="floor" type="plane" size="1 1 1" friction="0.7 0.005 0.0001"/>
    <body name="shank" pos="0 0 0.499"><freejoint/><geom type="sphere" size="0.05" mass="30"/>
      <body name="plain" pos="0.3 0 -0.47">
        <geom name="plain" type="box" size="0.1 0.1 0.03"/>
      </body>
      <body name="said" pos="-0.3 0 -0.47">
        <geom name="said" type="box" size="0.1 0.1 0.03" solref="0.004 1"/>
      </body></body></worldbody></mujoco>"""


def test_soles_are_as_hard_as_those_of_the_testbed_where_the_model_does_not_say_how_they_give() -> (
    None
):
    spec = mujoco.MjSpec.from_string(_FEET)
    before = spec.compile()
    prepare_feet(spec, {"plain", "said"})
    model = spec.compile()
    assert model.geom("plain").solref.tolist() == list(SOLE_SOLREF)
    assert load_robot("qrio").nominal.geom("left_sole").solref.tolist() == list(SOLE_SOLREF)
    for field in ("solref", "solimp", "solmix"):
        for geom in ("said", "floor"):
            ours, theirs = getattr(model.geom(geom), field), getattr(before.geom(geom), field)
            assert ours.tolist() == theirs.tolist()
    # What slips, and on which side that is decided, stays as it is.
    for field in ("friction", "condim", "priority"):
        assert np.array_equal(getattr(model, f"geom_{field}"), getattr(before, f"geom_{field}"))


def test_the_ground_gives_as_a_hard_sole_does_and_not_half_as_much_again() -> None:
    spec = mujoco.MjSpec.from_string(_FEET)
    prepare_feet(spec, {"plain"})
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    solrefs = [
        contact.solref[0]
        for contact in data.contact
        if model.geom("plain").id in (contact.geom1, contact.geom2)
    ]
    assert solrefs
    assert solrefs == pytest.approx([SOLE_SOLREF[0]] * len(solrefs), rel=0.01)
