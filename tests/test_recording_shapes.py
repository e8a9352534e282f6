"""Claims about the shapes of the recording: they stand where MuJoCo's geoms do."""

import mujoco
import numpy as np
import pytest
from episode_builders import qrio, world

from treadwell.recording.layout import height_colours, plane_colours
from treadwell.recording.shapes import (
    Shapes,
    colours,
    field_triangles,
    multiplied,
    robot_geoms,
    rotated,
)


def test_the_robot_is_drawn_by_what_is_to_be_seen() -> None:
    made = world()
    geoms = robot_geoms(made.model, qrio().root)
    assert len(geoms) > 20
    assert (made.model.geom_group[geoms] < 3).all()


def test_poses_are_those_of_the_geoms() -> None:
    made = world()
    data = made.simulation.data
    data.qpos[7:] += 0.1
    mujoco.mj_kinematics(made.model, data)
    geoms = robot_geoms(made.model, qrio().root)
    shapes = Shapes(made.model, geoms, "robot")
    places, turns = (values[0] for values in shapes._poses(data.xpos[None], data.xquat[None]))
    assert sorted(shapes.geoms) == sorted(geoms)
    assert places == pytest.approx(data.geom_xpos[shapes.geoms], abs=1e-12)
    for turn, expected in zip(turns, data.geom_xmat[shapes.geoms], strict=True):
        matrix = np.empty(9)
        mujoco.mju_quat2Mat(matrix, turn)
        assert matrix == pytest.approx(expected, abs=1e-9)


def test_quaternions_turn_and_multiply_as_mujocos_do() -> None:
    random = np.random.default_rng(0)
    first, second = random.normal(size=(2, 20, 4))
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    vectors, expected, product = random.normal(size=(20, 3)), np.empty(3), np.empty(4)
    for i in range(20):
        mujoco.mju_rotVecQuat(expected, vectors[i], first[i])
        assert rotated(first, vectors)[i] == pytest.approx(expected)
        mujoco.mju_mulQuat(product, first[i], second[i])
        assert multiplied(first, second)[i] == pytest.approx(product)


def test_a_geom_has_the_colour_of_its_material() -> None:
    made = world()
    geoms = robot_geoms(made.model, qrio().root)
    shown = colours(made.model, geoms)
    assert shown.shape == (len(geoms), 4)
    assert len({tuple(row) for row in shown.tolist()}) >= 3


def test_higher_floors_are_brighter() -> None:
    shades = height_colours(np.array([0.0, 0.05, 0.1, 9.0], dtype=np.float32), 0.0, 0.1)
    brightness = shades.astype(int).sum(axis=1)
    assert brightness[0] < brightness[1] < brightness[2] == brightness[3]


def test_points_without_a_plane_are_grey_and_planes_differ() -> None:
    shades = plane_colours(np.array([0, 1, 2, 3], dtype=np.uint16), ground=2)
    assert len({tuple(row) for row in shades.tolist()}) == 4
    assert len(set(shades[0].tolist())) == 1


def test_a_height_field_is_drawn_by_its_triangles() -> None:
    made = world('[[course]]\nkind = "terrain"\nposition = [3.0, 0.0]')
    (geom,) = made.course.elements[0].geom_ids
    corners, faces = field_triangles(made.model, 0)
    normals = np.cross(
        corners[faces[:, 1]] - corners[faces[:, 0]], corners[faces[:, 2]] - corners[faces[:, 0]]
    )
    assert (normals[:, 2] > 0.0).all()
    middles = corners[faces].mean(axis=1)
    there = middles[:, :2] + made.simulation.data.geom_xpos[geom][:2]
    assert middles[:, 2] == pytest.approx(made.course.height_at(there), abs=1e-6)
    assert geom in Shapes(made.model, np.array([geom]), "course").geoms
