"""Runs random scenarios that are valid, five simulated seconds each: none may end as our fault.

    python benches/random_scenarios.py --count 1000

A seed gives elements, events, senses, robot, components and settings within their bounds. What is
refused as bad input (a start inside an obstacle, a setting that does not fit another) is counted
and drawn anew. Every run is in a process of its own; an outcome `error`, a crash, a minute or a
gigabyte is a fault. `--keep` holds the scenarios at fault.
"""

import argparse
import json
import math
import sys
import tempfile
from collections import Counter
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from apart import FAULT, apart
from into_results import add_options, write

from treadwell import _core
from treadwell.components import COMPONENTS
from treadwell.episode import Episode
from treadwell.errors import InputError
from treadwell.runner import play_episode
from treadwell.scenario.faults import FAULTS
from treadwell.scenario.loading import load_scenario

LONGEST_SECONDS = 120
MOVABLE = ("stairs", "sill", "platform", "box", "cylinder", "wall", "ramp", "rubble", "patch")
DRAWN = ("door", "scatter", "house", "yard", "vegetation", "terrain")
JOINTS = frozenset(["left_knee_pitch", "right_hip_pitch", "left_ankle_roll"])
SIZE, RISE, YAW, ANGLE = (0.02, 2.0), (0.002, 0.3), (-6.3, 6.3), (-0.3, 0.3)
AREA = [[(-4.0, -0.7), (-4.0, -0.7)], [(1.0, 6.0), (0.7, 4.0)]]
EITHER = frozenset([False, True])
ELEMENTS: dict[str, dict[str, Any]] = {
    "stairs": {"steps": (1, 12), "width": SIZE, "landing": SIZE, "turn": (-0.8, 0.8), "yaw": YAW,
               "rise": RISE, "tread": SIZE, "descent": EITHER},
    "sill": {"rise": RISE, "depth": SIZE, "width": SIZE, "yaw": YAW},
    "platform": {"size": [SIZE, SIZE, RISE], "yaw": YAW},
    "box": {"size": [SIZE, SIZE, SIZE], "base": (-0.1, 1.0), "yaw": YAW},
    "cylinder": {"radius": SIZE, "height": SIZE},
    "wall": {"height": SIZE, "thickness": (0.001, 0.5)},
    "ramp": {"length": SIZE, "width": SIZE, "rise": RISE, "yaw": YAW},
    "rubble": {"size": [SIZE, SIZE], "amplitude": RISE, "yaw": YAW},
    "patch": {"size": [SIZE, SIZE], "friction": (0.0, 2.0), "shade": (0.0, 1.0), "yaw": YAW},
    "vegetation": {"size": [SIZE, SIZE], "height": RISE, "density": (1.0, 2000.0), "yaw": YAW},
    "terrain": {"size": [SIZE, SIZE, RISE], "wavelength": (0.05, 3.0), "yaw": YAW},
    "door": {"width": SIZE, "height": SIZE, "open": (0.0, 1.0), "yaw": YAW,
             "wall": [(0.0, 2.0), (0.0, 2.0), SIZE]},
    "scatter": {"area": AREA, "count": (1, 30), "size": [(0.02, 0.4), (0.02, 0.4)]},
    "house": {"area": AREA, "rooms": (2, 7), "closed": (0.0, 1.0)},
    "yard": {"area": AREA, "clutter": (0, 30)},
}  # fmt: skip
"""Kind -> what it is drawn from; a place is added."""
EVENTS: dict[str, dict[str, Any]] = {
    "push": {"impulse": [(-20.0, 20.0)] * 3},
    "kidnap": {"yaw": YAW},
    "blind": {"duration": (0.0, 5.0)},
    "friction": {"value": (0.0, 10.0)},
    "encoder_offset": {"joint": JOINTS, "value": ANGLE},
    "knock": {"roll": ANGLE, "pitch": ANGLE, "yaw": ANGLE},
    "move": {"speed": (0.001, 10.0)},
}
MAY_BE = {"latency": 2.0, "camera_roll_pitch_error": 0.5, "camera_position_error": 0.1,
          "mismatch_rate": 1.0}  # fmt: skip
SENSES = ("depth", "encoders", "imu", "feet")


