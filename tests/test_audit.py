"""Claims about the audit: plain MuJoCo steps to a run's states, and to no other run's."""

from pathlib import Path
from zipfile import ZipFile

import mujoco
import numpy as np
import pytest

from treadwell.errors import InputError, RecordingError
from treadwell.physics.audit import steps_per_tick
from treadwell.physics.parts import PARTS
from treadwell.physics.recorded_audit import join_parts, replay_audit, replay_lengths
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


def eventful(robot: Robot, model: mujoco.MjModel, folder: Path | None = None) -> Simulation:
    """Two seconds with a push, a slippery floor and a kidnapping; audited into a folder if any."""
    simulation = Simulation(model, robot, Start(yaw=0.4))
    if folder is not None:
        simulation.audit.keep_in(folder)
    push = np.zeros((model.nbody, 6))
    push[model.body("torso").id, 1] = 4.0
    friction = model.geom_friction.copy()
    for tick in range(200):
        if tick == 50:
            simulation.set("xfrc_applied", push)
        if tick == 60:
            simulation.set("xfrc_applied", 0.0)
        if tick == 80:
            slippery = friction.copy()
            slippery[:, 0] = 0.3
            simulation.set("geom_friction", slippery)
        if tick == 120:
            simulation.set("qpos", simulation.standing_qpos(Start(1.0, 1.0, -1.0)))
            simulation.set("qvel", 0.0)
        simulation.advance(standing(robot))
    model.geom_friction[:] = friction
    return simulation


def test_plain_mujoco_steps_to_the_same_states_bit_for_bit(
    qrio: Robot, flat: mujoco.MjModel, tmp_path: Path
) -> None:
    simulation = eventful(qrio, flat)
    simulation.save_audit(tmp_path)
    with np.load(tmp_path / "physics.npz") as arrays:
        assert arrays["ctrl"].shape == (1000, 26)
        assert arrays["qpos"].shape == (200, 33)
        assert arrays["event_step"].tolist() == [250, 300, 400, 600]
        assert arrays["xfrc_applied"].shape == (4, flat.nbody, 6)
        assert np.isnan(arrays["event_qpos"][:3]).all()
    assert replay_audit(tmp_path) is None


@pytest.mark.parametrize("key", ["ctrl", "xfrc_applied", "geom_friction", "qpos", "event_qpos"])
def test_a_changed_audit_does_not_step_to_the_same_states(
    qrio: Robot, flat: mujoco.MjModel, tmp_path: Path, key: str
) -> None:
    eventful(qrio, flat).save_audit(tmp_path)
    with np.load(tmp_path / "physics.npz") as file:
        arrays = dict(file)
    arrays[key][-1 if key == "event_qpos" else 2] += 1e-3
    np.savez(tmp_path / "physics.npz", **arrays)
    assert replay_audit(tmp_path) is not None


def test_an_audit_of_another_time_step_is_read_by_its_own(
    qrio: Robot, flat: mujoco.MjModel, tmp_path: Path
) -> None:
    timestep = flat.opt.timestep
    flat.opt.timestep = 0.0025
    try:
        simulation = eventful(qrio, flat)
        simulation.save_audit(tmp_path)
    finally:
        flat.opt.timestep = timestep
    with np.load(tmp_path / "physics.npz") as arrays:
        assert arrays["ctrl"].shape == (800, 26)
        assert arrays["event_step"].tolist() == [200, 240, 320, 480]
    assert replay_audit(tmp_path) is None
    assert replay_lengths(str(tmp_path)) == (200, None, 4)


@pytest.mark.parametrize("timestep", [0.0, -0.0025, 0.003, 1e-300, np.nan])
def test_a_time_step_of_which_a_tick_is_not_made_is_refused(
    flat: mujoco.MjModel, timestep: float
) -> None:
    before = flat.opt.timestep
    flat.opt.timestep = timestep
    try:
        with pytest.raises(ValueError, match="whole time steps"):
            steps_per_tick(flat)
    finally:
        flat.opt.timestep = before


