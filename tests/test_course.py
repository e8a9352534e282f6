"""Courses: where things stand, how high their tops are, and what cannot be started on."""

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadwell.course.assets import read_mjcf
from treadwell.course.build import build_course
from treadwell.course.course import Course
from treadwell.course.geometry import COLOURS, GROUND, PARKED
from treadwell.course.outlines import rectangle, signed_distance
from treadwell.course.plan import all_elements
from treadwell.course.scatter import LOWEST, Ground
from treadwell.course.stairs import stairs_pieces, treads_of
from treadwell.errors import InputError
from treadwell.robot.load import load_robot
from treadwell.scenario.elements import ELEMENTS, Stairs
from treadwell.scenario.loading import load_scenario, scenario_names
from treadwell.scenario.model import Scenario

ROBOT = load_robot("qrio")
DRAWN = {"scatter", "house", "yard", "flights", "vegetation", "rubble", "slabs", "terrain"}
"""Kinds that another seed makes another course."""


def scenario_of(*course: dict[str, Any], **tables: object) -> Scenario:
    head = {"schema": 1, "name": "x", "start": {}, "goal": {}}
    return Scenario.model_validate({**head, "course": list(course), **tables})


def course_of(*course: dict[str, Any], **tables: object) -> Course:
    return build_course(scenario_of(*course, **tables), ROBOT)


def ray_height(course: Course, x: float, y: float) -> float:
    """Height of what a ray from above meets first, by MuJoCo."""
    data = mujoco.MjData(course.model)
    data.qpos[:] = course.qpos
    data.qpos[0] += 50.0  # the robot out of the way
    mujoco.mj_forward(course.model, data)
    geom = np.zeros(1, dtype=np.int32)
    start = np.array([x, y, 5.0])
    distance = mujoco.mj_ray(
        course.model, data, start, np.array([0.0, 0.0, -1.0]), None, 1, -1, geom
    )
    return 5.0 - float(distance)


@pytest.mark.slow
@pytest.mark.parametrize("name", scenario_names())
def test_every_shipped_scenario_can_be_built_for_many_seeds(name: str) -> None:
    draws = any(element.kind in DRAWN for element in load_scenario(name).course)
    for seed in range(20 if draws else 5):
        assert build_course(load_scenario(name, seed=seed), ROBOT).model.ngeom > 0


@pytest.mark.parametrize(
    "kind",
    sorted(set(ELEMENTS) - {"mesh", "mjcf", "scatter", "house", "yard", "flights", "vegetation"}),
)
def test_every_kind_is_built_with_a_colour_and_no_contact_at_rest(kind: str) -> None:
    course = course_of({"kind": kind, "position": [2.0, 0.0]} if kind != "wall" else {"kind": kind})
    element = course.elements[0]
    assert element.geom_ids
    assert len(element.geom_ids) == len(element.pieces)
    assert kind in COLOURS
    walkable = {"stairs", "sill", "platform", "ramp", "patch", "terrain", "slabs"}
    assert element.walkable == (kind in walkable)


def test_stairs_are_as_high_and_deep_as_their_lists_say() -> None:
    course = course_of(
        {
            "kind": "stairs",
            "steps": 3,
            "rise": [0.02, 0.03, 0.05],
            "tread": [0.10, 0.20, 9.0],
            "landing": 0.4,
            "position": [1.0, 0.0],
        }
    )
    at = [
        (0.999, 0.0),
        (1.001, 0.02),
        (1.099, 0.02),
        (1.101, 0.05),
        (1.299, 0.05),
        (1.301, 0.10),
        (1.699, 0.10),
        (1.701, 0.0),
    ]
    for x, height in at:
        assert course.height_at(np.array([[x, 0.1]]))[0] == pytest.approx(height)
        assert ray_height(course, x, 0.1) == pytest.approx(height, abs=1e-6)
    assert [top.part for top in course.elements[0].tops] == ["step 1", "step 2", "step 3"]


def test_a_descent_has_the_same_steps_down_again() -> None:
    course = course_of(
        {
            "kind": "stairs",
            "steps": 3,
            "rise": [0.02, 0.03, 0.05],
            "tread": [0.10, 0.20, 0.1],
            "landing": 0.4,
            "position": [1.0, 0.0],
            "descent": True,
        }
    )
    for back, height in [(0.01, 0.02), (0.09, 0.02), (0.11, 0.05), (0.29, 0.05), (0.31, 0.10)]:
        for x in (1.0 + back, 2.0 - back):
            assert ray_height(course, x, 0.0) == pytest.approx(height, abs=1e-6)
    parts = [top.part for top in course.elements[0].tops]
    assert parts == ["step 1", "step 2", "step 3", "step 2 down", "step 1 down"]


