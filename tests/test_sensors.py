"""Tests of all senses together, on the robot qrio."""

from dataclasses import dataclass
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from treadwell.observation import Observation
from treadwell.physics.simulation import TICK_NS, Simulation
from treadwell.protocols import JointTargets
from treadwell.random_streams import RandomStreams
from treadwell.robot.load import load_robot
from treadwell.senses.sensors import Sensors

ROBOT = load_robot("qrio")


@dataclass(frozen=True)
class Settings:
    depth: str = "noisy"
    encoders: str = "noisy"
    imu: str = "noisy"
    feet: str = "noisy"
    latency: float = 0.0
    camera_roll_pitch_error: float | None = None
    camera_position_error: float | None = None
    mismatch_rate: float | None = None
    intensity: bool = False


IDEAL = Settings("ideal", "ideal", "ideal", "ideal")


def simulation(*, play: bool = True) -> Simulation:
    spec = ROBOT.spec()
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[9, 9, 1])
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, pos=[0.9, 0, 0.1], size=[0.1, 0.5, 0.1])
    return Simulation(spec.compile(), ROBOT, play=play)


def senses(world: Simulation, settings: Settings = Settings(), seed: int = 0) -> Sensors:
    return Sensors(world.model, ROBOT, settings, RandomStreams(seed))


def stand(world: Simulation, seen: Sensors, ticks: int) -> list[Observation]:
    """What is observed while the robot stands and looks down."""
    world.motors.encoder_offsets = seen.encoder_offsets
    position = ROBOT.stand.copy()
    position[ROBOT.joints.index("neck_tilt")] = 0.6
    still = np.zeros_like(position)
    found = []
    for _ in range(ticks):
        found.append(seen.observe(world.data, world.time_ns, world.motors))
        world.advance(JointTargets(position, still, still))
    return found


def flat(seen: Observation) -> list[object]:
    frame = seen.depth
    return [
        seen.time_ns,
        seen.joint_positions.tolist(),
        seen.joint_velocities.tolist(),
        seen.angular_velocity.tolist(),
        seen.specific_force.tolist(),
        seen.foot_forces.tolist(),
        None if frame is None else (frame.exposure_ns, frame.arrival_ns, frame.depth.tobytes()),
    ]


def test_an_observation_has_the_shapes_of_the_contract() -> None:
    world = simulation()
    seen = stand(world, senses(world), 9)
    first = seen[0]
    assert first.joint_positions.shape == first.joint_velocities.shape == (len(ROBOT.joints),)
    assert first.angular_velocity.shape == first.specific_force.shape == (3,)
    assert first.foot_forces.shape == (2, 4)
    assert first.depth is not None
    assert first.depth.depth.shape == (72, 88)
    assert first.depth.depth.dtype == np.float32
    assert [i for i, one in enumerate(seen) if one.depth is not None] == [0, 8]
    assert [one.time_ns for one in seen] == [i * TICK_NS for i in range(9)]


def test_the_same_seed_observes_the_same() -> None:
    runs = []
    for seed in (3, 3, 4):
        world = simulation()
        runs.append([flat(one) for one in stand(world, senses(world, seed=seed), 20)])
    assert runs[0] == runs[1]
    assert runs[0] != runs[2]


def test_ideal_senses_tell_the_truth() -> None:
    world = simulation(play=False)
    seen = senses(world, IDEAL)
    stand(world, seen, 150)
    now = seen.observe(world.data, 40 * 8 * TICK_NS, world.motors)
    np.testing.assert_array_equal(now.joint_positions, world.joint_positions)
    np.testing.assert_array_equal(now.joint_velocities, world.joint_velocities)
    np.testing.assert_allclose(
        now.angular_velocity, world.data.sensor(ROBOT.file.imu.gyro).data, atol=1e-9
    )
    assert np.linalg.norm(now.specific_force) == pytest.approx(9.81, abs=0.1)
    weight = 9.81 * ROBOT.nominal.body_subtreemass[1]
    assert now.foot_forces.sum() == pytest.approx(weight, rel=0.05)
    assert now.depth is not None
    camera = world.data.camera(ROBOT.file.camera.name)
    middle = now.depth.depth[35:37, 43:45].mean()
    hit = camera.xpos - camera.xmat.reshape(3, 3)[:, 2] * middle
    on_top = abs(hit[2] - 0.2) < 2e-3
    on_floor = abs(hit[2]) < 2e-3
    on_front = abs(hit[0] - 0.8) < 2e-3
    assert on_top or on_floor or on_front


@pytest.mark.parametrize("sense", ["depth", "encoders", "imu", "feet"])
def test_a_sense_made_ideal_leaves_the_others_as_they_were(sense: str) -> None:
    world = simulation()
    noisy = flat(senses(world).observe(world.data, 0))
    settings = Settings(**{sense: "ideal"})  # type: ignore[arg-type]
    ideal = flat(senses(world, settings).observe(world.data, 0))
    parts = {"encoders": {1, 2}, "imu": {3, 4}, "feet": {5}, "depth": {6}}[sense]
    changed = {i for i, (a, b) in enumerate(zip(noisy, ideal, strict=True)) if a != b}
    assert changed == parts


def test_leg_encoders_are_off_by_up_to_their_bound_and_arms_are_not() -> None:
    world = simulation()
    offsets = np.array([senses(world, seed=seed).encoder_offsets for seed in range(40)])
    legs = [*ROBOT.file.legs.left.joints, *ROBOT.file.legs.right.joints]
    at = [ROBOT.joints.index(joint) for joint in legs]
    bound = ROBOT.file.encoders.leg_offset
    assert 0.9 * bound < np.abs(offsets[:, at]).max() <= bound
    arms = [ROBOT.joints.index(joint) for joint in ROBOT.file.arms.rest]
    assert not offsets[:, arms].any()
    assert np.degrees(np.abs(offsets[:, ROBOT.joints.index("neck_tilt")]).max()) > 4.5


