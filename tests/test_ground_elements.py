"""Patches, vegetation and terrain: what they are to feet, to rays, to the truth, and to a file."""

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from PIL import Image

from treadwell.course.build import build_course
from treadwell.course.course import Course
from treadwell.course.events import Events
from treadwell.course.height_field import FieldTop
from treadwell.course.static_map import static_map
from treadwell.episode import Episode
from treadwell.errors import InputError
from treadwell.map_memory import FLOOR, OBSTACLE, RememberedMap
from treadwell.measuring.score import map_counts, surfaces, true_cells
from treadwell.robot.load import load_robot
from treadwell.scenario.ground_elements import MOST_STEMS
from treadwell.scenario.loading import load_scenario
from treadwell.senses.depth import DepthCamera, Pinhole
from treadwell.solving.solvable import is_solvable
from treadwell.sweeps.content import named_files

ROBOT = load_robot("qrio")
HEAD = 'schema = 1\nname = "x"\ntime_limit = 2.0\n[start]\n[goal]\nposition = [3.0, 0.0]\n'
WHITE = 65535


def write(folder: Path, text: str) -> Path:
    path = folder / "x.toml"
    path.write_text(HEAD + text)
    return path


def element(kind: str, **keys: object) -> str:
    lines = [f"{key} = {str(value).lower()}" for key, value in keys.items()]
    return "\n".join([f'[[course]]\nkind = "{kind}"', *lines]) + "\n"


def course_of(folder: Path, text: str, *, seed: int = 0) -> Course:
    return build_course(load_scenario(write(folder, text), seed=seed), ROBOT)


def refused(folder: Path, text: str) -> str:
    with pytest.raises(InputError) as caught:
        course_of(folder, text)
    return str(caught.value)


def picture(folder: Path, heights: Any) -> None:  # noqa: ANN401 - as numpy takes it
    Image.fromarray(np.asarray(heights, np.uint16)).save(folder / "hill.png")


def ray_height(course: Course, x: float, y: float) -> float:
    data = mujoco.MjData(course.model)
    mujoco.mj_kinematics(course.model, data)
    down = mujoco.mj_ray(
        course.model, data, np.array([x, y, 5.0]), np.array([0.0, 0.0, -1.0]), None, 1, -1,
        np.zeros(1, np.int32),
    )  # fmt: skip
    return 5.0 - float(down)


def cells(kind: int, height: float) -> RememberedMap:
    """A map of cells of 4 cm, all the same, from x = 0.6 to 1.8, seen often."""
    shape = (20, 30)
    return RememberedMap(
        (0.6, -0.4), 0.04, np.full(shape, kind, np.uint8),
        np.full(shape, height, np.float32), np.full(shape, 9, np.uint16),
    )  # fmt: skip


# --- patches


def slides(course: Course, slope: float) -> float:
    """How far the sole of a robot slides down a slope of gravity in 0.2 s, m."""
    model = course.model
    model.opt.gravity[:] = (9.81 * slope, 0.0, -9.81)
    data = mujoco.MjData(model)
    data.qpos[:] = course.qpos
    data.qpos[:2] = (1.2, 0.0)
    mujoco.mj_forward(model, data)
    sole = model.body(ROBOT.file.legs.left.sole.link).id
    before = float(data.xpos[sole][0])
    while data.time < 0.2:
        mujoco.mj_step(model, data)
    return float(data.xpos[sole][0]) - before


def test_a_patchs_friction_holds_whatever_the_soles_is(tmp_path: Path) -> None:
    icy = element("patch", friction=0.02) + "[physics]\nfriction = 1.0\n"
    rough = element("patch", friction=1.0) + "[physics]\nfriction = 0.02\n"
    assert slides(course_of(tmp_path, icy), 0.1) > 0.01
    assert slides(course_of(tmp_path, rough), 0.1) < 0.005


def test_an_event_that_changes_the_friction_leaves_a_patchs(tmp_path: Path) -> None:
    event = '[[event]]\nat = 0.0\ndo = "friction"\nvalue = 0.6\n'
    scenario = load_scenario(write(tmp_path, element("patch", friction=0.1) + event))
    course = build_course(scenario, ROBOT)

    class Physics:
        model, data, steps = course.model, mujoco.MjData(course.model), 0

        def set(self, field: str, value: Any) -> None:  # noqa: ANN401 - as MuJoCo takes it
            getattr(self.model, field)[:] = value

    Events(scenario, course, ROBOT).before_tick(Physics())
    (patch,) = course.elements[0].geom_ids
    frictions = course.model.geom_friction[:, 0]
    assert frictions[patch] == 0.1
    assert (np.delete(frictions, patch) == 0.6).all()


def test_a_patch_is_floor_as_light_as_it_says(tmp_path: Path) -> None:
    course = course_of(tmp_path, element("patch", shade=0.25, size=[0.4, 0.6]))
    (patch,) = course.elements
    assert patch.walkable
    assert course.height_at(np.array([[1.2, 0.2]]))[0] == pytest.approx(0.001)
    assert course.model.geom_rgba[patch.geom_ids[0], :3] == pytest.approx(0.25)
    counts = map_counts(cells(FLOOR, 0.0), true_cells(course, cells(FLOOR, 0.0), 0.6))
    assert counts.floor_cells_right == 1.0
    assert counts.obstacle_cells == 0


