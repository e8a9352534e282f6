"""Claims about soles: what of a foot touches the ground, whatever shapes it is made of."""

import math

import mujoco
import numpy as np
import pytest
from biped_builders import BOX_FOOT, SIX, biped
from hypothesis import given, settings
from hypothesis import strategies as st

from treadwell.robot.anatomy import Anatomy
from treadwell.robot.soles import Sole
from treadwell.robot.surfaces import Cloud, cloud_of, outline_area

SPHERES = "".join(
    f'<geom type="sphere" size="0.005" pos="{x} {y} -0.03"/>'
    for x, y in ((0.09, 0.03), (0.09, -0.03), (-0.05, 0.025), (-0.05, -0.025))
)
CAPSULES = "".join(
    f'<geom type="capsule" size="0.01" fromto="-0.04 {y} -0.03 0.08 {y} -0.03"/>'
    for y in (0.03, -0.03)
)
TURNED = '<geom type="box" size="0.01 0.035 0.06" pos="0.015 0 -0.03" euler="0 1.5708 0"/>'
TILTED = '<geom type="box" size="0.06 0.035 0.01" pos="0.015 0 -0.03" euler="0 0.3 0"/>'


def left_sole(foot: str) -> Sole:
    model = mujoco.MjModel.from_xml_string(biped(SIX, foot))
    return Anatomy.of(model).legs()["left"].sole


@pytest.mark.parametrize(
    ("foot", "position", "length", "width"),
    [
        (BOX_FOOT, (0.015, 0.0, -0.04), 0.12, 0.07),
        (TURNED, (0.015, 0.0, -0.04), 0.12, 0.07),
        (SPHERES, (0.02, 0.0, -0.035), 0.14, 0.06),
        (CAPSULES, (0.02, 0.0, -0.04), 0.12, 0.06),
    ],
)
def test_the_rectangle_is_around_what_touches(
    foot: str, position: tuple[float, float, float], length: float, width: float
) -> None:
    sole = left_sole(foot)
    assert sole.position == pytest.approx(position, abs=1e-5)
    assert (sole.length, sole.width) == pytest.approx((length, width), abs=1e-5)
    assert sole.orientation is None
    assert sole.bears


def test_a_sole_that_is_tilted_in_its_link_says_so_and_is_as_large() -> None:
    sole = left_sole(TILTED)
    assert sole.orientation is not None
    assert 2.0 * math.acos(abs(sole.orientation[0])) == pytest.approx(0.3, abs=1e-3)
    assert (sole.length, sole.width) == pytest.approx((0.12, 0.07), abs=1e-4)
    normal = np.array([math.sin(0.3), 0.0, math.cos(0.3)])
    assert sole.in_link @ normal == pytest.approx(
        np.array([0.015, 0.0, -0.03]) @ normal - 0.01, abs=1e-4
    )


def test_three_points_bear_less_than_the_rectangle_around_them() -> None:
    three = SPHERES.replace('<geom type="sphere" size="0.005" pos="-0.05 -0.025 -0.03"/>', "")
    sole = left_sole(three.replace("-0.05 0.025", "-0.05 0"))
    assert sole.filled == pytest.approx(0.5)
    assert sole.width == pytest.approx(0.03)


@given(
    st.floats(0.01, 0.2),
    st.floats(0.01, 0.2),
    st.floats(-math.pi, math.pi),
)
@settings(max_examples=40, deadline=None)
def test_the_outline_of_a_turned_rectangle_has_its_area(a: float, b: float, turn: float) -> None:
    corners = np.array([[a, b], [a, -b], [-a, b], [-a, -b], [0.0, 0.0], [0.5 * a, 0.0]])
    cos, sin = math.cos(turn), math.sin(turn)
    turned = corners @ np.array([[cos, sin], [-sin, cos]])
    assert outline_area(turned) == pytest.approx(4.0 * a * b, rel=1e-9)


def test_every_kind_of_shape_is_as_low_as_mujoco_has_it() -> None:
    shapes = (
        '<geom type="sphere" size="0.1"/>',
        '<geom type="capsule" size="0.1 0.2" euler="0.3 0.4 0"/>',
        '<geom type="cylinder" size="0.1 0.2" euler="0.3 0.4 0"/>',
        '<geom type="box" size="0.1 0.2 0.3" euler="0.3 0.4 0"/>',
        '<geom type="ellipsoid" size="0.1 0.2 0.3" euler="0.3 0.4 0"/>',
    )
    for shape in shapes:
        model = mujoco.MjModel.from_xml_string(
            f"<mujoco><compiler angle='radian'/><worldbody><geom type='plane' size='9 9 1'/>"
            f"<body pos='0 0 2'><freejoint/>{shape}</body></worldbody></mujoco>"
        )
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        cloud: Cloud = cloud_of(model, data, [1])
        seen = mujoco.mj_geomDistance(model, data, 0, 1, 10.0, np.zeros(6))
        lowest = cloud.lowest(np.array([0.0, 0.0, 1.0]))[:, 2].min()
        assert lowest == pytest.approx(seen, abs=1.5e-3), shape
