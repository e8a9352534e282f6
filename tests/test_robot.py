"""Claims about the robots that ship: they load, and qrio is what it should be."""

import mujoco
import numpy as np
import pytest

from treadwell.errors import InputError
from treadwell.robot.load import Robot, load_robot, robot_names


@pytest.fixture(scope="module")
def qrio() -> Robot:
    return load_robot("qrio")


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


def test_every_shipped_robot_loads_by_its_name() -> None:
    assert "qrio" in robot_names()
    for name in robot_names():
        assert load_robot(name).name == name


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


def test_the_sole_of_the_file_is_the_box_that_touches_the_ground(qrio: Robot) -> None:
    for leg in (qrio.file.legs.left, qrio.file.legs.right):
        geom = qrio.nominal.geom(leg.joints[0].split("_")[0] + "_sole")
        assert qrio.nominal.body(int(geom.bodyid[0])).name == leg.sole.link
        assert 2.0 * geom.size[:2] == pytest.approx([leg.sole.length, leg.sole.width])
        bottom = geom.pos - [0.0, 0.0, geom.size[2]]
        assert bottom == pytest.approx(leg.sole.position, abs=1e-9)


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


@pytest.mark.parametrize("name", ["a" * 300, "a\0b", "", "[" * 5000])
def test_what_no_folder_can_be_called_is_bad_input(name: str) -> None:
    with pytest.raises(InputError, match="there is no robot"):
        load_robot(name)