STAIRS = st.fixed_dictionaries(
    {
        "kind": st.just("stairs"),
        "steps": st.integers(1, 6),
        "rise": st.floats(0.01, 0.1),
        "tread": st.floats(0.08, 0.3),
        "landing": st.floats(0.1, 0.5),
        "width": st.floats(0.2, 0.8),
        "turn": st.floats(-0.3, 0.3, allow_subnormal=False),
        "yaw": st.floats(-3.0, 3.0, allow_subnormal=False),
        "descent": st.booleans(),
    }
)


@given(table=STAIRS, share=st.floats(-0.95, 0.95))
@settings(deadline=None)
def test_no_gap_opens_between_blocks_that_turn(table: dict[str, Any], share: float) -> None:
    """Along every line beside the middle one there is always a block under the tops' height."""
    stairs = Stairs.model_validate(table)
    pieces, tops = stairs_pieces(stairs)
    treads = treads_of(stairs)
    for first, second in pairwise(treads):
        np.testing.assert_allclose(first.back, second.front)
        lower = min(first.height, second.height)
        turn = (first.yaw + second.yaw) / 2
        left = np.array([-math.sin(turn), math.cos(turn)]) * share * stairs.width / 2
        ahead = np.array([math.cos(turn), math.sin(turn)])
        way = np.linspace(-0.03, 0.03, 13)[:, None] * ahead + first.back + left
        covered = np.zeros(len(way), dtype=bool)
        for piece in pieces:
            if piece.vertices[:, 2].max() >= lower - 1e-9:
                covered |= signed_distance(piece.outline, way) <= 1e-9
        assert covered.all()
    assert len(tops) == len(pieces) == len(treads)


@given(table=STAIRS)
@settings(deadline=None, max_examples=30)
def test_tops_do_not_overlap_and_lie_on_their_blocks(table: dict[str, Any]) -> None:
    stairs = Stairs.model_validate(table)
    pieces, tops = stairs_pieces(stairs)
    for i, (piece, top) in enumerate(zip(pieces, tops, strict=True)):
        assert top.height == pytest.approx(piece.vertices[:, 2].max())
        assert (signed_distance(piece.outline, top.polygon[:, :2]) < 1e-9).all()
        if i + 1 < len(tops):
            middle = top.polygon[:, :2].mean(axis=0)[None]
            assert not tops[i + 1].contains(middle)[0]


def test_a_ramp_rises_evenly_and_a_sill_and_a_platform_are_level() -> None:
    course = course_of(
        {"kind": "ramp", "position": [1.0, 0.0], "length": 1.0, "rise": 0.1},
        {"kind": "sill", "position": [3.0, 0.0]},
        {"kind": "platform", "position": [4.0, 0.0]},
    )
    for x, height in [(1.1, 0.01), (1.5, 0.05), (1.95, 0.095), (3.05, 0.038), (4.0, 0.03)]:
        assert course.height_at(np.array([[x, 0.0]]))[0] == pytest.approx(height)
        assert ray_height(course, x, 0.0) == pytest.approx(height, abs=1e-6)


def test_a_curtain_hangs_above_a_free_floor() -> None:
    course = course_of({"kind": "box", "position": [1.0, 0.0], "base": 0.3})
    low = course.elements[0].pieces[0].vertices[:, 2].min()
    assert low == pytest.approx(0.3)
    assert ray_height(course, 1.0, 0.0) == pytest.approx(0.6)
    assert course.height_at(np.array([[1.0, 0.0]]))[0] == 0.0


def test_rubble_reaches_its_amplitude_and_not_more() -> None:
    course = course_of({"kind": "rubble", "amplitude": 0.04})
    heights = [piece.vertices[:, 2].max() for piece in course.elements[0].pieces]
    assert max(heights) == pytest.approx(0.04)
    assert min(heights) < 0.03


def test_friction_holds_for_every_pair_and_masses_scale() -> None:
    plain = course_of()
    changed = course_of(physics={"friction": 0.55, "mass_scale": 1.1})
    assert (changed.model.geom_friction[:, 0] == 0.55).all()
    assert changed.model.body_mass.sum() == pytest.approx(1.1 * plain.model.body_mass.sum())
    assert changed.model.body_subtreemass[0] == pytest.approx(changed.model.body_mass.sum())


def test_the_standing_robot_touches_the_floor_with_its_soles_only() -> None:
    course = course_of({"kind": "platform", "position": [0.0, 0.0], "size": [1.0, 1.0, 0.2]})
    data = mujoco.MjData(course.model)
    data.qpos[:] = course.qpos
    mujoco.mj_forward(course.model, data)
    assert course.start.height == pytest.approx(0.2)
    assert data.ncon > 0
    for contact in data.contact:
        assert abs(contact.dist) < 2e-3
        assert set(course.geom_element[contact.geom]) == {-1, 0}


