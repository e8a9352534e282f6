"""Faults: each spoils one sense or motor as it says; the robot names it and stands."""

from typing import Any

import numpy as np
import pytest

from treadwell.episode import Episode
from treadwell.errors import InputError
from treadwell.observation import Frame, Observation
from treadwell.physics.motors import LateTargets, strengths
from treadwell.protocols import JointTargets
from treadwell.scenario.event_table import EventTable
from treadwell.scenario.faults import FAULTS, Fault
from treadwell.scenario.loading import load_scenario
from treadwell.senses.faults import SenseFaults

JOINTS = {"left_knee_pitch": 0, "neck_pan": 1}


def fault(**keys: float | str) -> Fault:
    return Fault.model_validate({"at": 0.0, "do": "fault", **keys})


def observation(tick: int, *, seen: bool = True) -> Observation:
    time_ns = tick * 10_000_000
    depth = np.full((4, 5), 1.0 + 0.01 * tick, np.float32)
    return Observation(
        time_ns,
        np.array([0.1 * tick, 0.2]),
        np.array([10.0, 0.0]),
        np.array([0.1, 0.2, 0.3]) + tick,
        np.array([1.0, 2.0, 9.8]),
        np.full((2, 4), 8.0 + tick),
        Frame(time_ns, time_ns, depth) if seen else None,
    )


def spoiled(*faults: Fault, ticks: int = 1) -> list[Observation]:
    faulty = SenseFaults(JOINTS, np.random.default_rng(0))
    faulty.set(list(faults))
    return [faulty.apply(observation(tick)) for tick in range(ticks)]


def depth_of(told: Observation) -> np.ndarray[Any, Any]:
    assert told.depth is not None
    return told.depth.depth


def test_each_fault_of_the_camera_spoils_its_frames_alone() -> None:
    [nan] = spoiled(fault(part="depth", kind="nan"))
    assert np.isnan(depth_of(nan)).all()
    first, second = spoiled(fault(part="depth", kind="freeze"), ticks=2)
    assert depth_of(first).tobytes() == depth_of(second).tobytes()
    [scaled] = spoiled(fault(part="depth", kind="scale", value=1.05))
    assert np.allclose(depth_of(scaled), 1.05)
    lost = spoiled(fault(part="depth", kind="drop", value=0.5), ticks=200)
    assert 60 < sum(told.depth is None for told in lost) < 140
    outliers = spoiled(fault(part="depth", kind="outliers", value=0.3), ticks=50)
    wrong = [depth_of(told) != depth_of(observation(t)) for t, told in enumerate(outliers)]
    assert 0.2 < np.mean(wrong) < 0.4
    assert all((told.foot_forces == 8.0 + t).all() for t, told in enumerate(outliers))


def test_each_fault_of_the_body_spoils_its_sense_alone() -> None:
    [biased] = spoiled(fault(part="imu", kind="bias", value=0.5))
    assert biased.angular_velocity.tolist() == [0.1, 0.2, 0.8]
    [swapped] = spoiled(fault(part="imu", kind="swap"))
    assert swapped.angular_velocity.tolist() == [0.2, 0.1, 0.3]
    assert swapped.specific_force.tolist() == [2.0, 1.0, 9.8]
    [zero] = spoiled(fault(part="imu", kind="zero"))
    assert not zero.angular_velocity.any()
    assert not zero.specific_force.any()
    [stuck] = spoiled(fault(part="feet", kind="stick", foot="right", cell=2, value=60.0))
    assert stuck.foot_forces.tolist() == [[8.0] * 4, [8.0, 8.0, 60.0, 8.0]]
    [dead] = spoiled(fault(part="feet", kind="dead", foot="left"))
    assert dead.foot_forces.tolist() == [[0.0] * 4, [8.0] * 4]
    _, _, still = spoiled(fault(part="encoders", kind="stick", joint="left_knee_pitch"), ticks=3)
    assert still.joint_positions.tolist() == [0.0, 0.2]
    assert still.joint_velocities.tolist() == [0.0, 0.0]


def test_what_comes_late_is_what_was_measured_or_asked_for_then() -> None:
    late = spoiled(fault(part="latency", kind="imu", value=0.02), ticks=5)
    assert [float(told.angular_velocity[0]) for told in late] == [0.1, 0.1, 0.1, 1.1, 2.1]
    asked = [JointTargets(np.full(2, t), np.zeros(2), np.zeros(2)) for t in range(4)]
    queue = LateTargets()
    told = [queue.told(targets, t * 10_000_000, 0.01) for t, targets in enumerate(asked)]
    assert [targets.position[0] for targets in told] == [0, 0, 1, 2]
    assert queue.told(asked[0], 40_000_000, 0.0) is asked[0]


