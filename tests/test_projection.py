"""Tests of the core's depth camera: every pixel against MuJoCo's own rays."""

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from treadwell import _core
from treadwell.errors import InputError
from treadwell.senses.projection import VISIBLE_GROUPS, depth_camera, seen_geoms

Floats = NDArray[np.float64]
FAR = 1e3
KINDS = ("plane", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "hfield")


def random_scene(rng: np.random.Generator, count: int, mesh_faces: int = 400) -> mujoco.MjModel:
    """Geoms of every kind in a heap, a few of them unseen, some in bodies."""
    spec = mujoco.MjSpec()
    mesh = spec.add_mesh(name="blob")
    vertices, faces = blob(rng, mesh_faces)
    mesh.uservert, mesh.userface = vertices.reshape(-1), faces.reshape(-1)
    mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
    field = spec.add_hfield(name="hill", nrow=13, ncol=9, size=[0.6, 0.8, 0.3, 0.1])
    field.userdata = rng.uniform(0.0, 1.0, 13 * 9).tolist()
    for index in range(count):
        kind = KINDS[index % len(KINDS)]
        body = spec.worldbody
        if rng.random() < 0.5:
            body = body.add_body(pos=rng.uniform(-0.5, 0.5, 3))
        geom = body.add_geom(
            type=getattr(mujoco.mjtGeom, f"mjGEOM_{kind.upper()}"),
            size=rng.uniform(0.03, 0.6, 3),
            pos=rng.uniform(-2.0, 2.0, 3),
            group=int(rng.choice([0, 1, 2, 3], p=[0.5, 0.2, 0.2, 0.1])),
            rgba=[1.0, 1.0, 1.0, float(rng.choice([0.0, 1.0], p=[0.1, 0.9]))],
        )
        if kind != "plane" or body is spec.worldbody:
            geom.quat = rng.normal(size=4)
        if kind == "mesh":
            geom.meshname = "blob"
        if kind == "hfield":
            geom.hfieldname = "hill"
        if kind == "plane" and rng.random() < 0.3:
            geom.size = [0.0, 0.0, 1.0]
            geom.pos = [0.0, 0.0, -1.5]
            geom.quat = [1.0, 0.0, 0.0, 0.0]
    return spec.compile()


def blob(rng: np.random.Generator, faces: int) -> tuple[Floats, NDArray[np.int32]]:
    """A dented ball of some so many triangles, closed and not convex."""
    rows = max(3, int(np.sqrt(faces / 4)))
    columns = 2 * rows
    theta = np.linspace(0.02, np.pi - 0.02, rows + 1)[:, None]
    phi = np.arange(columns) * 2.0 * np.pi / columns
    radius = 0.5 + 0.1 * np.sin(3.0 * theta) * np.cos(2.0 * phi + rng.uniform(0.0, 6.0))
    ball = [np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta) + 0.0 * phi]
    points = np.stack([radius * part for part in ball], axis=-1)
    row, column = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    a, b = row * columns + column, row * columns + (column + 1) % columns
    c, d = a + columns, b + columns
    split = np.concatenate([np.stack([a, c, b], -1), np.stack([b, c, d], -1)])
    return points.reshape(-1, 3), split.reshape(-1, 3).astype(np.int32)


def random_pose(rng: np.random.Generator, data: mujoco.MjData) -> tuple[Floats, Floats]:
    """A place in or beside the heap, now and then within a geom, and any direction."""
    quaternion, matrix = rng.normal(size=4), np.empty(9)
    mujoco.mju_quat2Mat(matrix, quaternion / np.linalg.norm(quaternion))
    position = rng.uniform(-3.0, 3.0, 3)
    if rng.random() < 0.3:
        position = data.geom_xpos[rng.integers(len(data.geom_xpos))] + rng.uniform(-0.02, 0.02, 3)
    return position, matrix.reshape(3, 3)


def rays(width: int, height: int, focal: float) -> Floats:
    u = (np.arange(width) - (width - 1) / 2) / focal
    v = (np.arange(height) - (height - 1) / 2) / focal
    x, y = np.meshgrid(u, v)
    return np.stack([x, y, np.ones_like(x)], axis=-1).reshape(-1, 3)


def by_mujoco(
    model: mujoco.MjModel, data: mujoco.MjData, position: Floats, directions: Floats
) -> tuple[Floats, NDArray[np.int32]]:
    count = len(directions)
    depth, geom = np.empty(count), np.empty(count, np.int32)
    mujoco.mj_multiRay(
        model, data, position, directions.reshape(-1), VISIBLE_GROUPS, True, -1,
        geom, depth, None, count, FAR,
    )  # fmt: skip
    depth[geom < 0] = np.nan
    return depth, geom


def ray_by_ray(
    model: mujoco.MjModel, data: mujoco.MjData, position: Floats, direction: Floats
) -> float:
    """MuJoCo's single ray, which leaves no geom out beforehand."""
    geom = np.empty(1, np.int32)
    met = mujoco.mj_ray(model, data, position, direction, VISIBLE_GROUPS, True, -1, geom)
    return float(met) if geom[0] >= 0 else np.nan


def off(depth: Floats, true: Floats) -> NDArray[np.bool_]:
    """Where two depths are not within a micrometre, or only one is there."""
    same = np.isnan(depth) & np.isnan(true)
    with np.errstate(invalid="ignore"):
        same |= np.abs(depth - true) <= 1e-6 * np.maximum(1.0, true)
    return ~same


