"""Claims about the physics: a robot stands by its motors alone, and falls without."""

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from robot_builders import qrio_copy

from treadwell._core import Physics, Servos
from treadwell.errors import SimulationError
from treadwell.physics.simulation import Simulation, Start
from treadwell.protocols import JointTargets
from treadwell.robot.load import Robot, load_robot


@pytest.fixture(scope="module")
def qrio() -> Robot:
    return load_robot("qrio")


@pytest.fixture(scope="module")
def flat(qrio: Robot) -> mujoco.MjModel:
    spec = qrio.spec()
    spec.worldbody.add_geom(name="ground", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1])
    return spec.compile()


def standing(robot: Robot) -> JointTargets:
    return JointTargets(robot.stand, np.zeros(26), np.zeros(26))


@pytest.mark.parametrize("play", [True, False])
def test_held_in_the_keyframe_by_its_servos_the_robot_stands_for_five_seconds(
    qrio: Robot, flat: mujoco.MjModel, play: bool
) -> None:
    simulation = Simulation(flat, qrio, play=play)
    for _ in range(500):
        simulation.advance(standing(qrio))
    data = simulation.data
    assert simulation.time_ns == 5_000_000_000
    assert data.time == pytest.approx(5.0)
    assert not data.xfrc_applied.any()
    assert not data.qfrc_applied.any()
    assert data.body("torso").xmat[8] > np.cos(0.1)
    assert data.body("pelvis").xpos == pytest.approx([0.0, 0.0, 0.22], abs=0.01)
    assert np.abs(simulation.joint_velocities).max() < 0.02
    forces = [
        np.linalg.norm(data.sensor(leg.forces).data[:3])
        for leg in (qrio.file.legs.left, qrio.file.legs.right)
    ]
    assert sum(forces) == pytest.approx(7.0 * 9.81, rel=0.01)


def test_without_torque_the_robot_falls(qrio: Robot, flat: mujoco.MjModel) -> None:
    simulation = Simulation(flat, qrio)
    nothing = np.zeros(26)
    powerless = replace(qrio.limits, peak_torque=nothing, friction=nothing)
    simulation.motors = Servos(powerless, play=0.0, timestep=flat.opt.timestep)
    for _ in range(150):
        simulation.advance(standing(qrio))
    assert not simulation.audit.ctrl.array().any()
    assert simulation.data.body("pelvis").xpos[2] < 0.15


def test_the_start_puts_the_middle_of_the_soles_at_the_place_with_the_yaw(
    qrio: Robot, flat: mujoco.MjModel
) -> None:
    simulation = Simulation(flat, qrio, Start(x=1.2, y=-0.7, yaw=2.0, height=0.12))
    left, right = (simulation.data.site(f"{side}_sole") for side in ("left", "right"))
    assert 0.5 * (left.xpos + right.xpos) == pytest.approx([1.2, -0.7, 0.12], abs=1e-5)
    assert left.xmat.reshape(3, 3)[:, 0] == pytest.approx([np.cos(2), np.sin(2), 0], abs=1e-5)
    across = (left.xpos - right.xpos) / 0.085
    assert across == pytest.approx([-np.sin(2), np.cos(2), 0], abs=1e-5)


def test_each_torque_that_reaches_mujoco_is_within_peak_and_line_but_for_friction(
    qrio: Robot, flat: mujoco.MjModel
) -> None:
    simulation = Simulation(flat, qrio)
    rng = np.random.default_rng(0)
    limits = qrio.limits
    for _ in range(40):
        wild = JointTargets(rng.normal(0, 2, 26), rng.normal(0, 9, 26), rng.normal(0, 9, 26))
        velocity = simulation.joint_velocities.copy()
        simulation.advance(wild)
        first = simulation.audit.ctrl.array()[-5]
        assert (np.abs(first) <= limits.peak_torque + limits.friction).all()
        line = limits.stall_torque * (1.0 - np.abs(velocity) / limits.no_load_speed)
        driving = first * velocity > 0.0
        assert (np.abs(first) <= np.maximum(line, 0.0) + 1e-12)[driving].all()
        assert (simulation.data.ctrl == simulation.audit.ctrl.array()[-1]).all()


def test_friction_is_the_servos_and_a_control_beyond_the_peak_by_it_is_not_clipped(
    qrio: Robot, flat: mujoco.MjModel
) -> None:
    assert not flat.dof_frictionloss.any()
    assert (qrio.nominal.dof_frictionloss[6:] > 0.0).all()
    assert np.array_equal(qrio.limits.friction, qrio.nominal.dof_frictionloss[6:])
    assert np.array_equal(qrio.limits.inertia, qrio.nominal.dof_armature[6:])
    most = qrio.limits.peak_torque + qrio.limits.friction
    assert flat.actuator_ctrlrange[:, 1] == pytest.approx(most)
    assert flat.actuator_ctrlrange[:, 0] == pytest.approx(-most)
    assert (flat.opt.noslip_iterations, flat.opt.noslip_tolerance) == (6, 0.0)