def test_a_named_height_chooses_between_levels() -> None:
    block = {"kind": "platform", "position": [2.0, 0.0], "size": [1.0, 1.0, 0.3]}
    assert course_of(block).goal_height == pytest.approx(0.3)
    assert course_of(block, goal={"height": 0.31}).goal_height == pytest.approx(0.3)
    with pytest.raises(InputError, match=r"goal\.height: found 0; there is a void"):
        course_of(block, goal={"height": 0.0})


@pytest.mark.slow
@pytest.mark.parametrize(
    ("course", "tables", "expected"),
    [
        ([{"kind": "box", "position": [0.0, 0.1]}], {}, "inside the obstacle 'box'"),
        ([{"kind": "box", "position": [0, 0], "size": [9, 9, 9]}], {}, "inside the obstacle"),
        ([{"kind": "box", "position": [0, 0], "base": 0.4}], {}, "inside the obstacle 'box'"),
        ([{"kind": "stairs", "position": [0.02, 0.0]}], {}, "inside the obstacle 'stairs'"),
        ([], {"start": {"height": 0.2}}, "void"),
        ([{"kind": "platform", "position": [0.33, 0.0], "size": [0.7, 1.0, 0.2]}], {}, "void"),
        ([], {"event": [{"at": 1, "do": "encoder_offset", "joint": "left_kne", "value": 0.1}]},
         "did you mean 'left_knee_pitch'"),
        ([{"kind": "scatter", "name": "s"}],
         {"event": [{"at": 1, "do": "remove", "name": "s"}]}, "an element of one body, neither"),
        ([{"kind": "scatter", "count": 200, "area": [[0, 0], [1, 1]]}], {}, "no layout"),
    ],
)  # fmt: skip
def test_a_course_that_cannot_be_started_on_is_bad_input(
    course: list[dict[str, Any]], tables: dict[str, Any], expected: str
) -> None:
    with pytest.raises(InputError, match=expected):
        course_of(*course, **tables)


def test_a_box_that_hangs_above_the_head_is_no_obstacle_to_starting() -> None:
    assert course_of({"kind": "box", "position": [0.0, 0.0], "base": 0.7}).elements


@pytest.mark.parametrize("seed", range(5))
def test_scattered_obstacles_leave_a_way_and_come_again_with_the_seed(seed: int) -> None:
    table = {"kind": "scatter", "count": 12}
    first, second = course_of(table, seed=seed), course_of(table, seed=seed)
    assert len(first.elements) == 12
    for a, b in zip(first.elements, second.elements, strict=True):
        assert a.name == b.name
        np.testing.assert_array_equal(a.pieces[0].vertices, b.pieces[0].vertices)
        assert a.pieces[0].vertices[:, 2].max() >= LOWEST - 1e-9
    stops = [np.array([0.0, 0.0]), np.array([2.0, 0.0])]
    outlines = [element.pieces[0].outline for element in first.elements]
    ground = Ground(stops, [], ((0.5, -0.8), (2.5, 0.8)), 2 * ROBOT.file.body.radius + 0.1)
    assert ground.is_connected(outlines)


def test_a_closed_ring_leaves_no_way() -> None:
    stops = [np.array([0.0, 0.0]), np.array([2.0, 0.0])]
    ground = Ground(stops, [], ((0.0, 0.0), (1.0, 1.0)), 0.38)
    sides = [(1, 0, 0.1, 2), (-1, 0, 0.1, 2), (0, 1, 2, 0.1), (0, -1, 2, 0.1)]
    ring = [rectangle((x, y), 0.0, (-a / 2, a / 2), b) for x, y, a, b in sides]
    assert not ground.is_connected(ring)
    assert ground.is_connected(ring[1:])


def test_another_seed_scatters_otherwise() -> None:
    table = {"kind": "scatter"}
    a, b = course_of(table, seed=0), course_of(table, seed=1)
    assert not np.array_equal(a.elements[0].origin, b.elements[0].origin)


def test_what_events_bring_is_parked_below_the_ground_at_first() -> None:
    course = course_of(
        {"kind": "cylinder", "name": "post"},
        event=[{"at": 1, "do": "add", "element": {"kind": "wall"}},
               {"at": 2, "do": "move", "name": "post", "to": [0, 1]}],
    )  # fmt: skip
    post, wall = course.element("post"), course.element("wall")
    assert post is not None
    assert wall is not None
    assert (post.present, wall.present) == (True, False)
    data = mujoco.MjData(course.model)
    assert data.mocap_pos[wall.mocap_id, 2] == PARKED
    np.testing.assert_allclose(data.mocap_pos[post.mocap_id], post.origin)
    assert ray_height(course, 1.2, -0.4) == pytest.approx(0.4)
    assert ray_height(course, 1.5, 1.0) == pytest.approx(0.0, abs=1e-6)
    assert course.element("none") is None
    assert [name for name, _, _ in all_elements(scenario_of({"kind": "box"}))] == ["box"]


