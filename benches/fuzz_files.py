"""Changes good files at random, and hands them to what reads files of strangers.

    python benches/fuzz_files.py --count 200000
    python benches/fuzz_files.py --count 200000 --structure

Each must be taken, or refused by treadwell's own error within 5 s and 1 GB. Bytes are changed
wherever they stand; with `--structure` values, keys and types of TOML and JSON, and the records of
logs, inside of their chunks, too. What MuJoCo builds (meshes, worlds) is built here without the
child process that stands around it in the program: a crash or a hang of it ends one worker, is
counted as contained, and tried again in the child. The cases follow from `--seed`; what is at fault
is kept in `--keep`. `--only` takes some kinds of files, `model,wire` for example.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import fuzz_structure
import numpy as np
from fuzz_readers import BUILT, READERS, Reader, read_log, seeds, share
from into_results import add_options, write

from treadwell.errors import InputError, TreadwellError
from treadwell.mjcf.build import build_files

MOST_MEMORY = 1 << 30
LONGEST_SECONDS = 5.0
BATCH = 500
WORDS = (
    b"nan", b"inf", b"-1", b"0", b"1e308", b"1e-308", b"99999999999999999999", b"\xff\xfe", b"\0",
    b"../", b"/etc/passwd", b"[", b"]", b"{", b"}", b'"', b"<", b">", b"/>", b"&lt;", b"=", b"\n",
    b"<include file='../x'/>", b"<replicate count='99999'>", b"true", b"'", b"<!--", b"]]>", b".",
)  # fmt: skip


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


Change = Callable[[bytes, np.random.Generator], bytes]
Kinds = dict[str, tuple[str, Reader, Change]]
STRUCTURE: Kinds = {
    "scenario": (*READERS["scenario"], fuzz_structure.toml_of),
    "robot": (*READERS["robot"], fuzz_structure.toml_of),
    "suite": (*READERS["suite"], fuzz_structure.toml_of),
    "journal": (*READERS["journal"], fuzz_structure.json_of),
    "sweep.json": (*READERS["sweep.json"], fuzz_structure.json_of),
    "results.json": (*READERS["results.json"], fuzz_structure.json_of),
    "result": (*READERS["result"], fuzz_structure.json_of),
    "log": (READERS["log"][0], read_log, fuzz_structure.log_of),
    "camera table": (*READERS["camera table"], fuzz_structure.toml_of),
    "wire": (*READERS["wire"], fuzz_structure.hello_of),
    "model": (*READERS["model"], fuzz_structure.xml_of),
}
WAYS: dict[str, Kinds] = {
    "bytes": {kind: (*reader, changed) for kind, reader in READERS.items()},
    "structure": STRUCTURE,
}
"""How files are changed -> kind -> file, reader and what changes it."""
ONLY = "TREADWELL_FUZZ_ONLY"
"""The variable by which workers are told the kinds that `--only` names."""


def case(good: Path, here: Path, way: str, seed: int, number: int) -> tuple[str, Path]:
    """Write a case's file; return its kind and where it is."""
    random = np.random.default_rng([seed, number])
    kind = kind_of(way, number)
    file, _, change = WAYS[way][kind]
    path = here / file
    path.write_bytes(change((good / file).read_bytes(), random))
    return kind, path


def kind_of(way: str, number: int) -> str:
    """Return the kind of a case: they take turns."""
    named = [kind for kind in os.environ.get(ONLY, "").split(",") if kind]
    kinds = named or list(WAYS[way])
    return kinds[number % len(kinds)]


def tried(read: Reader, path: Path) -> str:
    """Return what came of a case: taken, refused, or a sentence that begins with FAULT."""
    begin = time.process_time()
    try:
        read(path)
        came = "taken"
    except TreadwellError:
        came = "refused"
    except Exception as error:
        came = f"FAULT {type(error).__name__}: {error}"[:300]
    spent = time.process_time() - begin
    return came if spent < LONGEST_SECONDS else f"FAULT took {spent:.1f} s"