def test_the_servos_go_by_the_encoders_so_that_the_camera_really_looks_elsewhere() -> None:
    world = simulation()
    seen = senses(world, Settings(imu="ideal"), seed=1)
    last = stand(world, seen, 100)[-1]
    tilt = ROBOT.joints.index("neck_tilt")
    offset = seen.encoder_offsets[tilt]
    assert abs(np.degrees(offset)) > 1.0
    truth = world.joint_positions[tilt]
    assert last.joint_positions[tilt] == pytest.approx(truth + offset, abs=0.006)
    assert last.joint_positions[tilt] == pytest.approx(0.6, abs=0.03)


def test_an_encoder_shifts_from_then_on() -> None:
    world = simulation()
    seen = senses(world, IDEAL)
    before = seen.observe(world.data, 0).joint_positions
    held = seen.encoder_offsets
    for _ in range(2):
        seen.set_encoder_shifts({"left_knee_pitch": 0.02})
    after = seen.observe(world.data, TICK_NS).joint_positions
    changed = np.zeros(len(ROBOT.joints))
    changed[ROBOT.joints.index("left_knee_pitch")] = 0.02
    np.testing.assert_allclose(after - before, changed, atol=1e-12)
    np.testing.assert_array_equal(held, changed)
    seen.set_encoder_shifts({})
    assert not held.any()


def test_a_blinded_robot_gets_no_frames_for_that_long() -> None:
    world = simulation()
    seen = senses(world)
    seen.blind(20 * TICK_NS)
    found = [one.depth is not None for one in stand(world, seen, 40)]
    assert [i for i, arrived in enumerate(found) if arrived] == [24, 32]


def test_frames_are_late_by_the_latency() -> None:
    world = simulation()
    found = stand(world, senses(world, Settings(latency=0.03)), 20)
    frames = [(i, one.depth.exposure_ns) for i, one in enumerate(found) if one.depth is not None]
    assert frames == [(3, 0), (11, 8 * TICK_NS), (19, 16 * TICK_NS)]


def test_a_texture_that_is_not_one_a_geom_is_refused() -> None:
    world = simulation()
    with pytest.raises(ValueError, match=r"texture: .* geoms, got 1 values"):
        Sensors(world.model, ROBOT, Settings(), RandomStreams(0), np.ones(1))


def test_what_is_blank_is_not_seen() -> None:
    world = simulation()
    texture = np.ones(world.model.ngeom)
    seen = Sensors(world.model, ROBOT, Settings(), RandomStreams(0), texture)
    blank = Sensors(world.model, ROBOT, Settings(), RandomStreams(0), 0.0 * texture)
    shares = []
    for one in (seen, blank):
        frame = stand(simulation(), one, 57)[-1].depth
        assert frame is not None
        shares.append(np.isfinite(frame.depth).mean())
    assert shares[0] > 0.5
    assert shares[1] < 0.1


def test_a_robot_without_errors_in_its_file_has_exact_noisy_senses() -> None:
    world = simulation(play=False)
    tables = {
        name: type(getattr(ROBOT.file, name)).model_validate(
            {
                key: 0.0 if isinstance(value, float) else value
                for key, value in getattr(ROBOT.file, name).model_dump().items()
            }
        )
        for name in ("encoders", "imu", "feet")
    }
    exact = SimpleNamespace(
        file=ROBOT.file.model_copy(update=tables),
        joints=ROBOT.joints,
        ties=ROBOT.ties,
        nominal=ROBOT.nominal,
    )
    one = Sensors(world.model, exact, Settings(), RandomStreams(0)).observe(world.data, 0)
    other = senses(world, IDEAL).observe(world.data, 0)
    assert flat(one)[:6] == flat(other)[:6]


def test_a_scenario_can_make_the_camera_more_wrong_than_the_robots_own() -> None:
    world = simulation()
    own, wider = senses(world), senses(world, Settings(camera_roll_pitch_error=0.244))
    tilt = ROBOT.joints.index("neck_tilt")
    assert own.encoder_offsets[tilt] != 0.0
    ratio = wider.encoder_offsets[tilt] / own.encoder_offsets[tilt]
    assert ratio == pytest.approx(0.244 / 0.122, rel=0.05)
    legs = [ROBOT.joints.index(joint) for joint in ROBOT.file.legs.left.joints]
    assert np.array_equal(own.encoder_offsets[legs], wider.encoder_offsets[legs])


def test_a_scenario_can_make_stereo_mismatch_more_often() -> None:
    world = simulation()
    mujoco.mj_forward(world.model, world.data)

    def depth(settings: Settings) -> NDArray[np.float32]:
        frame = senses(world, settings).observe(world.data, 0).depth
        assert frame is not None
        return frame.depth

    true = depth(IDEAL)

    def grossly_wrong(rate: float | None) -> float:
        seen = depth(Settings(encoders="ideal", mismatch_rate=rate))
        return float(np.mean(np.abs(seen / true - 1.0)[np.isfinite(seen + true)] > 0.3))

    never, own, often = grossly_wrong(0.0), grossly_wrong(None), grossly_wrong(0.1)
    assert never < own < never + 0.02
    assert never + 0.04 < often < never + 0.12
