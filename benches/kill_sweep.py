"""Sweeps that are ended at random times until they are through: kill -9, TERM, HUP, INT, INT twice.

python benches/kill_sweep.py --kills 50 --episodes 120
python benches/kill_sweep.py --sweeps 50 --kills 2 --episodes 8 --signals
"""

import argparse
import json
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

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


KILL: Final = (signal.SIGKILL,)
WAYS: Final = (
    KILL,
    (signal.SIGTERM,),
    (signal.SIGHUP,),
    (signal.SIGINT,),
    (signal.SIGINT, signal.SIGINT),
)


def killed_sweep(
    scenario: Path,
    out: Path,
    *,
    kills: int,
    episodes: int,
    workers: int = 2,
    ways: Sequence[Sequence[signal.Signals]] = (KILL,),
    seed: int = 0,
) -> tuple[dict[str, Any], int]:
    """Run a sweep, kill it so many times, let it end; return its results and how often it died.

    Less often than it was to where all was done before.

    Kills come within a few seconds of the last change of the journal, so that every state is met:
    before the first episode, between two, amid a recording, while results are written.
    """
    command = [sys.executable, "-m", "treadwell.cli.app", "sweep", str(scenario)]
    command += ["--episodes", str(episodes), "--workers", str(workers), "--out", str(out), "--json"]
    draw, journal = random.Random(episodes + seed), out / "journal.jsonl"
    killed = 0
    for _ in range(kills):
        before = _size(journal)
        process = subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=_with_signals,
        )
        # Half of the kills at any time, the others soon after an episode was noted.
        if draw.random() < 0.5:
            _wait(process, lambda size=before: _size(journal) > size)
            time.sleep(draw.uniform(0.0, 0.3))
        else:
            time.sleep(draw.uniform(0.3, 4.0))
        way = draw.choice(ways)
        for number in way:
            process.send_signal(number)
            time.sleep(0.05 if len(way) > 1 else 0.0)
        _, messages = process.communicate()
        assert "fault of treadwell" not in messages, messages
        killed += process.returncode not in (0, 1)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
    assert done.returncode in (0, 1), done.returncode
    document: dict[str, Any] = json.loads((out / "results.json").read_text())
    return document, killed


def _with_signals() -> None:
    """Let signals count, also where this runs in the background of a shell that ignores them."""
    for number in (signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


def _wait(process: "subprocess.Popen[str]", over: Any) -> None:  # noqa: ANN401
    while process.poll() is None and not over():
        time.sleep(0.005)


def _size(path: Path) -> int:
    return path.stat().st_size if path.is_file() else 0


def main() -> None:
    """Run it and say whether anything was lost or doubled."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--episodes", type=int, default=120)
    parser.add_argument("--sweeps", type=int, default=1)
    parser.add_argument("--signals", action="store_true", help="not kill -9 alone")
    add_options(parser)
    options = parser.parse_args()
    killed = lost = doubled = 0
    for number in range(options.sweeps):
        with tempfile.TemporaryDirectory() as folder:
            scenario = Path(folder) / "short.toml"
            scenario.write_text(SHORT)
            out = Path(folder) / "out"
            document, times = killed_sweep(
                scenario,
                out,
                kills=options.kills,
                episodes=options.episodes,
                ways=WAYS if options.signals else (KILL,),
                seed=number,
            )
            text = (out / "journal.jsonl").read_text()
        seeds = [json.loads(line)["seed"] for line in text.splitlines()]
        killed += times
        lost += len(set(range(options.episodes)) - {row["seed"] for row in document["episodes"]})
        doubled += len(seeds) - len(set(seeds))
        sys.stderr.write(f"sweep {number + 1} of {options.sweeps}: ended {times} times\n")
    of = options.sweeps * options.episodes
    done = f"{lost} / {doubled} of {of}, ended {killed} times"
    sys.stdout.write(f"episodes lost / doubled: {done}\n")
    rows = [{"what": "episodes lost / doubled", "measured": done}]
    title = "Sweeps ended by signals" if options.signals else "Kill -9 at random times"
    write(options, title, None, rows)
    sys.exit(bool(lost or doubled))


if __name__ == "__main__":
    main()