def work(good: Path, way: str, seed: int, first: int, count: int) -> None:
    """Try some cases; write a line before each and after each."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    most = pages * resource.getpagesize() + MOST_MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (most, resource.getrlimit(resource.RLIMIT_AS)[1]))
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        share(good, here)
        for number in range(first, first + count):
            print(json.dumps([number]), flush=True)
            kind, path = case(good, here, way, seed, number)
            came = tried(WAYS[way][kind][1], path)
            print(json.dumps([number, kind, came]), flush=True)
            for place in ("run", "sweep"):
                if (here / place / path.name).is_file():
                    good_one = good / place / path.name
                    (here / place / path.name).write_bytes(good_one.read_bytes())


def contained(good: Path, way: str, seed: int, number: int) -> str:
    """Try in the child process of the program what ended a worker."""
    from treadwell.limited import limited

    with tempfile.TemporaryDirectory() as folder:
        kind, path = case(good, Path(folder), way, seed, number)
        if WAYS[way][kind][1] not in BUILT:
            return f"FAULT crashed or hung ({kind})"
        try:
            limited(build_files, [str(path), "x"], "x")
        except InputError:
            return "contained"
        return "FAULT crashed, and was taken in the child"


def batch(good: Path, way: str, seed: int, first: int, count: int) -> list[tuple[int, str, str]]:
    """Return number, kind and what came of each case."""
    done: list[tuple[int, str, str]] = []
    while len(done) < count:
        begin = first + len(done)
        command = [sys.executable, __file__, "--work", str(good), way, str(seed), str(begin)]
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
            came = contained(good, way, seed, number)
            done.append((number, kind_of(way, number), came))
    return done


def fuzz(
    count: int, seed: int, good: Path, keep: Path | None = None, way: str = "bytes"
) -> Counter[tuple[str, str]]:
    """Try cases; return how often each kind came to what."""
    found: Counter[tuple[str, str]] = Counter()
    for first in range(0, count, BATCH):
        for number, kind, came in batch(good, way, seed, first, min(BATCH, count - first)):
            found[kind, came.partition(" ")[0]] += 1
            if came.startswith("FAULT"):
                print(f"case {number} ({kind}): {came}", flush=True)
                if keep is not None:
                    (keep / str(number)).mkdir(parents=True, exist_ok=True)
                    case(good, keep / str(number), way, seed, number)
        print(f"{min(first + BATCH, count)} of {count}", file=sys.stderr, flush=True)
    return found


def main() -> int:
    """Run, and return 1 where there was a fault."""
    if sys.argv[1:2] == ["--work"]:
        work(Path(sys.argv[2]), sys.argv[3], *map(int, sys.argv[4:7]))
        return 0
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--structure", action="store_true", help="change files by their structure")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path, help="where files at fault are kept")
    parser.add_argument("--only", default="", metavar="KIND,KIND", help="files of these kinds")
    add_options(parser)
    options = parser.parse_args()
    way = "structure" if options.structure else "bytes"
    if unknown := {kind for kind in options.only.split(",") if kind} - set(WAYS[way]):
        parser.error(f"--only {', '.join(unknown)}: there are {', '.join(WAYS[way])}")
    os.environ[ONLY] = options.only
    with tempfile.TemporaryDirectory() as folder:
        good = Path(folder)
        seeds(good)
        found = fuzz(options.count, options.seed, good, options.keep, way)
    rows = []
    for kind in dict.fromkeys(kind for kind, _ in found):
        came = {what: times for (one, what), times in found.items() if one == kind}
        print(f"{kind:12s} {came}")
        wrong = f"{came.get('FAULT', 0)} in {sum(came.values()):,}"
        rows.append({"what": f"{kind}: traceback, hang, a gigabyte, false success",
                     "measured": wrong})  # fmt: skip
    faults = sum(times for (_, what), times in found.items() if what == "FAULT")
    print(f"{options.count} files, {faults} faults")
    title = "Hostile files, generated" + (" by their structure" if options.structure else "")
    write(options, title, [options.seed], rows)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
