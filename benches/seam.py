"""What the way into Python and back costs: `python benches/seam.py [--seconds S] [--json]`.

Each slot in turn gets a component in Python that does next to nothing, on one course. What the
core's stage takes beyond the time that the component itself takes is the seam: products copied
and wrapped, the call with its time limit, and the answer read and checked.
"""

import argparse
import json
from collections.abc import Callable
from time import perf_counter
from typing import Any

import numpy as np
from into_results import add_options, write

import treadwell
from treadwell._core import Pilot
from treadwell.protocols import Decision, JointTargets, Plan, Segmentation

STAGE = {
    "planner": "plan",
    "behaviour": "behave",
    "localizer": "localize",
    "segmenter": "segment",
    "world_model": "map",
    "walker": "walk",
}


class Timed:
    """Counts the seconds that a component's own methods take."""

    def __init__(self) -> None:
        self.spent = 0.0

    def time(self, begin: float, answer: object) -> Any:  # noqa: ANN401
        self.spent += perf_counter() - begin
        return answer


class Ready(Timed):
    def plan(self, _view: object, _stairs: object, start: Any, goal: Any) -> Plan:  # noqa: ANN401
        begin = perf_counter()
        path = np.linspace(start[:2], goal.position, 60)
        return self.time(begin, Plan(path, replanned=False))


class Idle(Timed):
    def next(self, _situation: object) -> Decision:
        return self.time(perf_counter(), Decision("idle"))


class Still(Timed):
    def correct(self, *_: object) -> None:
        pass

    def estimate(self, _body: object) -> tuple[float, float, float, float]:
        return (0.0, 0.0, 0.0, 0.0)


class Ground(Timed):
    def segment(self, scan: Any) -> Segmentation:  # noqa: ANN401
        begin = perf_counter()
        labels = np.isfinite(scan.disparity).ravel().astype(np.uint16)
        pose = scan.robot_from_camera
        return self.time(begin, Segmentation(labels, [0.0], pose, ground=0, reliable=True))


class Meadow(Timed):
    origin, cell = (-2.0, -2.0), 0.04
    kind = np.ones((100, 100), np.uint8)
    height = np.zeros((100, 100), np.float32)

    def insert(self, *_: object) -> bool:
        return True

    def view(self) -> "Meadow":
        return self


class Statue(Timed):
    def step(self, _command: object, felt: Any) -> JointTargets:  # noqa: ANN401
        begin = perf_counter()
        return self.time(begin, JointTargets.at(felt.stand))


PARTS: dict[str, Callable[[], Timed]] = {
    "planner": Ready,
    "behaviour": Idle,
    "localizer": Still,
    "segmenter": Ground,
    "world_model": Meadow,
    "walker": Statue,
}


def seam_ms(slot: str, seconds: float) -> dict[str, Any]:
    """Milliseconds of the seam at the ticks at which the component is called."""
    part = PARTS[slot]()
    given: dict[str, Any] = {slot: part}
    episode = treadwell.Episode("slalom", overrides=(f"time_limit={seconds}",), **given)
    index = Pilot.stages.index(STAGE[slot])
    costs, ticks = [], 0
    while episode.verdict is None:
        before = part.spent
        episode.tick()
        ticks += 1
        stage = episode.pilot.timing[index]
        if np.isfinite(stage):
            costs.append(1e3 * (stage - (part.spent - before)))
    return {
        "slot": slot,
        "ticks": ticks,
        "called": len(costs),
        "median": round(float(np.median(costs)), 4),
        "p99": round(float(np.percentile(costs, 99)), 4),
        "a_tick": round(float(np.sum(costs)) / ticks, 4),
    }


def results_row(row: dict[str, Any]) -> dict[str, Any]:
    """The row of a slot in docs/results."""
    measured = {
        "a tick, mean": f"{row['a_tick']:.3f} ms",
        "a call, median": f"{row['median']:.3f} ms",
        "a call, 99 of 100": f"{row['p99']:.3f} ms",
    }
    return {"what": row["slot"], "measured": measured}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=20.0, help="simulated, for each slot")
    parser.add_argument("--json", action="store_true")
    add_options(parser)
    asked = parser.parse_args()
    rows = [seam_ms(slot, asked.seconds) for slot in PARTS]
    write(asked, "What a part in Python costs", None, [results_row(row) for row in rows])
    if asked.json:
        print(json.dumps({"unit": "ms", "seam": rows}))
        return
    print(f"{'slot':12} {'ticks':>6} {'called':>6} {'median':>8} {'p99':>8} {'a tick':>8}  (ms)")
    for row in rows:
        figures = f"{row['median']:8.4f} {row['p99']:8.4f} {row['a_tick']:8.4f}"
        print(f"{row['slot']:12} {row['ticks']:6} {row['called']:6} {figures}")


if __name__ == "__main__":
    main()
