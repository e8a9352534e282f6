"""Changes good files at random, and hands them to what reads files of strangers.

    python benches/fuzz_files.py --count 100000

Each must be taken, or refused by treadwell's own error within 5 s. What MuJoCo builds (meshes,
worlds) is built here without the child process that stands around it in the program: a crash or a
hang of it ends one worker, is counted as contained, and tried again in the child. The cases follow
from `--seed`; what is at fault is kept in `--keep`.
"""

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from into_results import add_options, write

from treadwell._core import Octree
from treadwell.data import data_folder
from treadwell.errors import InputError, TreadwellError
from treadwell.judging.result import read_result
from treadwell.mjcf.build import build_files
from treadwell.mjcf.xml import check_xml
from treadwell.recording.file import whole_length
from treadwell.recording.observation_log import read_answers, read_observations
from treadwell.recording.trajectory import read_trajectory
from treadwell.replaying.source import open_source
from treadwell.robot.reading import read_robot_file
from treadwell.scenario.loading import load_scenario

LONGEST_SECONDS = 5.0
BATCH = 500
WORDS = (
    b"nan", b"inf", b"-1", b"0", b"1e308", b"1e-308", b"99999999999999999999", b"\xff\xfe", b"\0",
    b"../", b"/etc/passwd", b"[", b"]", b"{", b"}", b'"', b"<", b">", b"/>", b"&lt;", b"=", b"\n",
    b"<include file='../x'/>", b"<replicate count='99999'>", b"true", b"'", b"<!--", b"]]>", b".",
)  # fmt: skip
WORLD = b"""<mujoco><asset><mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset><worldbody>
<geom name="a" type="box" size=".2 .3 .02" pos="1 0 .02"/><replicate count="3" offset="1 0 0">
<body pos="2 1 0"><geom type="cylinder" size=".1 .2"/></body></replicate>
<geom type="mesh" mesh="m"/>
</worldbody></mujoco>"""
OBJ = b"v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nv 0 0 0.2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def changed(content: bytes, random: np.random.Generator) -> bytes:
    """Return a content with one to four changes."""
    made = bytearray(content)
    for _ in range(int(random.integers(1, 5))):
        at = int(random.integers(0, len(made) + 1))
        end = min(len(made), at + int(random.geometric(0.05)))
        kind = int(random.integers(0, 7))
        if kind == 0 and at < len(made):
            made[at] ^= 1 << int(random.integers(0, 8))
        elif kind == 1:
            del made[at:end]
        elif kind == 2:
            made[at:at] = made[at:end] * int(random.integers(1, 50))
        elif kind == 3:
            made[at:end] = random.bytes(end - at)
        elif kind == 4:
            del made[at:]
        else:
            made[at:end] = WORDS[int(random.integers(0, len(WORDS)))]
    return bytes(made)


def _scenario(path: Path) -> None:
    load_scenario(path).configuration()


def _world(path: Path) -> None:
    check_xml(path, path.parent, "x")
    build_files(str(path), "x")


def _mesh(path: Path) -> None:
    build_files(str(path), "x")


def _log(path: Path) -> None:
    """Read a log; one that is taken for whole must say what the good one said."""
    shutil.copyfile(path, path.parent / "observations.mcap")
    open_source(path.parent)
    said = [(o.time_ns, o.joint_positions.tobytes()) for o in read_observations(path)]
    good = path.parent / "good.mcap"
    if said != [(o.time_ns, o.joint_positions.tobytes()) for o in read_observations(good)]:
        raise AssertionError("taken for whole, but says something else")
    if list(read_answers(path)) != list(read_answers(good)):
        raise AssertionError("taken for whole, but answers something else")


Reader = Callable[[Path], Any]
READERS: dict[str, tuple[str, Reader]] = {
    "scenario": ("x.toml", _scenario),
    "robot": ("robot.toml", read_robot_file),
    "world": ("x.xml", _world),
    "obj": ("x.obj", _mesh),
    "stl": ("x.stl", _mesh),
    "log": ("x.mcap", _log),
    "result": ("result.json", read_result),
    "trajectory": ("x.tum", read_trajectory),
    "recording": ("x.rrd", whole_length),
    "tree": ("x.ot", lambda path: Octree.read(str(path))),
    "binary tree": ("x.bt", lambda path: Octree.read(str(path))),
}


