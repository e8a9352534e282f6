"""Runs that are ended at random moments, and runs whose disk fills: what is left of them.

python benches/cut_runs.py --ends 200
python benches/cut_runs.py --disks 100
"""

import argparse
import mmap
import os
import random
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import time
from collections import Counter
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from into_results import add_options, write

from treadwell.physics.parts import QPOS, part_rows
from treadwell.recording.cut_off import cut_run
from treadwell.recording.verification import verify_run

if TYPE_CHECKING:
    from collections.abc import Iterator

RUN: Final = """
import mmap, signal, struct, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)
from treadwell.cli.app import main
from treadwell.episode import Episode
file = open(sys.argv.pop(1), "r+b")
reached = mmap.mmap(file.fileno(), 8)
tick = Episode.tick
def counted(episode):
    step = tick(episode)
    struct.pack_into("<q", reached, 0, step.time_ns)
    return step
signal.signal(signal.SIGINT, signal.default_int_handler)
Episode.tick = counted
main()
"""
"""A run that notes in shared memory how far it has come, which outlives it."""
WAYS: Final = {
    "kill -9": (signal.SIGKILL,),
    "TERM": (signal.SIGTERM,),
    "HUP": (signal.SIGHUP,),
    "INT": (signal.SIGINT,),
    "INT twice": (signal.SIGINT, signal.SIGINT),
}
TICK_S: Final = 0.01
LARGEST_DISK: Final = 6e7
"""Bytes: of a whole run and what it wants to have spare."""
LATEST_S: Final = 5.0
"""Of the clock, after the folder was made, that a run is ended at."""


def started(folder: Path, seconds: float, seen: Path, limit: int | None) -> "subprocess.Popen[str]":
    """Start a run.

    Args:
        folder: the run's, not yet there.
        seconds: simulated, at most.
        seen: a file of eight bytes, for the simulated time that it has reached, ns.
        limit: bytes that a file may have at most; None: as many as it likes.
    """

    def prepare() -> None:
        for number in (signal.SIGINT, signal.SIGHUP):
            signal.signal(number, signal.SIG_DFL)
        if limit is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    command = [sys.executable, "-c", RUN, str(seen), "run", "slalom", "--out", str(folder)]
    command += ["--set", f"time_limit={seconds}"]
    return subprocess.Popen(
        command,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=prepare,
        # Where a disk is full Python leaves half a compiled module behind, and does not notice.
        env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
    )


def left_of(folder: Path, reached_s: float) -> tuple[str, float]:
    """Return what a folder is, and how many simulated seconds before its end were not recorded.

    Args:
        folder: the run's.
        reached_s: simulated seconds that the run had come to.
    """
    if not folder.exists():
        return "none", 0.0
    found = verify_run(folder)
    if found.problems:
        return f"BROKEN: {found.problems[0]}", 0.0
    if found.cut is None:
        return "whole", 0.0
    audited = (part_rows(folder, QPOS) or 0) * TICK_S
    told = cut_run(folder)
    kept = min(audited, (told.seconds if told else None) or 0.0)
    return "cut off", max(0.0, reached_s + TICK_S - kept)


def ended(way: str, delay_s: float, place: Path, seconds: float) -> tuple[str, float]:
    """Run, end the run in some way, and return what is left of it."""
    folder, seen = place / "run", place / "seen"
    seen.write_bytes(bytes(8))
    process = started(folder, seconds, seen, None)
    # Half of them at any time, so that starting is met as well.
    while delay_s < LATEST_S and not folder.exists() and process.poll() is None:
        time.sleep(0.01)
    time.sleep(delay_s % LATEST_S)
    for number in WAYS[way]:
        process.send_signal(number)
        time.sleep(0.05 if len(WAYS[way]) > 1 else 0.0)
    _, messages = process.communicate(timeout=120)
    with seen.open("r+b") as file, mmap.mmap(file.fileno(), 8) as shared:
        reached_s = 1e-9 * struct.unpack_from("<q", shared)[0]
    if "Traceback" in messages or "fault of treadwell" in messages:
        return f"BROKEN: {_end(messages)}", 0.0
    left, lost = left_of(folder, reached_s)
    told_to = way != "kill -9" and process.returncode in (130, 0, 1)
    if left == "cut off" and told_to:
        return "BROKEN: it was told to end and left no result", lost
    return left, lost


