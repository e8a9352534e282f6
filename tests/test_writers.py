"""What is written into a run's folder: in order, each though another fails, the result last."""

from pathlib import Path
from typing import Any

import pytest
from episode_builders import entities

import treadwell
from treadwell.errors import InputError, RecordingError
from treadwell.judging.result import read_result
from treadwell.recording import writers
from treadwell.recording.observation_log import read_observations
from treadwell.runner import run


@pytest.fixture
def episode() -> treadwell.Episode:
    return treadwell.Episode("slalom", seed=1, overrides=("time_limit=0.2",))


def test_without_recording_only_scenario_and_audit_are_written_at_first(
    tmp_path: Path, episode: treadwell.Episode
) -> None:
    made = writers.Writers(tmp_path, episode, record=False)
    made.tick(episode.tick())
    there = {path.name for path in tmp_path.iterdir()}
    assert there == {"scenario.toml", "model.mjb", "physics.part"}


def test_a_folder_that_vanished_is_an_error_of_the_recording(
    tmp_path: Path, episode: treadwell.Episode
) -> None:
    for record in (True, False):
        with pytest.raises(RecordingError, match=r"gone: cannot be written: No such file"):
            writers.Writers(tmp_path / "gone", episode, record=record)


def test_the_result_is_written_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    there: list[set[str]] = []
    write = writers.Result.write

    def spy(self: writers.Result, path: Path) -> None:
        there.append({each.name for each in path.parent.iterdir()})
        write(self, path)

    monkeypatch.setattr(writers.Result, "write", spy)
    run("slalom", overrides=("time_limit=0.2",), out=tmp_path / "run")
    assert {"recording.rrd", "observations.mcap", "physics.npz", "map.png"} <= there[0]
    assert len(there) == 1


def test_a_recording_that_breaks_ends_the_run_and_leaves_its_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from treadwell.recording.observation_log import ObservationLog

    append, count = ObservationLog.append, [0]

    def full(self: ObservationLog, entries: Any) -> None:  # noqa: ANN401 - handed on
        count[0] += 1
        if count[0] > 2:
            raise RecordingError("observations.mcap: No space left on device")
        append(self, entries)

    monkeypatch.setattr(ObservationLog, "append", full)
    out = tmp_path / "run"
    with pytest.raises(RecordingError, match=r"observations\.mcap: No space left"):
        run("slalom", overrides=("time_limit=1",), out=out)
    assert (out / "result.json").is_file()
    assert '"outcome": "error"' in (out / "result.json").read_text()
    assert "/map/floor" in entities(out / "recording.rrd")


def test_a_recording_that_breaks_loses_no_observation(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from treadwell.recording.recorder import Recorder

    def full(self: Recorder, trace: Any) -> None:  # noqa: ANN401, ARG001 - of the same form
        raise RecordingError("recording.rrd: the disk is full")

    monkeypatch.setattr(Recorder, "frame", full)
    out = tmp_path / "run"
    with pytest.raises(RecordingError, match=r"recording\.rrd: the disk is full"):
        run("slalom", overrides=("time_limit=1",), out=out)
    ticks = round(100 * read_result(out / "result.json").simulated_seconds)
    assert 0 < ticks < 100
    assert sum(1 for _ in read_observations(out / "observations.mcap")) == ticks


def test_a_window_that_cannot_be_opened_is_bad_input(
    episode: treadwell.Episode, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(InputError, match="--view: no window can be opened"):
        writers.open_viewer(episode)
