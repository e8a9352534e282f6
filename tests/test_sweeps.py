"""Sweeps: what goes wrong in one episode stays there, and nothing is lost, doubled or different."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest
from sweep_builders import short

from treadwell.cli.app import execute
from treadwell.errors import InputError, RecordingError
from treadwell.judging.result import read_result
from treadwell.runner import run
from treadwell.sweeps.conduct import GIGABYTE, Care, conduct
from treadwell.sweeps.engine import local_engine
from treadwell.sweeps.request import Request, crossed
from treadwell.sweeps.row import COLUMNS, TIMED, Row, digest, row_of

pytestmark = pytest.mark.slow

HERE = Path(__file__).parent
CLOCK = {"wall_seconds", "core_ms", "folder", "reproduced"}


class Told:
    """Progress that remembers."""

    def __init__(self) -> None:
        self.calls: list[tuple[int, int]] = []

    def update(self, done: int, successes: int, _row: Row | None) -> None:
        self.calls.append((done, successes))


def swept(request: Request, out: Path, workers: int = 2, **care: Any) -> dict[str, Any]:  # noqa: ANN401
    return conduct(request, out, lambda: local_engine(workers), care=Care(**{"keep": 0} | care))


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, dict[str, Any]]:
    """A sweep of two variants and three seeds by two workers: folder, scenario, results."""
    place = tmp_path_factory.mktemp("sweep")
    scenario = short(place)
    request = crossed([scenario], seeds=range(3), vary=["physics.friction=0.7,0.9"])
    told = Told()
    engine = lambda: local_engine(2)  # noqa: E731
    document = conduct(request, place / "out", engine, care=Care(keep=1), progress=told)
    assert [count for count, _ in told.calls] == list(range(7))
    return place / "out", scenario, document


def test_a_sweep_leaves_its_results_as_json_and_as_parquet(
    done: tuple[Path, str, dict[str, Any]],
) -> None:
    out, _, document = done
    assert document == json.loads((out / "results.json").read_text())
    table = pq.read_table(out / "episodes.parquet")
    assert tuple(table.column_names) == COLUMNS
    assert table.to_pylist() == document["episodes"]
    seeds = [(row["variant"], row["seed"]) for row in document["episodes"]]
    variants = ("physics.friction=0.7", "physics.friction=0.9")
    assert seeds == [(variant, seed) for variant in variants for seed in range(3)]
    assert {row["outcome"] for row in document["episodes"]} == {"timed_out"}
    assert [line["episodes"] for line in document["summary"]] == [3, 3]
    assert not document["passed"]
    assert not (out / ".doing").exists()


def test_what_failed_has_its_recording_and_went_the_same_way_again(
    done: tuple[Path, str, dict[str, Any]],
) -> None:
    out, _, document = done
    for row in document["episodes"]:
        assert (out / row["folder"] / "recording.rrd").is_file()
        assert row["reproduced"] is (None if row["seed"] == 0 else True)
        result = read_result(out / row["folder"] / "result.json")
        assert result.seed == row["seed"]
        assert digest(result) == row["digest"]
    assert document["summary"][0]["not_reproduced"] == []


def test_an_episode_alone_gives_the_same_result_as_in_a_sweep(
    done: tuple[Path, str, dict[str, Any]], tmp_path: Path
) -> None:
    out, scenario, document = done
    alone = run(
        scenario, seed=2, overrides=["physics.friction=0.9"], out=tmp_path / "run", record=False
    )
    row = document["episodes"][-1]
    swept_result = json.loads((out / row["folder"] / "result.json").read_text())
    mine = alone.document
    for key in TIMED:
        del swept_result[key], mine[key]
    assert swept_result == mine
    assert digest(alone.result) == row["digest"]


def test_the_number_of_workers_changes_nothing(
    done: tuple[Path, str, dict[str, Any]], tmp_path: Path
) -> None:
    _, scenario, document = done
    request = crossed([scenario], seeds=range(3), vary=["physics.friction=0.7,0.9"])
    other = swept(request, tmp_path / "one", workers=1)
    for a, b in zip(document["episodes"], other["episodes"], strict=True):
        assert {k: a[k] for k in a.keys() - CLOCK} == {k: b[k] for k in b.keys() - CLOCK}


def test_a_sweep_goes_on_with_more_seeds_and_with_nothing_else(
    done: tuple[Path, str, dict[str, Any]], tmp_path: Path
) -> None:
    _, scenario, _ = done
    out = tmp_path / "out"
    swept(crossed([scenario], seeds=range(1)), out)
    first = (out / "journal.jsonl").read_bytes()
    more = swept(crossed([scenario], seeds=range(2)), out)
    assert (out / "journal.jsonl").read_bytes().startswith(first)
    assert [row["seed"] for row in more["episodes"]] == [0, 1]
    for request, what in (
        (crossed([scenario], seeds=range(1)), "episodes was 2 from seed 0 on, now 1"),
        (crossed([scenario], seeds=range(2), settings=["time_limit=0.1"]), "settings of short"),
        (crossed([scenario], seeds=range(2), robot="nao"), "robot of short was qrio, now nao"),
        (crossed([scenario], seeds=range(2), vary=["seed=1,2"]), "number of scenarios and var"),
    ):
        with pytest.raises(InputError, match=what):
            swept(request, out)


def test_a_component_that_goes_wrong_takes_nothing_along(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(HERE))
    ways = ["well", "crash", "leave", "hang", "memory", "raise"]
    request = crossed(
        [short(tmp_path)],
        seeds=range(1),
        settings=["navigation.planner=sweep_builders:Odd"],
        vary=[f"navigation.Odd.how={','.join(ways)}"],
    )
    assert all(line.parts for line in request.lines)
    document = swept(request, tmp_path / "out", seconds=8.0, memory=2 * GIGABYTE)
    rows = dict(zip(ways, document["episodes"], strict=True))
    assert rows["well"]["outcome"] == "timed_out"
    assert {row["outcome"] for way, row in rows.items() if way != "well"} == {"error"}
    assert "SIGSEGV" in rows["crash"]["reason"]
    assert "ended with status 9" in rows["leave"]["reason"]
    assert "took longer than 8 s" in rows["hang"]["reason"]
    assert "MemoryError" in rows["memory"]["reason"]
    assert "cannot plan" in rows["raise"]["reason"]
    assert rows["raise"]["folder"] is not None
    assert rows["hang"]["folder"] is None


def test_what_nothing_can_be_built_of_is_bad_input_before_anything_runs(tmp_path: Path) -> None:
    request = crossed([short(tmp_path)], seeds=range(2), settings=["navigation.fog.cel=0.04"])
    with pytest.raises(InputError, match="cell"):
        swept(request, tmp_path / "out")
    assert (tmp_path / "out" / "journal.jsonl").read_bytes() == b""


def test_two_processes_do_not_share_a_sweep(tmp_path: Path) -> None:
    request = crossed([short(tmp_path)], seeds=range(1))
    out = tmp_path / "out"

    class Second:
        def update(self, *_: object) -> None:
            with pytest.raises(InputError, match="another process is working"):
                swept(request, out)

    conduct(request, out, lambda: local_engine(1), care=Care(keep=0), progress=Second())


def test_a_folder_that_holds_something_else_is_refused(tmp_path: Path) -> None:
    request = crossed([short(tmp_path)], seeds=range(1))
    with pytest.raises(InputError, match="holds no sweep"):
        swept(request, tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="holds no sweep"):
        swept(request, tmp_path / "file")


def test_a_disk_that_is_full_stops_the_sweep_and_loses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from treadwell.sweeps import journal

    request, out = crossed([short(tmp_path)], seeds=range(2)), tmp_path / "out"
    rows = [0]

    def half(file: int, line: bytes) -> int:
        rows[0] += line.startswith(b'{"scenario"')
        return real(file, line[: 10 if rows[0] == 2 else None])

    real = os.write
    monkeypatch.setattr(journal.os, "write", half)
    with pytest.raises(RecordingError, match="No space left"):
        swept(request, out)
    monkeypatch.undo()
    assert len((out / "journal.jsonl").read_text().splitlines()) == 1
    assert len(swept(request, out)["episodes"]) == 2


KILLS = int(os.environ.get("TREADWELL_KILLS", "3"))


def test_after_kill_9_at_any_time_no_episode_is_lost_or_doubled(tmp_path: Path) -> None:
    """`benches/kill_sweep.py` does the same fifty times."""
    from kill_sweep import killed_sweep

    document, kills = killed_sweep(Path(short(tmp_path)), tmp_path / "out", kills=KILLS, episodes=8)
    assert 1 <= kills <= KILLS
    assert [row["seed"] for row in document["episodes"]] == list(range(8))
    lines = (tmp_path / "out" / "journal.jsonl").read_text().splitlines()
    rows = [row_of(json.loads(line)) for line in lines]
    assert len({row.key for row in rows}) == len(rows) == 8
    folders = {row["folder"] for row in document["episodes"]}
    assert {f"episodes/{path.name}" for path in (tmp_path / "out/episodes").iterdir()} == folders


def test_the_command_says_how_it_went_and_how_it_goes_on(
    done: tuple[Path, str, dict[str, Any]], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    out, scenario, document = done
    asked = ["sweep", scenario, "--episodes", "3", "--vary", "physics.friction=0.7,0.9"]
    assert execute([*asked, "--out", str(out), "--json"]) == 1
    shown = json.loads(capsys.readouterr().out)
    assert shown["summary"] == document["summary"]
    assert "episodes" not in shown
    assert execute([*asked, "--out", str(out)]) == 1
    captured = capsys.readouterr()
    assert "0 of 3" in captured.out
    assert "6 of 6 episodes" in captured.err
    assert execute(["sweep", "--episodes", "3", "--out", str(tmp_path / "x")]) == 2
    assert execute(["sweep", scenario, "--out", str(tmp_path / "x")]) == 2
    assert execute(["sweep", scenario, "--episodes", "1", "--suite", "leaderboard"]) == 2
    assert not (tmp_path / "x").exists()


def test_ctrl_c_ends_the_workers_and_keeps_what_was_done(tmp_path: Path) -> None:
    scenario, out = short(tmp_path), tmp_path / "out"
    command = [sys.executable, "-m", "treadwell.cli.app", "sweep", scenario, "--episodes", "200"]

    def heed() -> None:  # whoever runs the tests in the background may have it ignored
        signal.signal(signal.SIGINT, signal.SIG_DFL)

    with subprocess.Popen(
        [*command, "--workers", "1", "--keep", "0", "--out", str(out)],
        stderr=subprocess.PIPE,
        preexec_fn=heed,
    ) as process:
        journal = out / "journal.jsonl"
        while not journal.is_file() or not journal.stat().st_size:
            time.sleep(0.05)
            assert process.poll() is None
        process.send_signal(signal.SIGINT)
        _, error = process.communicate(timeout=30)
    assert process.returncode == 130
    assert f"--out {out} goes on" in error.decode()
    assert 1 <= len(journal.read_text().splitlines()) < 200
