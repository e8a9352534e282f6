"""Claims about the robot nao: its body, its one motor for both hips' yaw, and that it walks."""

import json

import mujoco
import numpy as np
import pytest

from treadwell._core import Walker
from treadwell.episode import Episode
from treadwell.physics.simulation import Simulation
from treadwell.protocols import JointTargets
from treadwell.random_streams import RandomStreams
from treadwell.robot.followers import Tie
from treadwell.robot.load import Robot, load_robot
from treadwell.scenario.model import Sensors as Settings
from treadwell.senses.sensors import Sensors

CAMERA_KG = 0.17
TIED = ("left_hip_yaw_pitch", "right_hip_yaw_pitch")
# HULKs' outline of a left sole, m from below the ankle: front, back, inner and outer side.
OUTLINE = np.array(
    [
        (-0.0546, -0.0152), (-0.0507, -0.0214), (-0.0426, -0.0306), (-0.0377, -0.0337),
        (-0.0330, -0.0344), (0.0577, -0.0388), (0.0640, -0.0384), (0.0740, -0.0373),
        (0.0797, -0.0353), (0.0846, -0.0332), (0.0876, -0.0315), (0.0918, -0.0277),
        (0.0940, -0.0243), (0.0969, -0.0188), (0.0994, -0.0102), (0.1001, -0.0016),
        (0.0990, 0.0087), (0.0970, 0.0165), (0.0940, 0.0242), (0.0905, 0.0295),
        (0.0845, 0.0361), (0.0799, 0.0395), (0.0742, 0.0427), (0.0657, 0.0461),
        (0.0572, 0.0477), (0.0499, 0.0482), (-0.0312, 0.0517), (-0.0359, 0.0496),
        (-0.0410, 0.0460), (-0.0452, 0.0420), (-0.0491, 0.0376), (-0.0547, 0.0298),
    ]
)  # fmt: skip


@pytest.fixture(scope="module")
def nao() -> Robot:
    return load_robot("nao")


def indices(robot: Robot) -> list[int]:
    return [robot.joints.index(name) for name in TIED]


def test_it_weighs_what_the_published_links_and_the_camera_weigh(nao: Robot) -> None:
    model = nao.nominal
    assert model.body("depth_camera").mass == pytest.approx(CAMERA_KG)
    assert model.body_subtreemass[1] == pytest.approx(5.19535 + CAMERA_KG, abs=1e-9)


def test_23_motors_turn_24_joints(nao: Robot) -> None:
    assert len(nao.joints) == 24
    assert len(nao.actuators) == nao.nominal.nu == 23
    leader, follower = indices(nao)
    assert nao.ties == {follower: Tie(leader)}
    joints = [link["joint"] for link in nao.description()["links"] if link["joint"]]
    follows = {joint["name"]: joint["follows"] for joint in joints if joint["follows"]}
    assert follows == {TIED[1]: TIED[0]}


def test_at_angles_zero_its_lengths_are_the_published_ones(nao: Robot) -> None:
    data = mujoco.MjData(nao.nominal)
    data.qpos[3] = 1.0
    mujoco.mj_forward(nao.nominal, data)
    assert data.body("neck").xpos[2] - data.site("left_sole").xpos[2] == pytest.approx(0.45959)
    assert data.body("left_thigh").xpos[2] - data.site("left_sole").xpos[2] == pytest.approx(
        0.24809
    )
    assert data.subtree_com[1][2] - data.site("left_sole").xpos[2] > 0.29


def test_in_the_keyframe_the_soles_lie_flat_and_the_weight_is_where_the_feet_carry(
    nao: Robot,
) -> None:
    data = mujoco.MjData(nao.nominal)
    data.qpos[:] = nao.stand_qpos
    mujoco.mj_forward(nao.nominal, data)
    for side, y in (("left", 0.05645), ("right", -0.05645)):
        site = data.site(f"{side}_sole")
        assert site.xmat.reshape(3, 3) == pytest.approx(np.eye(3), abs=1e-5)
        assert site.xpos[1:] == pytest.approx([y, 0.0], abs=1e-5)
        ahead = site.xpos[0] + nao.file.gait["support_ahead"]
        assert data.subtree_com[1][0] == pytest.approx(ahead, abs=1e-3)


def inside(places: np.ndarray, outline: np.ndarray) -> np.ndarray:
    """Which places lie within a convex outline that runs against the clock."""
    edges = np.roll(outline, -1, axis=0) - outline
    off = places[:, None] - outline
    return np.asarray((edges[:, 0] * off[..., 1] - edges[:, 1] * off[..., 0] >= 0.0).all(axis=1))