def seeds(folder: Path) -> None:
    """Write the good files."""
    import treadwell

    shipped = data_folder("scenarios")
    run = treadwell.run("slalom", overrides=("time_limit=0.3",), out=folder / "run").folder
    tree = Octree(0.1)
    tree.occupy(np.random.default_rng(0).uniform(-1, 1, (200, 3)))
    shutil.copyfile(shipped / "visitor.toml", folder / "x.toml")
    shutil.copyfile(data_folder("models") / "qrio" / "robot.toml", folder / "robot.toml")
    for name, there in (("x.mcap", "observations.mcap"), ("x.tum", "trajectory.tum")):
        shutil.copyfile(run / there, folder / name)
    shutil.copyfile(run / "result.json", folder / "result.json")
    (folder / "x.rrd").write_bytes((run / "recording.rrd").read_bytes()[:50_000])
    (folder / "x.xml").write_bytes(WORLD)
    (folder / "x.obj").write_bytes(OBJ)
    faces = np.random.default_rng(0).uniform(-1, 1, (20, 12)).astype("<f4")
    body = b"".join(face.tobytes() + b"\0\0" for face in faces)
    (folder / "x.stl").write_bytes(bytes(80) + (20).to_bytes(4, "little") + body)
    tree.write(str(folder / "x.ot"))
    tree.write(str(folder / "x.bt"))


def case(good: Path, here: Path, seed: int, number: int) -> tuple[str, Path]:
    """Write a case's file; return its kind and where it is."""
    random = np.random.default_rng([seed, number])
    kind = list(READERS)[number % len(READERS)]
    file = READERS[kind][0]
    path = here / file
    path.write_bytes(changed((good / file).read_bytes(), random))
    return kind, path


def tried(kind: str, path: Path) -> str:
    """Return what came of a case: taken, refused, or a sentence that begins with FAULT."""
    begin = time.process_time()
    try:
        READERS[kind][1](path)
        came = "taken"
    except TreadwellError:
        came = "refused"
    except Exception as error:
        came = f"FAULT {type(error).__name__}: {error}"[:300]
    spent = time.process_time() - begin
    return came if spent < LONGEST_SECONDS else f"FAULT took {spent:.1f} s"


def work(good: Path, seed: int, first: int, count: int) -> None:
    """Try some cases; write a line before each and after each."""
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        shutil.copyfile(good / "x.mcap", here / "good.mcap")
        for number in range(first, first + count):
            print(json.dumps([number]), flush=True)
            kind, path = case(good, here, seed, number)
            print(json.dumps([number, kind, tried(kind, path)]), flush=True)


def contained(good: Path, seed: int, number: int) -> str:
    """Try in the child process of the program what ended a worker."""
    from treadwell.limited import limited

    with tempfile.TemporaryDirectory() as folder:
        kind, path = case(good, Path(folder), seed, number)
        if READERS[kind][1] not in (_world, _mesh):
            return f"FAULT crashed or hung ({kind})"
        try:
            limited(build_files, [str(path), "x"], "x")
        except InputError:
            return "contained"
        return "FAULT crashed, and was taken in the child"


def batch(good: Path, seed: int, first: int, count: int) -> list[tuple[int, str, str]]:
    """Return number, kind and what came of each case."""
    done: list[tuple[int, str, str]] = []
    while len(done) < count:
        begin = first + len(done)
        command = [sys.executable, __file__, "--work", str(good), str(seed), str(begin)]
        command += [str(count - len(done))]
        try:
            out = subprocess.run(
                command, capture_output=True, timeout=60 + 0.3 * count, check=False
            ).stdout
        except subprocess.TimeoutExpired as error:
            out = error.stdout or b""
        lines = [json.loads(line) for line in out.splitlines() if line.startswith(b"[")]
        done += [(n[0], n[1], n[2]) for n in lines if len(n) == 3]
        if len(done) < count:
            number = first + len(done)
            kind = list(READERS)[number % len(READERS)]
            done.append((number, kind, contained(good, seed, number)))
    return done


def fuzz(count: int, seed: int, good: Path, keep: Path | None = None) -> Counter[tuple[str, str]]:
    """Try cases; return how often each kind came to what."""
    found: Counter[tuple[str, str]] = Counter()
    for first in range(0, count, BATCH):
        for number, kind, came in batch(good, seed, first, min(BATCH, count - first)):
            found[kind, came.partition(" ")[0]] += 1
            if came.startswith("FAULT"):
                print(f"case {number} ({kind}): {came}", flush=True)
                if keep is not None:
                    (keep / str(number)).mkdir(parents=True, exist_ok=True)
                    case(good, keep / str(number), seed, number)
        print(f"{min(first + BATCH, count)} of {count}", file=sys.stderr, flush=True)
    return found


def main() -> int:
    """Run, and return 1 where there was a fault."""
    if sys.argv[1:2] == ["--work"]:
        work(Path(sys.argv[2]), *map(int, sys.argv[3:6]))
        return 0
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path)
    add_options(parser)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        good = Path(folder)
        seeds(good)
        found = fuzz(options.count, options.seed, good, options.keep)
    for (kind, came), times in sorted(found.items()):
        print(f"{kind:12s} {came:10s} {times}")
    faults = sum(times for (_, came), times in found.items() if came == "FAULT")
    print(f"{options.count} files, {faults} faults")
    found_none = f"{faults} in {options.count:,}"
    rows = [{"what": "traceback, hang or false success", "measured": found_none}]
    write(options, "Hostile files, generated", [options.seed], rows)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