def test_a_weak_motor_is_one_or_all() -> None:
    assert strengths(JOINTS, [("all", 0.6), ("neck_pan", 0.5)]).tolist() == [0.6, 0.3]


@pytest.mark.parametrize(
    ("event", "key"),
    [
        ('part="feet", kind="nan"', "event.0.kind"),
        ('part="ears", kind="nan"', "event.0.part"),
        ('part="depth", kind="scale"', "event.0.value"),
        ('part="depth", kind="drop", value=1.5', "event.0.value"),
        ('part="feet", kind="stick", foot="left", value=60.0', "event.0.cell"),
        ('part="feet", kind="dead", foot="middle"', "event.0.foot"),
        ('part="imu", kind="zero", joint="neck_pan"', "event.0.joint"),
        ('part="motors", kind="weak", value=-0.1', "event.0.value"),
        ('part="imu", kind="bias", value=nan', "event.0.value"),
        ('part="imu", kind="zero", duration=-1.0', "event.0.duration"),
    ],
)
def test_a_fault_that_is_none_is_refused_by_its_key(event: str, key: str) -> None:
    with pytest.raises(InputError, match=key):
        load_scenario("slalom", overrides=(f'event=[{{at=1.0, do="fault", {event}}}]',))


def test_every_kind_of_fault_says_when_it_begins_and_what_it_needs() -> None:
    assert issubclass(Fault, EventTable)
    given = {"value": 0.5, "joint": "neck_pan", "foot": "left", "cell": 1}
    for part, kinds in FAULTS.items():
        for kind, needs in kinds.items():
            made = fault(part=part, kind=kind, **{key: given[key] for key in needs.keys})  # type: ignore[arg-type]
            assert (made.at, made.duration) == (0.0, None)


def test_a_joint_that_the_robot_has_not_is_refused() -> None:
    event = 'event=[{at=1.0, do="fault", part="motors", kind="weak", value=0.5, joint="tail"}]'
    with pytest.raises(InputError, match=r"event\.0\.joint.*all, "):
        Episode("slalom", overrides=(event,))


def test_a_knock_turns_the_camera_down_and_left() -> None:
    episode = Episode("slalom", overrides=('event=[{at=0.0, do="knock", pitch=0.1, yaw=0.2}]',))
    camera, data = episode.sensors._depth.camera, episode.simulation.data
    _, before = camera.pose(data)
    episode.sensors.knock(0.0, 0.1, 0.2)
    _, after = camera.pose(data)
    left, down = -before[:, 0] @ after[:, 2], before[:, 1] @ after[:, 2]
    assert left == pytest.approx(np.sin(0.2) * np.cos(0.1), abs=0.02)
    assert down == pytest.approx(np.sin(0.1), abs=0.02)


def ended(event: str) -> tuple[Episode, str]:
    """Return an episode on `slalom` in which this broke, when it is over, and its reason."""
    episode = Episode("slalom", seed=3, overrides=(f"event=[{{{event}}}]", "time_limit=30.0"))
    while episode.verdict is None:
        episode.tick()
    return episode, f"{episode.verdict.outcome}: {episode.verdict.reason}"


@pytest.mark.scenario
@pytest.mark.parametrize(
    ("event", "which", "within_s"),
    [
        ('part="feet", kind="stick", foot="left", cell=0, value=60.0', "left foot", 4.0),
        ('part="feet", kind="dead", foot="right"', "right foot", 4.0),
        ('part="imu", kind="zero"', "the inertial unit", 4.0),
        ('part="imu", kind="swap"', "the gyroscope", 4.0),
        ('part="imu", kind="bias", value=0.0349', "the gyroscope", 4.0),
        ('part="depth", kind="freeze"', "the depth camera", 25.0),
    ],
)
@pytest.mark.parametrize("at", [0.0, 6.0])
def test_a_broken_sense_is_named_and_the_robot_stands(
    event: str, which: str, within_s: float, at: float
) -> None:
    episode, end = ended(f'at={at}, do="fault", {event}')
    assert end.startswith("refused: sensor: "), end
    assert which in end
    assert episode.judge.falls == 0
    assert 1e-9 * episode.simulation.time_ns < at + within_s
    if at == 0.0:
        start = episode.scenario.start.position
        assert np.hypot(episode.judge.frame.x - start[0], episode.judge.frame.y - start[1]) < 0.05