def test_a_mat_can_be_taken_away(tmp_path: Path) -> None:
    event = '[[event]]\nat = 0.1\ndo = "remove"\nname = "mat"\n'
    episode = Episode(write(tmp_path, element("patch", name='"mat"') + event))
    for _ in episode:
        pass
    assert "mat" not in episode.events.present


# --- vegetation


def test_stems_are_seen_and_touch_nothing(tmp_path: Path) -> None:
    course = course_of(tmp_path, element("vegetation", position=[0.5, 0.0], density=800.0))
    (green,) = course.elements
    (stems,) = green.soft_ids
    assert (green.geom_ids, green.pieces, green.tops) == ((), (), ())
    data = mujoco.MjData(course.model)
    data.qpos[:] = course.qpos
    data.qpos[0] += 0.5  # amid them
    mujoco.mj_forward(course.model, data)
    assert stems not in data.contact.geom
    assert data.ncon > 0
    eye = ROBOT.file.camera.name
    data.cam_xpos[course.model.camera(eye).id] = (-1.0, 0.0, 0.06)
    cast = DepthCamera(course.model, eye, Pinhole(88, 72, 70.0)).cast(data)
    assert (cast.geom == stems).mean() > 0.01


def test_stems_are_as_many_and_as_high_as_the_file_says_and_drawn_from_the_seed(
    tmp_path: Path,
) -> None:
    text = element("vegetation", height=0.2, density=100.0, size=[0.5, 0.4], yaw=0.5)
    first, again = course_of(tmp_path, text), course_of(tmp_path, text)
    other = course_of(tmp_path, text, seed=1)
    np.testing.assert_array_equal(first.model.mesh_vert, again.model.mesh_vert)
    assert (first.model.mesh_vert != other.model.mesh_vert).any()
    assert first.model.mesh_facenum[0] == 6 * 20
    data = mujoco.MjData(first.model)
    mujoco.mj_kinematics(first.model, data)
    (stems,) = first.elements[0].soft_ids
    turn = data.geom_xmat[stems].reshape(3, 3)
    corners = first.model.mesh_vert @ turn.T + data.geom_xpos[stems]
    assert corners[:, 2].max() == pytest.approx(0.2, abs=1e-6)
    assert corners[:, 2].min() == pytest.approx(0.0, abs=1e-6)


def test_the_truth_under_vegetation_is_firm_ground(tmp_path: Path) -> None:
    scenario = load_scenario(write(tmp_path, element("vegetation", size=[0.8, 2.0])))
    course = build_course(scenario, ROBOT)
    wrong = map_counts(cells(OBSTACLE, 0.1), true_cells(course, cells(OBSTACLE, 0.1), 0.6))
    assert wrong.floor_called_obstacle == 1.0
    assert course.levels_at(1.2, 0.0) == [0.0]
    assert is_solvable(scenario, course, ROBOT) is True
    told = static_map(course, 0.04, "x")
    high = told.occupied()[0]
    assert high[:, 2].max() < 0.0  # of the ground alone: what gives way is not told


# --- terrain


def test_a_terrain_is_drawn_from_the_seed_and_level_at_its_edges(tmp_path: Path) -> None:
    text = element("terrain", size=[2.0, 1.2, 0.05], wavelength=0.5, yaw=0.3)
    first, other = course_of(tmp_path, text), course_of(tmp_path, text, seed=1)
    (top,) = first.elements[0].tops
    assert isinstance(top, FieldTop)
    heights = top.field.heights
    assert heights.max() == pytest.approx(0.05)
    assert heights.min() == 0.0
    for edge in (heights[0], heights[-1], heights[:, 0], heights[:, -1]):
        assert (edge == 0.0).all()
    assert (first.model.hfield_data != other.model.hfield_data).any()
    np.testing.assert_array_equal(
        first.model.hfield_data, course_of(tmp_path, text).model.hfield_data
    )


def test_its_height_is_that_at_which_a_ray_meets_it(tmp_path: Path) -> None:
    course = course_of(tmp_path, element("terrain", wavelength=0.3, yaw=0.7))
    points = np.array([1.5, 0.0]) + np.random.default_rng(2).uniform(-0.6, 0.6, (100, 2))
    met = [ray_height(course, x, y) for x, y in points]
    np.testing.assert_allclose(course.height_at(points), met, atol=1e-6)


