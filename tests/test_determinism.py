"""One scenario, robot and seed give one result, in any process and with any threads."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import treadwell

pytestmark = pytest.mark.slow

SCENARIO, SEED, LIMIT = "slalom", 6, "time_limit=16"
TIMED = {"wall_seconds", "real_time_factor", "physics_real_time_factor", "timing_ms"}


def outcome(folder: Path) -> dict[str, Any]:
    document = json.loads((folder / "result.json").read_text())
    return {key: value for key, value in document.items() if key not in TIMED}


def same_files(one: Path, other: Path) -> bool:
    names = ("trajectory.tum", "trajectory_truth.tum", "model.mjb", "map.png")
    return all((one / name).read_bytes() == (other / name).read_bytes() for name in names)


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of 16 seconds: looking around, walking, planning anew."""
    out = tmp_path_factory.mktemp("first") / "run"
    treadwell.run(SCENARIO, seed=SEED, overrides=(LIMIT,), out=out, record=False)
    return out


def test_a_run_that_walks_is_compared(first: Path) -> None:
    assert outcome(first)["steps_taken"] > 3


def test_the_same_after_another_episode(first: Path, tmp_path: Path) -> None:
    treadwell.run("curtain", overrides=("time_limit=3",), out=tmp_path / "other", record=False)
    treadwell.run(SCENARIO, seed=SEED, overrides=(LIMIT,), out=tmp_path / "run", record=False)
    assert outcome(tmp_path / "run") == outcome(first)
    assert same_files(tmp_path / "run", first)


@pytest.mark.parametrize("threads", [pytest.param("1", marks=pytest.mark.long), "7"])
def test_the_same_in_another_process_with_other_threads_and_hashes(
    first: Path, tmp_path: Path, threads: str
) -> None:
    numbers = {"RAYON_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "PYTHONHASHSEED"}
    done = subprocess.run(
        [
            sys.executable, "-m", "treadwell.cli.app", "run", SCENARIO, "--seed", str(SEED),
            "--set", LIMIT, "--out", str(tmp_path / "run"), "--record",
        ],
        env=os.environ | dict.fromkeys(numbers, threads),
        cwd=tmp_path,
        check=False,
        capture_output=True,
        text=True,
    )  # fmt: skip
    assert done.returncode in {0, 1}, done.stderr
    assert outcome(tmp_path / "run") == outcome(first)
    assert same_files(tmp_path / "run", first)


def test_another_seed_gives_another_run(first: Path, tmp_path: Path) -> None:
    out = tmp_path / "run"
    treadwell.run(SCENARIO, seed=SEED + 1, overrides=("time_limit=2",), out=out, record=False)
    assert outcome(out)["configuration"]["start"] != outcome(first)["configuration"]["start"]