@pytest.mark.parametrize("name", ["model.mjb", "physics.npz"])
def test_a_cut_audit_is_refused(
    qrio: Robot, flat: mujoco.MjModel, tmp_path: Path, name: str
) -> None:
    eventful(qrio, flat).save_audit(tmp_path)
    whole = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(whole[: len(whole) // 2])
    with pytest.raises(InputError, match=name):
        replay_audit(tmp_path)
    (tmp_path / name).unlink()
    with pytest.raises(InputError, match=name):
        replay_audit(tmp_path)


def test_an_array_whose_header_is_not_closed_is_refused(
    qrio: Robot, flat: mujoco.MjModel, tmp_path: Path
) -> None:
    """What numpy says of headers that its own older versions did not write is no ValueError."""
    eventful(qrio, flat).save_audit(tmp_path)
    path = tmp_path / "physics.npz"
    with ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    header = members["qpos.npy"]
    members["qpos.npy"] = header.replace(b")", b"(", 1)
    assert members["qpos.npy"] != header
    with ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    with pytest.raises(InputError, match=r"physics\.npz: is missing or broken"):
        replay_audit(tmp_path)


def arrays(folder: Path) -> dict[str, np.ndarray]:
    with np.load(folder / "physics.npz") as file:
        return dict(file)


def test_it_makes_no_difference_whether_the_audit_is_written_as_it_comes(
    qrio: Robot, flat: mujoco.MjModel, tmp_path: Path
) -> None:
    for name in ("late", "soon"):
        (tmp_path / name).mkdir()
    eventful(qrio, flat).save_audit(tmp_path / "late")
    simulation = eventful(qrio, flat, tmp_path / "soon")
    assert (tmp_path / "soon" / PARTS / "ctrl.npy").is_file()
    simulation.save_audit(tmp_path / "soon")
    assert {path.name for path in (tmp_path / "soon").iterdir()} == {"model.mjb", "physics.npz"}
    late, soon = arrays(tmp_path / "late"), arrays(tmp_path / "soon")
    assert list(late) == list(soon)
    assert all(np.array_equal(late[key], soon[key], equal_nan=True) for key in late)


def test_the_file_is_as_numpy_writes_it(qrio: Robot, flat: mujoco.MjModel, tmp_path: Path) -> None:
    eventful(qrio, flat).save_audit(tmp_path)
    np.savez(tmp_path / "other.npz", **arrays(tmp_path))
    with ZipFile(tmp_path / "physics.npz") as one, ZipFile(tmp_path / "other.npz") as other:
        assert one.namelist() == other.namelist()
        assert all(one.read(name) == other.read(name) for name in one.namelist())


def test_of_a_killed_run_the_ticks_that_were_written_can_be_replayed(
    qrio: Robot, flat: mujoco.MjModel, tmp_path: Path
) -> None:
    simulation = eventful(qrio, flat, tmp_path)
    simulation.audit.flush()
    parts = tmp_path / PARTS
    whole = (parts / "ctrl.npy").read_bytes()
    (parts / "ctrl.npy").write_bytes(whole[:-100])  # cut amid a row
    join_parts(tmp_path)
    assert arrays(tmp_path)["ctrl"].shape == (995, 26)
    assert arrays(tmp_path)["qpos"].shape == (199, 33)
    assert replay_audit(tmp_path) is None
    assert not parts.exists()
    with pytest.raises(RecordingError, match=r"physics\.npz: cannot be written"):
        join_parts(tmp_path)


def test_a_run_that_goes_on_can_be_saved_again(
    qrio: Robot, flat: mujoco.MjModel, tmp_path: Path
) -> None:
    for name in ("first", "second"):
        (tmp_path / name).mkdir()
    simulation = eventful(qrio, flat, tmp_path / "first")
    simulation.save_audit(tmp_path / "first")
    simulation.advance(standing(qrio))
    simulation.save_audit(tmp_path / "second")
    first, second = arrays(tmp_path / "first"), arrays(tmp_path / "second")
    assert len(second["qpos"]) == len(first["qpos"]) + 1
    assert np.array_equal(second["ctrl"][:1000], first["ctrl"])
    assert np.array_equal(second["xfrc_applied"], first["xfrc_applied"])


def test_an_audit_that_was_dropped_keeps_nothing(
    qrio: Robot, flat: mujoco.MjModel, tmp_path: Path
) -> None:
    simulation = Simulation(flat, qrio)
    simulation.audit.drop()
    for _ in range(300):
        simulation.advance(standing(qrio))
    assert len(simulation.audit.ctrl.array()) < 1200
    with pytest.raises(RecordingError, match="was dropped"):
        simulation.save_audit(tmp_path)