@contextmanager
def small_disk(place: Path, size: int) -> "Iterator[Path | None]":
    """Give a folder on a file system of its own; None where none may be made."""
    disk = place / "disk"
    disk.mkdir()
    made = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={size}", "none", str(disk)],
        capture_output=True,
        check=False,
    )
    if made.returncode:
        yield None
        return
    try:
        yield disk
    finally:
        subprocess.run(["umount", "-l", str(disk)], check=True)


def filled(size: int, place: Path, seconds: float, *, disk: bool) -> str:
    """Run where there is room for so many bytes, and return what is left of the run."""
    seen = place / "seen"
    seen.write_bytes(bytes(8))
    if not disk:
        return _filled(place / "run", seconds, seen, size)
    with small_disk(place, size) as there:
        if there is None:
            return _filled(place / "run", seconds, seen, size)
        return _filled(there / "run", seconds, seen, None)


def _filled(folder: Path, seconds: float, seen: Path, limit: int | None) -> str:
    process = started(folder, seconds, seen, limit)
    _, messages = process.communicate(timeout=300)
    errors = [line for line in messages.splitlines() if line.startswith("error: ")]
    if "Traceback" in messages or "fault of treadwell" in messages:
        return f"BROKEN: {_end(messages)}"
    if process.returncode == 3 and len(errors) != 1:
        return f"BROKEN: {len(errors)} errors are told"
    if process.returncode not in (0, 1, 3):
        return f"BROKEN: status {process.returncode}"
    return left_of(folder, 0.0)[0]


def _end(messages: str) -> str:
    """Return the last lines that a run said."""
    return " | ".join(messages.splitlines()[-12:])


def main() -> None:
    """Run them and say what was left."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--ends", type=int, default=0, metavar="N", help="runs that are ended")
    parser.add_argument("--disks", type=int, default=0, metavar="N", help="runs whose disk fills")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=60.0, help="simulated, at most")
    add_options(parser)
    options = parser.parse_args()
    draw = random.Random(options.seed)
    rows: list[dict[str, Any]] = []
    broken: list[str] = []
    losses: list[float] = []
    counts: Counter[tuple[str, str]] = Counter()
    for number in range(options.ends):
        way = list(WAYS)[number % len(WAYS)]
        with tempfile.TemporaryDirectory() as place:
            delay_s = draw.uniform(0.0, 2 * LATEST_S)
            left, lost = ended(way, delay_s, Path(place), options.seconds)
        losses.append(lost)
        _note(broken, way, left)
        counts[way, left.partition(":")[0]] += 1
        _progress("ended", number, options.ends, broken)
    for way in WAYS if options.ends else ():
        told = ", ".join(f"{n} {left}" for (w, left), n in sorted(counts.items()) if w == way)
        rows.append({"what": f"{way}: what is left", "measured": told})
    if losses:
        worst = {"what": "recording lost, worst", "measured": f"{max(losses):.2f} s"}
        rows.append(worst | {"wanted": "0.5 s"})
    left_by_disks: Counter[str] = Counter()
    for number in range(options.disks):
        size = round(draw.uniform(1e3, LARGEST_DISK))
        with tempfile.TemporaryDirectory() as place:
            left = filled(size, Path(place), options.seconds, disk=number % 2 == 0)
        _note(broken, f"{size} bytes", left)
        left_by_disks[left.partition(":")[0]] += 1
        _progress("filled", number, options.disks, broken)
    if options.disks:
        told = ", ".join(f"{count} {left}" for left, count in sorted(left_by_disks.items()))
        rows.append({"what": "disk full: what is left", "measured": told})
    for row in rows:
        sys.stdout.write(f"{row['what']}: {row['measured']}\n")
    write(options, "Runs that are ended, and disks that fill", None, rows)
    sys.exit(bool(broken))


def _note(broken: list[str], how: str, left: str) -> None:
    """Keep what is broken, and say so at once."""
    if left.startswith("BROKEN"):
        broken.append(f"{how}: {left}")
        sys.stderr.write(broken[-1] + "\n")


def _progress(what: str, number: int, of: int, broken: list[str]) -> None:
    if (number + 1) % 10 == 0 or number + 1 == of:
        sys.stderr.write(f"{what} {number + 1} of {of}, {len(broken)} broken\n")


if __name__ == "__main__":
    main()
