"""Claims about the first difference of two runs: the tick, and what it is."""

from pathlib import Path

import numpy as np
import pytest
from episode_builders import qrio, scenario
from test_observation_log import TICK, sent

from treadwell.cli.app import execute
from treadwell.recording.messages import encode_command, encode_estimate
from treadwell.recording.observation_log import NAME, ObservationLog
from treadwell.replaying.difference import between_answers, between_logs

JOINTS = qrio().joints


def answer(**changes: object) -> tuple[bytes, bytes]:
    n = len(JOINTS)
    arrays = {name: np.zeros(n) for name in ("positions", "velocities", "torques")}
    belief = {"pose": (0.0,) * 4, "odometry": (0.0,) * 4, "state": "walk", "outcome": None}
    told = belief | {"reason": None} | {k: v for k, v in changes.items() if k not in arrays}
    arrays |= {k: v for k, v in changes.items() if k in arrays}  # type: ignore[misc]
    return encode_command(5, **arrays), encode_estimate(5, **told)  # type: ignore[arg-type]


def test_the_same_answers_do_not_differ() -> None:
    assert between_answers(answer(), answer(), JOINTS) is None


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"pose": (0.0, 1e-300, 0.0, 0.0)}, r"estimate\.y is 1e-300 instead of 0\.0"),
        ({"pose": (-0.0, 0.0, 0.0, 0.0)}, r"estimate\.x is -0\.0 instead of 0\.0"),
        ({"odometry": (0.0, 0.0, 0.0, 1.0)}, r"odometry\.yaw is 1\.0"),
        ({"state": "climb"}, "state: 'climb' instead of 'walk'"),
        ({"outcome": "refused"}, "outcome: 'refused' instead of ''"),
        ({"torques": np.eye(len(JOINTS))[2]}, rf"command\.torque\.{JOINTS[2]} is 1\.0"),
    ],
)
def test_a_bit_that_differs_is_named(changes: dict[str, object], word: str) -> None:
    import re

    found = between_answers(answer(**changes), answer(), JOINTS)
    assert found is not None
    assert re.search(word, found)


def test_a_recorded_answer_that_is_none_is_told() -> None:
    assert between_answers(answer(), (b"", b""), JOINTS) == "the recorded answer cannot be read"


def write(folder: Path, count: int = 30, change: str = "") -> Path:
    folder.mkdir()
    log = ObservationLog(folder, scenario(), qrio())
    for i, observation in enumerate(sent(count)):
        late = i == 17
        if late and change == "observation":
            observation.joint_velocities[1] += 1e-15
        if late and change == "depth":
            before = sent(count)[16].depth
            assert before is not None
        if i == 16 and change == "depth" and observation.depth is not None:
            observation.depth.depth[3, 4] = 9.0
        log.write(observation)
        state = "climb" if late and change == "estimate" else "walk"
        command, estimate = answer(state=state)
        log.write_answer(i * TICK, command, estimate)
        x = 1.0 if late and change == "truth" else 0.0
        log.write_truth((i + 1) * TICK, (x, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    log.close()
    return folder


@pytest.mark.parametrize(
    ("change", "tick", "word"),
    [
        ("observation", 17, f"observation.joint_velocities.{JOINTS[1]}"),
        ("depth", 16, "depth: 1 pixels"),
        ("estimate", 17, "state: 'climb'"),
        ("truth", 17, "truth.x is 1.0"),
    ],
)
def test_the_first_tick_at_which_two_logs_differ_is_found(
    tmp_path: Path, change: str, tick: int, word: str
) -> None:
    one, other = write(tmp_path / "a"), write(tmp_path / "b", change=change)
    found = between_logs(one / NAME, other / NAME, JOINTS)
    assert found is not None
    assert found.tick == tick
    assert word in found.what
    assert f"first difference at tick {tick} ({0.01 * tick:.2f} s)" in found.sentence()


def test_a_log_that_ends_before_the_other_is_named(tmp_path: Path) -> None:
    one, other = write(tmp_path / "a"), write(tmp_path / "b", count=20)
    found = between_logs(one / NAME, other / NAME, JOINTS)
    assert found is not None
    assert found.tick == 19
    assert str(other) in found.what


def test_verify_compares_a_run_with_another(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one, other = write(tmp_path / "a"), write(tmp_path / "b", change="truth")
    assert execute(["verify", str(other), "--against", str(one)]) == 1
    assert "first difference at tick 17 (0.17 s): truth.x" in capsys.readouterr().out
    execute(["verify", str(one), "--against", str(one)])
    assert "the same recording, bit for bit" in capsys.readouterr().out
    assert execute(["verify", str(one), "--against", str(tmp_path / "nowhere")]) == 2
