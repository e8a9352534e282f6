"""Every script of `benches/` runs to its end on its least task; its figures are not looked at."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.long

BENCHES = Path(__file__).resolve().parents[1] / "benches"
SHORT = """
schema = 1
name = "short"
time_limit = 0.6
[start]
position = [0.0, 0.0]
[goal]
position = [1.0, 0.0]
"""
LEAST: dict[str, list[str]] = {
    "cut_runs.py": ["--ends", "1", "--disks", "1", "--seconds", "0.3"],
    "episodes.py": ["SHORT", "--seeds", "0", "--workers", "1", "--audit"],
    "extreme_numbers.py": ["scenario", "--only", "slalom goal.radius", "--seconds", "0.1"],
    "fuzz_files.py": ["--count", "3"],
    "intel_log.py": ["--seeds", "1", "--scans", "30"],
    "intel_slam.py": ["--seeds", "1", "--scans", "30"],
    "kill_sweep.py": ["--kills", "1", "--episodes", "2"],
    "learn_labels.py": ["learned.txt", "--houses", "12"],
    "map_localization.py": ["--seeds", "1", "--frames", "3", "--resolution", "0.08"],
    "memory.py": ["--minutes", "0.02"],
    "moving_people.py": ["--scenes", "1", "--seconds", "12"],
    "odometry.py": ["--seeds", "0", "--workers", "1", "--seconds", "0.3"],
    "peers/bonxai.py": ["SOURCES", "--frames", "1"],
    "peers/distance.py": ["--side", "60"],
    "peers/ground.py": ["--samples", "samp21"],
    "peers/occupancy.py": ["--frames", "1"],
    "peers/octree.py": ["--frames", "1", "--cells", "0.04"],
    "peers/rays.py": ["--cells", "0.04"],
    "random_scenarios.py": ["--count", "1", "--first-seed", "9"],
    "real_data.py": ["--rows", "1"],
    "room_labels.py": ["--houses", "2", "--looks", "2"],
    "replay_runs.py": ["--count", "1", "--seconds", "0.5"],
    "rules_trial.py": ["record", "FOLDER", "--courses", "SHORT"],
    "seam.py": ["--seconds", "0.3"],
    "sense_faults.py": ["--scenarios", "SHORT", "--seeds", "0", "--faults", "imu zero"],
    "slip_trials.py": ["--patches", "2", "--seconds", "3.2"],
    "soak.py": ["--hours", "0.0001", "--scenarios", "SHORT"],
    "speed.py": ["--scenario", "SHORT", "--seeds", "0"],
    "stairs_seen.py": ["up", "--seeds", "0"],
    "treads_seen.py": ["--before", "0.5", "--seconds", "0.5", "--steps", "1"],
    "unchanged.py": ["record", "FOLDER", "--only", "slalom-qrio-0", "--seconds", "0.5"],
    "walking_trials.py": ["stop", "--trials", "1"],
}
"""What each is given, so that it takes a second or two."""
NEEDS = {
    "peers/distance.py": "cv2",
    "peers/ground.py": "CSF",
    "peers/occupancy.py": "pyoctomap",
    "peers/octree.py": "pyoctomap",
    "peers/rays.py": "pyoctomap",
}


def scripts() -> list[str]:
    """Return those that are run by themselves."""
    found = [path for folder in (BENCHES, BENCHES / "peers") for path in folder.glob("*.py")]
    mains = [path for path in found if "__main__" in path.read_text(encoding="utf-8")]
    return sorted(path.relative_to(BENCHES).as_posix() for path in mains)


@pytest.mark.parametrize("script", scripts())
def test_a_bench_runs_to_its_end(script: str, tmp_path: Path) -> None:
    if script in NEEDS:
        pytest.importorskip(NEEDS[script], reason=f"{script} is measured against a peer")
    sources = os.environ.get("BONXAI_SOURCES", "")
    if script == "peers/bonxai.py" and not sources:
        pytest.skip("BONXAI_SOURCES does not say where Bonxai's sources are")
    if script in ("real_data.py", "peers/ground.py") and not os.environ.get("TREADWELL_DATA"):
        pytest.skip("TREADWELL_DATA does not say where data are")
    short = tmp_path / "short.toml"
    short.write_text(SHORT, encoding="utf-8")
    places = {"SHORT": str(short), "SOURCES": sources, "FOLDER": str(tmp_path / "folder")}
    words = [places.get(word, word) for word in LEAST[script]]
    done = subprocess.run(
        [sys.executable, str(BENCHES / script), *words],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.strip()