class Drawing:
    """A scenario's parts, drawn from one generator."""

    def __init__(self, seed: int, try_: int) -> None:
        """Begin."""
        self.random = np.random.default_rng([seed, try_])

    def number(self, low: float, high: float) -> float:
        """Return a number between two, at times an end."""
        kind = self.random.random()
        if kind < 0.03:
            return low
        if kind < 0.06:
            return high
        if low > 0.0 and high / low > 100.0:
            return float(np.exp(self.random.uniform(math.log(low), math.log(high))))
        return float(self.random.uniform(low, high))

    def chance(self, share: float) -> bool:
        """Return true so often."""
        return bool(self.random.random() < share)

    def one(self, values: Any) -> Any:  # noqa: ANN401
        """Return one of some values."""
        return values[int(self.random.integers(len(values)))]

    def place(self) -> list[float]:
        """Return a point: near as a rule, at times far away."""
        far = 99.0 if self.chance(0.03) else 3.0
        return [self.number(-far, far), self.number(-far, far)]

    def drawn(self, of: Any) -> Any:  # noqa: ANN401
        """Return what is drawn from ends of numbers, words, or lists and tables of such."""
        if isinstance(of, dict):
            return {key: self.drawn(one) for key, one in of.items()}
        if isinstance(of, list):
            return [self.drawn(one) for one in of]
        if isinstance(of, frozenset):
            return self.one(sorted(of))
        low, high = of
        if isinstance(low, int):
            return int(self.random.integers(low, high + 1))
        return self.number(low, high)

    def element(self, kind: str) -> dict[str, Any]:
        """Return an element's table."""
        table = {"kind": kind, **self.drawn(ELEMENTS[kind])}
        if kind == "wall":
            table |= {"from": self.place(), "to": self.place()}
        elif "area" not in table:
            table["position"] = self.place()
        if kind == "stairs" and self.chance(0.5):
            table["rise"] = self.drawn([RISE] * table["steps"])
            table["tread"] = self.drawn([SIZE] * table["steps"])
        if kind == "scatter":
            table["size"] = sorted(table["size"])
        if self.chance(0.2):
            table |= {"texture": self.number(0.0, 1.0), "mapped": self.chance(0.5)}
        return table

    def trigger(self) -> dict[str, Any]:
        """Return when an event happens."""
        if self.chance(0.8):
            return {"at": self.number(0.0, 5.0)}
        return {"near": self.place(), "within": self.number(0.1, 5.0)}

    def event(self, names: list[str]) -> dict[str, Any]:
        """Return an event's table."""
        doings = ["add", "push", "kidnap", "blind", "friction", "encoder_offset", "knock", "fault"]
        kind = self.one(doings + (["move", "remove"] if names else []))
        table: dict[str, Any] = {"do": kind, **self.trigger(), **self.drawn(EVENTS.get(kind, {}))}
        if kind == "add":
            table["element"] = self.element(self.one(MOVABLE))
        elif kind in {"move", "remove"}:
            table["name"] = self.one(names)
        elif kind == "kidnap":
            table["position"] = self.place()
        elif kind == "fault":
            table |= self.fault()
        if kind == "move" and self.chance(0.5):
            table["to"] = self.place()
        elif kind == "move":
            ways = [self.place() for _ in range(int(self.random.integers(1, 6)))]
            table |= {"path": ways, "loop": self.chance(0.5), "gives_way": self.chance(0.5)}
        return table

    def fault(self) -> dict[str, Any]:
        """Return what breaks, and how."""
        part = self.one(list(FAULTS))
        kind = self.one(list(FAULTS[part]))
        needs = FAULTS[part][kind]
        other = {"joint": JOINTS, "foot": frozenset(["left", "right"]), "cell": (0, 3)}
        table = {"part": part, "kind": kind}
        table |= self.drawn({key: other[key] for key in needs.keys if key in other})
        if needs.value is not None:
            table["value"] = self.number(*needs.value)
        return table | ({"duration": self.number(0.0, 3.0)} if self.chance(0.5) else {})

    def navigation(self) -> dict[str, Any]:
        """Return components, and some settings of those that are used."""
        table: dict[str, Any] = {}
        for slot, names in COMPONENTS.items():
            if self.chance(0.5):
                table[slot] = self.one([name for name in names if name != "truth"])
        every = [one for group in PARAMETERS for one in group]
        for _ in range(int(self.random.integers(0, 6))):
            parameter = self.one(every)
            value = self.setting(parameter)
            if value is None:
                continue
            *tables, key = parameter["key"].removeprefix("navigation.").split(".")
            place = table
            for word in tables:
                place = place.setdefault(word, {})
            place[key] = value
        return table

    def setting(self, parameter: dict[str, Any]) -> Any:  # noqa: ANN401
        """Return a value of a setting within its bounds; None where it is left alone."""
        schema, default = parameter["schema"], parameter["default"]
        if "enum" in schema:
            return self.one(schema["enum"])
        if isinstance(default, bool):
            return self.chance(0.5)
        if not isinstance(default, int | float):
            return None
        low = float(schema.get("minimum", schema.get("exclusiveMinimum", -1e9)))
        high = float(schema.get("maximum", schema.get("exclusiveMaximum", 1e9)))
        if self.chance(0.7):  # not far from what it is
            near = [default / 3.0, default * 3.0] if default else [0.0, 1.0]
            low, high = max(low, min(near)), min(high, max(near))
        value = self.number(low, max(low, high))
        return round(value) if schema.get("type") == "integer" else value

    def scenario(self) -> dict[str, Any]:
        """Return a whole scenario's tables."""
        course = [self.element(self.one(MOVABLE + DRAWN)) for _ in range(self.random.integers(9))]
        names = []
        for number, element in enumerate(course):
            if element["kind"] in MOVABLE and self.chance(0.7):
                element["name"] = f"thing {number}".replace(" ", "_")
                names.append(element["name"])
        events = [self.event(names) for _ in range(self.random.integers(5))]
        added = [event for event in events if event["do"] == "add"]
        for number, event in enumerate(added):
            event["element"]["name"] = f"added_{number}"
        sensors = self.drawn(dict.fromkeys(SENSES, frozenset(["noisy", "ideal"])))
        for key, most in MAY_BE.items():
            if self.chance(0.2):
                sensors[key] = self.number(0.0, most)
        start = {"position": [self.number(-0.3, 0.3)] * 2, "yaw": self.number(*YAW)}
        goal = {"position": self.place(), "radius": self.number(0.05, 1.0)}
        goal["via"] = [self.place() for _ in range(self.random.integers(3))]
        odd = self.chance(0.3)
        return {
            "schema": 1,
            "name": "random",
            "robot": self.one(["qrio", "nao"]),
            "seed": int(self.random.integers(2**53)),
            "time_limit": 5.0,
            "start": start | {"known": self.chance(0.8)},
            "goal": goal,
            "course": course,
            "event": events,
            "physics": self.drawn(
                {"friction": (0.0, 10.0), "mass_scale": (0.2, 5.0)} if odd else {}
            ),
            "sensors": sensors,
            "navigation": self.navigation(),
        }


