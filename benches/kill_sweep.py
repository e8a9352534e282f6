"""A sweep that is killed (kill -9, workers and all) at random times until it is through.

python benches/kill_sweep.py --kills 50 --episodes 120
"""

import argparse
import json
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from into_results import add_options, write

SHORT = """
schema = 1
name = "short"
time_limit = 0.3
[start]
position = [0.0, 0.0]
[goal]
position = [1.0, 0.0]
[vary]
"start.yaw" = { uniform = [-0.3, 0.3] }
"""


def killed_sweep(
    scenario: Path, out: Path, *, kills: int, episodes: int, workers: int = 2
) -> tuple[dict[str, Any], int]:
    """Run a sweep, kill it so many times, let it end; return its results and how often it died.

    Less often than it was to where all was done before.

    Kills come within a few seconds of the last change of the journal, so that every state is met:
    before the first episode, between two, amid a recording, while results are written.
    """
    command = [sys.executable, "-m", "treadwell.cli.app", "sweep", str(scenario)]
    command += ["--episodes", str(episodes), "--workers", str(workers), "--out", str(out), "--json"]
    draw, journal = random.Random(episodes), out / "journal.jsonl"
    killed = 0
    for _ in range(kills):
        before = _size(journal)
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        # Half of the kills at any time, the others soon after an episode was noted.
        if draw.random() < 0.5:
            _wait(process, lambda size=before: _size(journal) > size)
            time.sleep(draw.uniform(0.0, 0.3))
        else:
            time.sleep(draw.uniform(0.3, 4.0))
        process.send_signal(signal.SIGKILL)
        process.communicate()
        killed += process.returncode == -signal.SIGKILL
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
    assert done.returncode in (0, 1), done.returncode
    document: dict[str, Any] = json.loads((out / "results.json").read_text())
    return document, killed


def _wait(process: "subprocess.Popen[bytes]", over: Any) -> None:  # noqa: ANN401
    while process.poll() is None and not over():
        time.sleep(0.005)


def _size(path: Path) -> int:
    return path.stat().st_size if path.is_file() else 0


def main() -> None:
    """Run it and say whether anything was lost or doubled."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--episodes", type=int, default=120)
    add_options(parser)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        scenario = Path(folder) / "short.toml"
        scenario.write_text(SHORT)
        out = Path(folder) / "out"
        document, killed = killed_sweep(
            scenario, out, kills=options.kills, episodes=options.episodes
        )
        lines = [
            json.loads(line)["seed"] for line in (out / "journal.jsonl").read_text().splitlines()
        ]
    lost = set(range(options.episodes)) - {row["seed"] for row in document["episodes"]}
    doubled = len(lines) - len(set(lines))
    sys.stdout.write(
        f"killed {killed} times: {len(document['episodes'])} of {options.episodes} episodes, "
        f"{len(lost)} lost, {doubled} doubled\n"
    )
    done = f"{len(lost)} / {doubled} of {options.episodes}, killed {killed} times"
    rows = [{"what": "episodes lost / doubled", "measured": done}]
    write(options, "Kill -9 at random times", None, rows)
    sys.exit(bool(lost or doubled))


if __name__ == "__main__":
    main()