def compare(
    model: mujoco.MjModel, size: tuple[int, int], poses: int, rng: np.random.Generator
) -> tuple[int, int]:
    """Return how many pixels were looked at, and how many are off by more than a micrometre."""
    width, height = size
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    focal = 1.15 * width
    camera = depth_camera(model, -1, width, height, focal)
    assert not camera.unknown
    pinhole = rays(width, height, focal)
    wrong = 0
    for _ in range(poses):
        position, rotation = random_pose(rng, data)
        found, geom = camera.cast(data.geom_xpos, data.geom_xmat, tuple(position), rotation)
        directions = pinhole @ rotation.T
        depth, met = by_mujoco(model, data, position, directions)
        found, geom = found.reshape(-1), geom.reshape(-1)
        assert ((geom < 0) == np.isnan(found)).all()
        for pixel in np.flatnonzero(off(found, depth)):
            # `mj_multiRay` leaves geoms out by angles, and now and then one too many.
            true = ray_by_ray(model, data, position, directions[pixel])
            wrong += bool(off(found[pixel], np.array(true)))
        both = (geom >= 0) & (met >= 0) & ~off(found, depth)
        # Of two geoms in the same place either may be named.
        assert np.mean(geom[both] == met[both]) > 0.99 if both.any() else True
    return poses * width * height, wrong


@pytest.mark.parametrize("seed", range(6))
def test_every_pixel_of_random_scenes_is_where_mujocos_ray_ends(seed: int) -> None:
    rng = np.random.default_rng([33, seed])
    pixels, wrong = compare(random_scene(rng, 60), (88, 72), 12, rng)
    # At an edge rounding decides what is met.
    assert wrong <= 2, f"{wrong} of {pixels}"


@pytest.mark.slow
@pytest.mark.parametrize("size", [(320, 240), (640, 480)])
def test_every_pixel_of_large_pictures_is_where_mujocos_ray_ends(size: tuple[int, int]) -> None:
    rng = np.random.default_rng([34, size[0]])
    pixels, wrong = compare(random_scene(rng, 40), size, 2, rng)
    assert wrong <= 4, f"{wrong} of {pixels}"


@pytest.mark.slow
def test_every_pixel_of_a_mesh_of_100_000_triangles_is_where_mujocos_ray_ends() -> None:
    rng = np.random.default_rng(35)
    model = random_scene(rng, 16, mesh_faces=100_000)
    assert model.mesh_facenum[0] > 99_000
    pixels, wrong = compare(model, (320, 240), 3, rng)
    assert wrong <= 4, f"{wrong} of {pixels}"


def test_a_scene_of_2000_elements_is_drawn_as_mujocos_rays_meet_it() -> None:
    rng = np.random.default_rng(36)
    pixels, wrong = compare(random_scene(rng, 2000, mesh_faces=100), (44, 36), 2, rng)
    assert wrong <= 2, f"{wrong} of {pixels}"


def test_what_is_hidden_from_mujocos_rays_is_not_seen() -> None:
    xml = """
    <mujoco><asset><material name="clear" rgba="1 1 1 0"/></asset><worldbody>
      <geom type="box" size="1 1 1"/> <geom type="box" size="1 1 1" group="3"/>
      <geom type="box" size="1 1 1" group="2"/> <geom type="box" size="1 1 1" rgba="1 1 1 0"/>
      <geom type="box" size="1 1 1" material="clear"/>
      <body><geom type="box" size="1 1 1"/></body>
    </worldbody></mujoco>
    """
    model = mujoco.MjModel.from_xml_string(xml)
    assert seen_geoms(model, -1).tolist() == [True, False, True, False, False, True]
    assert seen_geoms(model, 1).tolist() == [True, False, True, False, False, False]


def camera_of(kind: int, **changes: object) -> _core.DepthCamera:
    arguments: dict[str, object] = {
        "meshes": [],
        "height_fields": [],
        "sizes": np.full((1, 3), 0.5),
    }
    arguments |= changes
    return _core.DepthCamera(
        np.array([kind], np.int32),
        arguments["sizes"],
        np.ones(1, np.bool_),
        np.zeros(1, np.int32),
        arguments["meshes"],
        arguments["height_fields"],
        width=8,
        height=6,
        focal=8.0,
    )


def test_a_mesh_with_what_is_no_number_is_refused_in_one_line() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, np.nan], [0, 1, 0]], np.float32)
    faces = np.array([[0, 1, 2]], np.int32)
    with pytest.raises(InputError, match=r"^vertex 1 of mesh 0 is no finite number$"):
        camera_of(7, meshes=[(vertices, faces)])
    with pytest.raises(InputError, match=r"^face 0 of mesh 0 names a vertex that is not there$"):
        camera_of(7, meshes=[(np.nan_to_num(vertices), faces - 1)])


def test_a_size_that_is_no_number_and_a_mesh_that_is_not_there_are_refused() -> None:
    with pytest.raises(InputError, match=r"^a size of body 0 is no finite number$"):
        camera_of(6, sizes=np.full((1, 3), np.nan))
    with pytest.raises(InputError, match="body 0 has a mesh or a height field that is not there"):
        camera_of(7)


def test_a_type_that_is_not_drawn_is_said_and_what_was_cast_elsewhere_is_put_in() -> None:
    camera = camera_of(8)
    assert camera.unknown == [0]
    depth, geom = np.full((6, 8), np.nan), np.full((6, 8), -1, np.int32)
    depth[2, 3], geom[2, 3] = 1.5, 0
    poses = np.zeros((1, 3)), np.eye(3).reshape(1, 9)
    found, met = camera.cast(*poses, (0.0, 0.0, 0.0), np.eye(3), others=(depth, geom))
    np.testing.assert_array_equal(found, depth)
    np.testing.assert_array_equal(met, geom)


def test_poses_of_another_scene_are_refused() -> None:
    with pytest.raises(ValueError, match="geom_xpos must have 3 values, got 6"):
        camera_of(2).cast(np.zeros((2, 3)), np.zeros((2, 9)), (0.0, 0.0, 0.0), np.eye(3))