PARAMETERS = [
    [one for one in table["parameters"] if one["key"].startswith("navigation.")]
    for table in json.loads(_core.parameters())
]


def ran(path: Path) -> str:
    """Run a scenario here; return what came of it."""
    try:
        result = play_episode(Episode(load_scenario(path)))
    except InputError as error:
        return f"refused {error}"
    except BaseException as error:
        return f"{FAULT} {type(error).__name__}: {error}"[:500]
    return f"{FAULT} {result.reason}"[:500] if result.outcome == "error" else result.outcome


def main() -> int:
    """Run, and return 1 where there was a fault."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--show", action="store_true", help="print what came of each")
    add_options(parser)
    options = parser.parse_args()
    found: Counter[str] = Counter()
    seeds = range(options.first_seed, options.first_seed + options.count)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "random.toml"
        for seed in seeds:
            for try_ in range(100):
                text = tomli_w.dumps(Drawing(seed, try_).scenario())
                path.write_text(text, encoding="utf-8")
                came = apart(partial(ran, path), LONGEST_SECONDS)
                found[came.partition(" ")[0]] += 1
                if options.show or came.startswith(FAULT):
                    print(f"{seed} {try_}: {came}", flush=True)
                if came.startswith(FAULT) and options.keep is not None:
                    options.keep.mkdir(parents=True, exist_ok=True)
                    (options.keep / f"{seed}_{try_}.toml").write_text(text, encoding="utf-8")
                if not came.startswith("refused"):
                    break
            if seed % 20 == 0:
                print(f"seed {seed}: {dict(found)}", file=sys.stderr, flush=True)
    print(dict(found))
    wrong = f"{found[FAULT]} in {options.count:,}"
    rows = [
        {"what": "outcome `error`, crash, two minutes or a gigabyte", "measured": wrong},
        {"what": "refused as bad input, and drawn anew", "measured": f"{found['refused']:,}"},
    ]
    write(options, "Random scenarios, 5 simulated seconds each", list(seeds), rows)
    return 1 if found[FAULT] else 0


if __name__ == "__main__":
    sys.exit(main())
