"""One long episode: by how much does the memory of its process grow from the first minute on?

    python benches/memory.py --minutes 60
    python benches/memory.py --minutes 10 --no-record

The robot goes to and fro on an open floor with all that a run does; its folder is temporary. Prints
the resident memory after each simulated minute, and by how much it grew from the first to the last;
ends with 1 where that is more than is allowed.
"""

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path

from into_results import add_options, write
from soak import resident_mb

from treadwell.errors import InputError
from treadwell.runner import run

PLACES = ((3.5, 0.0), (0.0, 0.0))
LEGS = 100
"""As many as a scenario may have; each takes more than half a minute."""


class Looks:
    """Notes the resident memory at each simulated minute, as the run's progress."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self.resident_mb: list[float] = []

    def update(self, simulated: float, *_: object) -> None:
        """Take in simulated seconds."""
        if simulated >= 60.0 * (len(self.resident_mb) + 1):
            self.note(len(self.resident_mb) + 1.0)

    def note(self, minute: float) -> None:
        """Look at the memory and print it."""
        self.resident_mb.append(resident_mb())
        row = {"minute": round(minute, 2), "resident_mb": round(self.resident_mb[-1], 1)}
        print(json.dumps(row), flush=True)


def main() -> int:
    """Run the episode; 1 where memory grew by more than is allowed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--minutes", type=float, default=60.0, help="of simulated time")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--no-record", action="store_true", help="leave recordings out")
    parser.add_argument("--allowed", type=float, default=50.0, help="growth, MB")
    add_options(parser)
    arguments = parser.parse_args()
    via = [list(PLACES[leg % len(PLACES)]) for leg in range(LEGS)]
    overrides = (f"goal.via={via}", f"time_limit={60.0 * arguments.minutes}")
    looks, begin, record = Looks(), time.perf_counter(), not arguments.no_record
    with tempfile.TemporaryDirectory() as folder:
        done = run(
            "open_floor",
            seed=arguments.seed,
            overrides=overrides,
            record=record,
            out=Path(folder) / "run",
            progress=looks,
        )
    minutes = done.result.simulated_seconds / 60.0
    if done.outcome != "timed_out":
        raise InputError(f"the robot was to walk on: {done.result.reason} after {minutes:.1f} min")
    first_mb = looks.resident_mb[0] if looks.resident_mb else resident_mb()
    last_mb = looks.resident_mb[-1] if looks.resident_mb else first_mb
    looks.note(minutes)
    grown_mb = last_mb - first_mb
    wall_s = round(time.perf_counter() - begin)
    print(json.dumps({"grown_mb": round(grown_mb, 2), "wall_s": wall_s}))
    kept = "with" if record else "without"
    what = f"resident memory at minute 1 / {minutes:.0f}, {kept} recording"
    row = {"what": what, "measured": f"{first_mb:.1f} / {last_mb:.1f} MB"}
    title = f"Memory over one episode of {minutes:g} minutes"
    write(arguments, title, [arguments.seed], [row])
    return int(grown_mb > arguments.allowed)


if __name__ == "__main__":
    sys.exit(main())
