"""An episode: frame by frame, tick by tick, and nothing of one reaches the next."""

import numpy as np
import pytest

import treadwell
from treadwell._core import Pilot
from treadwell.errors import InputError
from treadwell.scenario.loading import load_scenario


def short(seconds: float = 1.0, *overrides: str, seed: int = 1) -> treadwell.Episode:
    limit = f"time_limit={seconds}"
    return treadwell.Episode("slalom", seed=seed, overrides=(limit, *overrides))


def test_each_step_is_a_camera_frame_of_80_milliseconds() -> None:
    episode = short()
    steps = [*episode]
    times = np.array([step.time_ns for step in steps])
    assert (np.diff(times) == 80_000_000).all()
    assert len(steps) in {12, 13}
    for step in steps:
        frame = step.observation.depth
        assert frame is not None
        assert (frame.depth.shape, frame.depth.dtype) == ((72, 88), np.float32)
        assert frame.exposure_ns <= frame.arrival_ns == step.time_ns
        assert len(step.estimate.pose) == len(step.estimate.odometry) == 4
        assert step.command.position.shape == (26,)
        assert step.state


def test_it_ends_with_a_verdict_and_stays_ended() -> None:
    episode = short(0.3)
    assert episode.verdict is None
    list(episode)
    assert episode.verdict is not None
    assert episode.verdict.outcome == "timed_out"
    assert episode.simulation.time_ns == 300_000_000
    assert list(episode) == []


def test_a_tick_is_10_milliseconds_and_needs_no_frame() -> None:
    episode = short()
    first, second = episode.tick(), episode.tick()
    assert (first.time_ns, second.time_ns) == (0, 10_000_000)
    assert second.observation.depth is None
    assert episode.simulation.time_ns == 20_000_000


def test_a_scenario_that_is_already_loaded_is_taken_as_it_is() -> None:
    made = load_scenario("slalom", seed=7, overrides=("time_limit=0.2",))
    episode = treadwell.Episode(made)
    assert episode.scenario is made
    assert episode.scenario.seed == 7


def test_robot_and_seed_beat_the_file() -> None:
    episode = treadwell.Episode("slalom", robot="qrio", seed=11)
    assert episode.robot.name == "qrio"
    assert episode.scenario.seed == 11
    with pytest.raises(InputError, match="qiro"):
        treadwell.Episode("slalom", robot="qiro")


@pytest.mark.parametrize("key", ["fog.cell=0", "fog.sell=1", "a_star.no=1", "walking.no=1"])
def test_a_bad_parameter_is_bad_input_before_anything_runs(key: str) -> None:
    with pytest.raises(InputError, match=r"navigation\."):
        short(1.0, f"navigation.{key}")


def test_the_robot_is_told_no_pose_and_begins_to_see_and_plan() -> None:
    episode = short(2.0)
    list(episode)
    assert episode.pilot.frames_used > 5
    assert episode.pilot.path() is not None
    pose = episode.tick().estimate.pose
    assert pose[:2] == pytest.approx(episode.scenario.start.position, abs=0.2)


def test_every_stage_that_runs_is_timed() -> None:
    episode = short(2.0)
    frames = len([*episode])
    seconds = episode.seconds
    assert set(seconds) == {"physics", "depth", *Pilot.stages}
    assert len(seconds["physics"]) == len(seconds["walk"]) == len(seconds["behave"]) == 200
    assert len(seconds["depth"]) == frames
    assert 0 < len(seconds["segment"]) <= frames
    assert all(value >= 0.0 for values in seconds.values() for value in values)


def test_two_episodes_at_once_do_not_touch_each_other() -> None:
    alone, one, other = short(0.5), short(0.5), short(0.5, seed=2)
    for _ in range(50):
        expected = alone.tick()
        found = one.tick()
        other.tick()
        assert (found.command.position == expected.command.position).all()
    assert (one.simulation.data.qpos == alone.simulation.data.qpos).all()
    assert (one.simulation.data.qpos != other.simulation.data.qpos).any()


def test_latency_delays_the_pictures_and_not_their_exposure() -> None:
    steps = [*short(1.0, "sensors.latency=0.1")]
    frames = [step.observation.depth for step in steps]
    assert frames
    for frame in frames:
        assert frame is not None
        assert frame.arrival_ns - frame.exposure_ns == 100_000_000


def test_intensity_comes_beside_the_depth_and_changes_nothing_else() -> None:
    plain, bright = [*short(1.0)], [*short(1.0, "sensors.intensity=true")]
    assert len(plain) == len(bright) > 5
    for without, with_it in zip(plain, bright, strict=True):
        one, other = without.observation.depth, with_it.observation.depth
        assert one is not None
        assert other is not None
        np.testing.assert_array_equal(one.depth, other.depth)
        assert one.intensity is None
        assert other.intensity is not None
        assert other.intensity.shape == other.depth.shape
        assert len(np.unique(other.intensity)) > 1


def test_a_blinded_robot_gets_no_pictures_for_that_long() -> None:
    episode = short(2.0, 'event=[{at=0.3, do="blind", duration=1.0}]')
    times = [1e-9 * step.time_ns for step in episode]
    assert times[0] == 0.0
    assert [time for time in times if 0.31 < time < 1.3] == []
    assert len([time for time in times if time <= 0.31]) == 4
    assert len([time for time in times if time >= 1.3]) > 6


def test_an_encoder_that_slips_reads_wrong_from_then_on() -> None:
    joint = treadwell.Episode("slalom").robot.joints[3]
    slip = f'event=[{{at=0.2, do="encoder_offset", joint="{joint}", value=0.2}}]'
    plain, slipped = short(1.0), short(1.0, slip)
    for tick in range(22):
        before = plain.tick().observation.joint_positions[3]
        after = slipped.tick().observation.joint_positions[3]
        assert after - before == pytest.approx(0.2 if tick > 20 else 0.0, abs=0.03)