def test_a_tick_is_five_steps_whatever_the_robots_model_says(tmp_path: Path) -> None:
    folder = qrio_copy(tmp_path)
    mjcf = folder / "qrio.xml"
    mjcf.write_text(mjcf.read_text().replace('timestep="0.002"', 'timestep="0.005"'))
    robot = load_robot(str(folder))
    model = robot.spec().compile()
    assert (robot.nominal.opt.timestep, model.opt.timestep) == (0.005, 0.002)
    simulation = Simulation(model, robot)
    for _ in range(3):
        simulation.advance(standing(robot))
    assert simulation.steps == len(simulation.audit.ctrl.array()) == 15
    assert len(simulation.audit.qpos.array()) == 3
    assert simulation.data.time == pytest.approx(0.03)


def test_two_runs_give_the_same_states(qrio: Robot, flat: mujoco.MjModel) -> None:
    first, second = Simulation(flat, qrio), Simulation(flat, qrio)
    for simulation in (first, second):
        for _ in range(50):
            simulation.advance(standing(qrio))
    assert (first.audit.qpos.array() == second.audit.qpos.array()).all()


def test_after_a_tick_the_sensors_say_what_they_do_in_plain_mujoco(
    qrio: Robot, flat: mujoco.MjModel
) -> None:
    simulation = Simulation(flat, qrio, Start(height=0.005))
    plain = mujoco.MjData(flat)
    plain.qpos[:] = simulation.data.qpos
    mujoco.mj_step1(flat, plain)
    for tick in range(30):
        simulation.advance(standing(qrio))
        for ctrl in simulation.audit.ctrl.array()[5 * tick :]:
            plain.ctrl[:] = ctrl
            mujoco.mj_step2(flat, plain)
            mujoco.mj_step1(flat, plain)
        assert (simulation.data.sensordata == plain.sensordata).all()
    assert plain.sensor("left_sole_forces").data[:3].any()


def test_targets_that_are_not_finite_are_refused(qrio: Robot, flat: mujoco.MjModel) -> None:
    simulation = Simulation(flat, qrio)
    position = qrio.stand.copy()
    position[3] = np.nan
    with pytest.raises(SimulationError, match="position"):
        simulation.advance(JointTargets(position, np.zeros(26), np.zeros(26)))
    with pytest.raises(SimulationError, match="torque"):
        simulation.advance(JointTargets(qrio.stand, np.zeros(26), np.zeros(25)))


def test_physics_that_diverge_are_an_error_with_the_time(
    qrio: Robot, flat: mujoco.MjModel, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    simulation = Simulation(flat, qrio)
    simulation.advance(standing(qrio))
    simulation.set("qvel", np.full(flat.nv, 1e12))
    with pytest.raises(SimulationError, match=r"diverged at 0\.02 s"):
        simulation.advance(standing(qrio))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("kilobytes", [16, 56])
def test_a_model_with_too_little_memory_is_an_error_and_not_the_end_of_the_process(
    qrio: Robot, kilobytes: int
) -> None:
    spec = qrio.spec()
    spec.worldbody.add_geom(name="ground", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1])
    spec.memory = 1024 * kilobytes
    model = spec.compile()

    def fall() -> None:
        simulation = Simulation(model, qrio)
        for _ in range(150):
            simulation.advance(JointTargets(np.zeros(26), np.zeros(26), np.zeros(26)))

    with pytest.raises(SimulationError, match=r"^the physics failed at .* memory.*\)$") as raised:
        fall()
    assert "\n" not in str(raised.value)
    assert not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_SENSOR


def test_a_model_and_data_that_do_not_belong_together_are_not_stepped(
    qrio: Robot, flat: mujoco.MjModel
) -> None:
    data = mujoco.MjData(flat)
    motors = [(joint, joint) for joint in range(26)]
    with pytest.raises(ValueError, match="data is not of this model"):
        Physics(mujoco.MjModel.from_xml_string("<mujoco/>"), data, 26, 7, 6, motors)
    with pytest.raises(TypeError, match="MjModel"):
        Physics(object(), data, 26, 7, 6, motors)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="not all in this model"):
        Physics(flat, data, 27, 7, 6, motors)
    with pytest.raises(ValueError, match="26 columns"):
        Physics(flat, data, 26, 7, 6, motors).step(
            Servos(qrio.limits, play=0.0, timestep=0.002), np.zeros((1, 25))
        )
