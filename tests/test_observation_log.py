"""Claims about observations.mcap: all of a run is in it, and what reached it stays readable."""

import resource
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from episode_builders import qrio, scenario
from mcap.reader import make_reader
from mcap.writer import Writer
from test_cdr import observation

from treadwell.errors import InputError, RecordingError
from treadwell.observation import Frame, Observation
from treadwell.recording.observation_log import (
    NAME,
    ObservationLog,
    folder_hash,
    read_header,
    read_observations,
)

TICK = 10_000_000


def sent(count: int) -> list[Observation]:
    """Observations with a noisy frame at every eighth."""
    random = np.random.default_rng(1)
    made = []
    for i in range(count):
        o = observation(seed=i, time_ns=i * TICK)
        depth = random.random((72, 88)).astype(np.float32)
        frame = Frame(max(0, i * TICK - 3), i * TICK, depth) if i % 8 == 0 else None
        made.append(
            Observation(
                o.time_ns,
                o.joint_positions,
                o.joint_velocities,
                o.angular_velocity,
                o.specific_force,
                o.foot_forces,
                frame,
            )
        )
    return made


def write(folder: Path, observations: list[Observation]) -> Path:
    log = ObservationLog(folder, scenario(), qrio())
    for each in observations:
        log.write(each)
    log.close()
    return folder / NAME


def test_every_observation_is_read_back_with_its_frame(tmp_path: Path) -> None:
    observations = sent(100)
    back = list(read_observations(write(tmp_path, observations)))
    assert len(back) == 100
    for a, b in zip(observations, back, strict=True):
        assert np.array_equal(a.joint_positions, b.joint_positions)
        assert (a.depth is None) == (b.depth is None)
        if a.depth is not None and b.depth is not None:
            assert np.array_equal(a.depth.depth, b.depth.depth)
            assert a.depth.exposure_ns == b.depth.exposure_ns
            assert a.depth.arrival_ns == b.depth.arrival_ns


def test_messages_of_one_time_may_stand_in_any_order(tmp_path: Path) -> None:
    path = write(tmp_path, sent(60))
    other = tmp_path / "other.mcap"
    with path.open("rb") as file, other.open("wb") as made:
        writer = Writer(made)
        writer.start()
        reader = make_reader(file)
        messages = sorted(reader.iter_messages(), key=lambda m: (m[2].log_time, m[1].topic))
        numbers: dict[str, int] = {}
        for _, channel, message in messages:
            if channel.topic not in numbers:
                numbers[channel.topic] = writer.register_channel(channel.topic, "cdr", 0)
            number, when = numbers[channel.topic], message.log_time
            writer.add_message(number, when, message.data, message.publish_time)
        writer.finish()  # type: ignore[no-untyped-call]
    assert [channel.topic for _, channel, _ in messages[:2]] == ["/depth", "/observation"]
    for a, b in zip(read_observations(path), read_observations(other), strict=True):
        assert (a.time_ns, a.depth is None) == (b.time_ns, b.depth is None)
        if a.depth is not None and b.depth is not None:
            assert a.depth.arrival_ns == b.depth.arrival_ns


def test_the_header_says_what_was_run(tmp_path: Path) -> None:
    header = read_header(write(tmp_path, sent(1)))
    assert header["scenario"] == "small"
    assert header["robot"] == "qrio"
    assert header["seed"] == "0"
    assert header["robot_hash"] == folder_hash(qrio().folder)
    assert header["joints"].split(",") == list(qrio().joints)


def test_a_file_that_breaks_off_gives_what_it_has(tmp_path: Path) -> None:
    path = write(tmp_path, sent(400))
    whole = path.read_bytes()
    path.write_bytes(whole[: int(0.7 * len(whole))])
    found = []
    with pytest.raises(InputError, match="breaks off"):
        found.extend([o.time_ns for o in _until_error(path, found)])
    assert len(found) > 100
    assert found == [i * TICK for i in range(len(found))]


def _until_error(path: Path, found: list[int]) -> list[Observation]:
    for each in read_observations(path):
        found.append(each.time_ns)
    return []


@pytest.mark.parametrize("content", [b"", b"nothing of the kind", b"\x89MCAP0\r\n" + 40 * b"\xff"])
def test_another_file_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / NAME
    path.write_bytes(content)
    with pytest.raises(InputError, match=NAME):
        list(read_observations(path))
    with pytest.raises(InputError, match=NAME):
        read_header(path)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        list(read_observations(tmp_path / NAME))


def test_a_folder_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=NAME):
        ObservationLog(tmp_path / "nowhere", scenario(), qrio())


FULL_DISK = """
import resource, signal, sys
from pathlib import Path
sys.path.insert(0, sys.argv[2])
from test_observation_log import ObservationLog, qrio, scenario, sent
from treadwell.errors import RecordingError
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
log = ObservationLog(Path(sys.argv[1]), scenario(), qrio())
resource.setrlimit(resource.RLIMIT_FSIZE, (600_000, 600_000))
try:
    for each in sent(2000):
        log.write(each)
    log.close()
except RecordingError as error:
    print("RecordingError", error)
"""


@pytest.mark.slow
def test_a_full_disk_is_one_clear_error_and_the_file_stays_readable(tmp_path: Path) -> None:
    run = subprocess.run(
        [sys.executable, "-c", FULL_DISK, str(tmp_path), str(Path(__file__).parent)],
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stdout.startswith("RecordingError")
    assert NAME in run.stdout
    found: list[int] = []
    with pytest.raises(InputError):
        _until_error(tmp_path / NAME, found)
    assert len(found) > 50


def test_the_hash_is_of_names_and_contents(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("1")
    first = folder_hash(tmp_path)
    (tmp_path / "a").write_text("2")
    second = folder_hash(tmp_path)
    (tmp_path / "a").rename(tmp_path / "b")
    assert len({first, second, folder_hash(tmp_path)}) == 3
    assert resource.getrlimit(resource.RLIMIT_FSIZE)[0] != 600_000