def test_the_soles_boxes_cover_nine_tenths_of_the_outline_and_hardly_more(nao: Robot) -> None:
    model, grid = nao.nominal, np.arange(-0.06, 0.11, 0.001)
    places = np.stack(np.meshgrid(grid, grid), axis=-1).reshape(-1, 2)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        on = np.zeros(len(places), np.bool_)
        for part in ("middle", "long", "tip"):
            geom = model.geom(f"{side}_sole_{part}")
            assert geom.pos[2] - geom.size[2] == pytest.approx(-0.04519)
            centre = geom.pos[:2] * [1.0, sign]
            on |= (np.abs(places - centre) <= geom.size[:2]).all(axis=1)
        true = inside(places, OUTLINE)
        assert (on & true).sum() > 0.9 * true.sum()
        assert (on & ~true).sum() < 0.01 * true.sum()


def test_the_planners_rectangle_is_the_outlines_extent(nao: Robot) -> None:
    sole = nao.file.legs.left.sole
    half = np.array([sole.length, sole.width]) / 2
    centre = np.array(sole.position[:2])
    assert centre - half == pytest.approx(OUTLINE.min(axis=0), abs=2e-4)
    assert centre + half == pytest.approx(OUTLINE.max(axis=0), abs=2e-4)
    # What the margin leaves of it can be pressed upon.
    margin = nao.file.gait["sole_margin"]
    corners = centre + (half - margin) * [[1, 1], [1, -1], [-1, 1], [-1, -1]]
    apart = np.linalg.norm(np.clip(corners, *_within(OUTLINE, corners)) - corners, axis=1)
    assert apart.max() < 0.004


def _within(outline: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For each corner, how far across the outline reaches at its place along the sole."""
    top, bottom = outline[15:][::-1], outline[:16]
    upper = np.interp(corners[:, 0], top[:, 0], top[:, 1])
    lower = np.interp(corners[:, 0], bottom[:, 0], bottom[:, 1])
    low = np.stack([corners[:, 0], lower], axis=1)
    high = np.stack([corners[:, 0], upper], axis=1)
    return low, high


def test_level_the_camera_looks_30_degrees_down_from_58_centimetres(nao: Robot) -> None:
    data = mujoco.MjData(nao.nominal)
    data.qpos[3] = 1.0
    mujoco.mj_forward(nao.nominal, data)
    camera = data.camera("camera")
    assert -camera.xmat.reshape(3, 3)[:, 2] == pytest.approx(
        [np.cos(np.pi / 6), 0.0, -0.5], abs=1e-5
    )
    assert data.camera("camera").xpos[2] - data.site("left_sole").xpos[2] == pytest.approx(
        0.60, abs=0.02
    )


class World:
    """A nao on level ground with all its noise, but blind."""

    def __init__(self, nao: Robot, seed: int) -> None:
        spec = nao.spec()
        spec.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], contype=1, conaffinity=0
        )
        model = spec.compile()
        self.simulation = Simulation(model, nao)
        self.sensors = Sensors(model, nao, Settings(), RandomStreams(seed))
        self.sensors.blind(2**62)
        self.simulation.motors.encoder_offsets = self.sensors.encoder_offsets
        self.walker = Walker(json.dumps(nao.description()))
        self.tied = indices(nao)
        self.torso = model.body("torso").id

    def walk(self, velocity: tuple[float, float, float] | None, ticks: int) -> float:
        """Walk, and return the largest difference of the two hips' angles, rad."""
        simulation, apart = self.simulation, 0.0
        for _ in range(ticks):
            seen = self.sensors.observe(simulation.data, simulation.time_ns, simulation.motors)
            left, right = seen.joint_positions[self.tied]
            assert left == right
            simulation.advance(JointTargets(*self.walker.step(seen, velocity, 0.0, 0.6)))
            left, right = simulation.joint_positions[self.tied]
            apart = max(apart, abs(left - right))
            assert simulation.data.xmat[self.torso][8] > 0.95
        return apart


@pytest.mark.slow
def test_it_stands_and_walks_a_metre_and_a_curve_with_both_hips_at_one_angle(nao: Robot) -> None:
    world = World(nao, seed=3)
    apart = world.walk(None, 100)
    apart = max(apart, world.walk((0.1, 0.0, 0.0), 1050))
    x, y = world.simulation.data.qpos[:2]
    assert 0.9 < np.hypot(x, y) < 1.2
    apart = max(apart, world.walk((0.05, 0.0, 0.3), 400))
    apart = max(apart, world.walk(None, 200))
    assert world.walker.standing
    quat = world.simulation.data.qpos[3:7]
    assert 2.0 * np.arctan2(quat[3], quat[0]) > 0.9
    # Less than the play of a gear, whatever the feet bear.
    assert apart < 0.005


@pytest.mark.slow
def test_on_the_open_floor_it_sees_the_ground_and_walks() -> None:
    episode = Episode("open_floor", robot="nao", seed=300)
    step = episode.tick()
    while step.estimate.pose[0] < 0.5:
        assert 1e-9 * episode.simulation.time_ns < 30.0
        assert episode.verdict is None
        step = episode.tick()
    assert episode.judge.frame.x > 0.4