def test_a_picture_lies_as_it_is_seen_from_above(tmp_path: Path) -> None:
    rows = np.zeros((5, 7))
    rows[0, 6] = WHITE  # up and to the right: far ahead, to the left
    rows[4, 0] = WHITE / 4
    picture(tmp_path, rows)
    keys = {"file": '"hill.png"', "size": [1.2, 0.8, 0.1], "position": [2.0, 0.0]}
    course = course_of(tmp_path, element("terrain", **keys))
    at = course.height_at(np.array([[2.599, 0.399], [1.401, -0.399], [1.401, 0.399], [2.0, 0.0]]))
    assert at == pytest.approx([0.1, 0.025, 0.0, 0.0], abs=2e-3)
    assert ray_height(course, 2.599, 0.399) == pytest.approx(at[0], abs=1e-6)


@pytest.mark.parametrize("grey", [0, WHITE // 2])
def test_a_picture_of_one_grey_is_a_table(tmp_path: Path, grey: int) -> None:
    picture(tmp_path, np.full((4, 4), grey))
    course = course_of(tmp_path, element("terrain", file='"hill.png"', size=[1.0, 1.0, 0.1]))
    height = 0.1 * grey / WHITE
    assert course.height_at(np.array([[1.5, 0.1]]))[0] == pytest.approx(height, abs=1e-6)
    assert ray_height(course, 1.5, 0.1) == pytest.approx(height, abs=1e-6)


def test_the_truth_of_a_terrain_is_its_surface(tmp_path: Path) -> None:
    course = course_of(tmp_path, element("terrain", size=[3.0, 2.0, 0.06], position=[1.9, 0.0]))
    flat = cells(FLOOR, 0.0)
    truth = true_cells(course, flat, 0.6)
    right = RememberedMap(
        flat.origin, flat.cell, flat.kind, truth.height.astype(np.float32), flat.sightings
    )
    assert truth.floor.all()
    assert map_counts(right, truth).floor_cells_right == 1.0
    assert map_counts(flat, truth).floor_cells_right < 0.9
    (entry,) = surfaces(course, right, np.zeros((0, 2)))
    assert entry.estimate == pytest.approx(entry.truth, abs=1e-6)


def test_a_sweep_of_a_terrain_depends_on_its_picture(tmp_path: Path) -> None:
    picture(tmp_path, np.zeros((3, 3)))
    scenario = load_scenario(write(tmp_path, element("terrain", file='"hill.png"')))
    assert list(named_files(scenario)) == [tmp_path / "hill.png"]


# --- what is refused


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (element("patch", friction=-0.1), "course.patch.friction: found -0.1"),
        (element("patch", shade=1.5), "course.patch.shade: found 1.5"),
        (element("patch", size=[0.4]), "course.patch.size"),
        (element("patch", colour=1), "course.patch.colour: unknown key; allowed: "),
        (element("vegetation", density=0.0), "course.vegetation.density: found 0.0"),
        (
            element("vegetation", density=9000.0, size=[4.0, 4.0]),
            f"course.vegetation.density: found 9000.0; must make at most {MOST_STEMS} stems of "
            "this size, not 144000",
        ),
        (element("vegetation", height=3.0), "course.vegetation.height: found 3.0"),
        (element("terrain", wavelength=0.01), "course.terrain.wavelength: found 0.01"),
        (
            element("terrain", wavelength=0.1, size=[50.0, 1.0, 0.1]),
            "course.terrain.wavelength: found 0.1; must be at least a hundredth of the longer "
            "side: 0.5",
        ),
        (
            element("terrain", wavelength=0.5, file='"hill.png"'),
            "course.terrain.wavelength: found 0.5; must not be there together with file",
        ),
        (
            element("terrain", file='"none.png"'),
            'course.terrain.file: found "none.png"; there is no',
        ),
        (
            element("terrain", file='"x.toml"'),
            'course.terrain.file: found "x.toml"; must end in .png',
        ),
        (
            element("terrain", file='"../x.png"'),
            'course.terrain.file: found "../x.png"; must lie in',
        ),
        (
            '[[event]]\nat = 1.0\ndo = "remove"\nname = "terrain"\n' + element("terrain"),
            "must be an element of one body",
        ),
        (
            '[[event]]\nat = 1.0\ndo = "move"\nname = "vegetation"\nto = [0.0, 0.0]\n'
            + element("vegetation"),
            "must be an element of one body",
        ),
    ],
)
def test_what_cannot_be_is_refused_by_its_key(tmp_path: Path, text: str, told: str) -> None:
    assert told in refused(tmp_path, text)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", "cannot be read as a PNG picture"),
        (b"\x89PNG\r\n\x1a\n" + bytes(100), "cannot be read as a PNG picture"),
        (Image.new("L", (4, 4)), "must be grey, of 16 bits"),
        (Image.new("RGB", (4, 4)), "must be grey, of 16 bits"),
        (Image.new("I;16", (1, 9)), "1x9 pixels; a terrain has 2 or more along each side"),
    ],
)
def test_a_picture_that_is_none_of_heights_is_refused(
    tmp_path: Path, content: bytes | Image.Image, told: str
) -> None:
    path = tmp_path / "hill.png"
    if isinstance(content, bytes):
        path.write_bytes(content)
    else:
        content.save(path)
    message = refused(tmp_path, element("terrain", file='"hill.png"'))
    assert "hill.png" in message
    assert told in message
    assert "\n" not in message