def test_texture_and_element_are_known_for_every_geom() -> None:
    course = course_of({"kind": "box", "texture": 0.25}, {"kind": "stairs", "mapped": False})
    box, stairs = course.elements
    assert (course.texture[list(box.geom_ids)] == 0.25).all()
    assert (course.geom_element[list(stairs.geom_ids)] == 1).all()
    assert course.texture[course.model.geom(GROUND).id] == 1.0
    assert not stairs.mapped


TETRAHEDRON = "v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nv 0 0 0.2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def test_a_mesh_stands_where_the_file_puts_it(tmp_path: Path) -> None:
    (tmp_path / "t.obj").write_text(TETRAHEDRON)
    text = 'schema = 1\nname = "x"\n[start]\n[goal]\n[[course]]\nkind = "mesh"\nfile = "t.obj"\n'
    path = tmp_path / "x.toml"
    path.write_text(text + f"position = [1.0, 0.5, 0.1]\nyaw = {math.pi / 2}\n")
    course = build_course(load_scenario(path), ROBOT)
    vertices = course.elements[0].pieces[0].vertices
    np.testing.assert_allclose(vertices.min(axis=0), [0.8, 0.5, 0.1], atol=1e-6)
    np.testing.assert_allclose(vertices.max(axis=0), [1.0, 0.7, 0.3], atol=1e-6)
    assert ray_height(course, 0.95, 0.55) == pytest.approx(0.2, abs=1e-5)


def test_an_mjcf_world_is_added_with_its_boxes_to_walk_on(tmp_path: Path) -> None:
    (tmp_path / "room.xml").write_text(
        "<mujoco><worldbody><geom name='step' type='box' size='.2 .3 .02' pos='1 0 .02'/>"
        "<body pos='2 1 0'><geom type='cylinder' size='.1 .2' pos='0 0 .2'/></body>"
        "</worldbody></mujoco>"
    )
    head = 'schema = 1\nname = "x"\n[start]\n[goal]\n[[course]]\nkind = "mjcf"\n'
    path = tmp_path / "x.toml"
    path.write_text(head + 'file = "room.xml"\n')
    course = build_course(load_scenario(path), ROBOT)
    assert len(course.elements[0].geom_ids) == 2
    assert course.height_at(np.array([[1.0, 0.0]]))[0] == pytest.approx(0.04)
    assert ray_height(course, 2.0, 1.0) == pytest.approx(0.4)


@pytest.mark.parametrize(
    "body",
    [
        "<worldbody><geom size='nan'/></worldbody>",
        "<worldbody><geom",
        "<include file='../other.xml'/>",
        "<include file='/etc/passwd'/>",
        "<asset><mesh name='m' file='../m.stl'/></asset>",
        "<compiler meshdir='..'/><asset><mesh name='m' file='m.stl'/></asset>",
        "<asset><hfield name='h' nrow='60000' ncol='60000' size='1 1 1 1'/></asset>",
        "<worldbody><replicate count='3000'><replicate count='3000'><geom size='1'/></replicate>"
        "</replicate></worldbody>",
        "<extension><plugin plugin='a.b'/></extension>",
        "<asset><hfield name='h' nrow='x' ncol='1' size='1 1 1 1'/></asset>",
    ],
)
def test_a_hostile_mjcf_file_is_bad_input(tmp_path: Path, body: str) -> None:
    (tmp_path / "room.xml").write_text(f"<mujoco>{body}</mujoco>")
    with pytest.raises(InputError, match="room"):
        read_mjcf(tmp_path, "room.xml", "room")


def test_a_broken_mjcf_world_is_named_with_its_scenario_file(tmp_path: Path) -> None:
    (tmp_path / "room.xml").write_text("<mujoco><world")
    path = tmp_path / "own.toml"
    path.write_text(
        'schema = 1\nname = "own"\n[start]\nposition = [0.0, 0.0]\n[goal]\nposition = [2.0, 0.0]\n'
        '[[course]]\nkind = "mjcf"\nfile = "room.xml"\n'
    )
    with pytest.raises(InputError, match=r"own\.toml: course\.mjcf\.file: room\.xml: unclosed"):
        build_course(load_scenario(path), ROBOT)
