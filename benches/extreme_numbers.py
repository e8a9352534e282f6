"""Gives every number that a user may write its extremes, one at a time, and runs half a second.

    python benches/extreme_numbers.py robot settings scenario

Each must be refused as bad input, or run to an outcome that is no error; what crashes, hangs or
takes more than a gigabyte is a fault. Every case runs in a process of its own.
"""

import argparse
import json
import shutil
import sys
import tempfile
import tomllib
from collections import Counter
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import tomli_w
from apart import apart
from into_results import add_options, write
from pydantic import BaseModel

from treadwell import _core
from treadwell.data import data_folder
from treadwell.episode import Episode
from treadwell.errors import InputError
from treadwell.robot.reading import read_robot_file
from treadwell.runner import play_episode
from treadwell.scenario.loading import load_scenario

EXTREMES = (5e-324, 1e-300, 1e-9, 0.001, 10.0, 1e4, 1e9, 1e308, -1e308, -0.0)
LONGEST_SECONDS = 20
USED = {
    "averaging": "world_model=averaging",
    "octree": "world_model=octree",
    "static_map": "localizer=monte_carlo",
    "monte_carlo": "localizer=monte_carlo",
    "scan_match": "localizer=scan_match",
    "scan_line_1994": "segmenter=scan_line_1994",
    "scan_line_adaptive": "segmenter=scan_line_adaptive",
    "hough": "segmenter=hough",
    "ransac": "segmenter=ransac",
    "histogram": "segmenter=histogram",
    "walking": "behaviour=walking",
    "continuous": "behaviour=continuous",
}
"""What chooses the component that has a table."""
EVENTS = """
[[event]]
do = "push"
at = 0.1
impulse = [0.1, 0.1, 0.1]
[[event]]
do = "knock"
at = 0.1
roll = 0.01
pitch = 0.01
yaw = 0.01
[[event]]
do = "blind"
at = 0.2
duration = 0.1
[[event]]
do = "friction"
at = 0.1
value = 0.5
[[event]]
do = "kidnap"
at = 0.3
position = [0.0, 0.0]
yaw = 0.1
[[event]]
do = "fault"
part = "depth"
kind = "scale"
at = 0.2
value = 1.1
[[event]]
do = "move"
name = "box"
near = [0.0, 0.0]
within = 1.0
to = [1.0, 1.0]
speed = 0.3
"""
SENSORS = """
[sensors]
latency = 0.1
camera_roll_pitch_error = 0.1
camera_position_error = 0.01
mismatch_rate = 0.01
[physics]
mass_scale = 1.1
[expect]
max_time = 100.0
max_translation_error = 1.0
max_height_error = 0.1
"""


def numbers(value: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:  # noqa: ANN401
    """Return where numbers stand in plain data."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from numbers(item, (*path, key))
    elif isinstance(value, list | tuple):
        for index, item in enumerate(value):
            yield from numbers(item, (*path, index))
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield path


def put(document: Any, path: tuple[str | int, ...], number: float) -> Any:  # noqa: ANN401
    """Return a copy of plain data with another number at a place: whole where it was whole."""
    copied = json.loads(json.dumps(document))
    place = copied
    for key in path[:-1]:
        place = place[key]
    whole = isinstance(place[path[-1]], int) and abs(number) >= 1.0
    place[path[-1]] = max(-(2**62), min(2**62, int(number))) if whole else number
    return copied


def robots() -> Iterator[tuple[str, dict[str, Any], Path]]:
    """Return the robots' files with every number that they can have, and their folders."""
    for folder in sorted(data_folder("models").iterdir()):
        if (folder / "robot.toml").is_file():
            table = tomllib.loads((folder / "robot.toml").read_text(encoding="utf-8"))
            read = read_robot_file(folder / "robot.toml")
            yield folder.name, _filled(table, read), folder


def _filled(table: dict[str, Any], read: BaseModel) -> dict[str, Any]:
    """Add the numbers that have a default."""
    for name in type(read).model_fields:
        value = getattr(read, name)
        if isinstance(value, BaseModel) and name in table:
            _filled(table[name], value)
        elif name not in table and isinstance(value, float | int):
            table[name] = value
        elif name in table and isinstance(value, dict) and name == "motors":
            for kind, motors in value.items():
                table[name][kind].update(damping=0.01, friction=0.01, armature=0.001)
                _filled(table[name][kind], motors)
    return table


Case = tuple[str, str, tuple[str, ...], Path | None]
"""What it is called; scenario, overrides and the robot's folder."""


def robot_cases(folder: Path) -> Iterator[Case]:
    """Write a robot's folder for each number and extreme."""
    for name, table, of_robot in robots():
        for path in numbers(table):
            for number in EXTREMES:
                made = _robot(folder, of_robot, put(table, path, number))
                yield f"robot {name} {'.'.join(map(str, path))} = {number}", "slalom", (), made


def _robot(folder: Path, of_robot: Path, table: dict[str, Any]) -> Path:
    """Write a copy of a robot's folder with another `robot.toml`."""
    made = folder / "robot" / of_robot.name
    shutil.rmtree(made.parent, ignore_errors=True)
    shutil.copytree(of_robot, made)
    (made / "robot.toml").write_text(tomli_w.dumps(table), encoding="utf-8")
    return made


def settings_cases(folder: Path) -> Iterator[Case]:
    """Set each parameter of the core."""
    for table in json.loads(_core.parameters()):
        for parameter in table["parameters"]:
            key, default = parameter["key"], parameter["default"]
            if isinstance(default, str | bool):
                continue
            short = key.removeprefix("navigation.").partition(".")[0]
            chosen = USED.get(short)
            use = () if chosen is None else (f"navigation.{chosen}",)
            scenario = "stairs_up" if short.startswith("stair") else "slalom"
            for number in EXTREMES:
                value: Any = number
                if isinstance(default, list):
                    value = [number, *default[1:]]
                elif parameter["schema"].get("type") == "integer" and abs(number) >= 1.0:
                    value = max(-(2**62), min(2**62, int(number)))
                if key.startswith("navigation."):
                    yield f"{key} = {value}", scenario, (*use, f"{key}={value}"), None
                else:
                    yield f"{key} = {value}", scenario, (), _with(folder, key, value)


def _with(folder: Path, key: str, value: object) -> Path:
    """Write a robot's folder with another setting."""
    of_robot = data_folder("models") / ("nao" if "structured_light" in key else "qrio")
    table = tomllib.loads((of_robot / "robot.toml").read_text(encoding="utf-8"))
    *tables, last = key.split(".")
    place = table
    for word in tables:
        place = place.setdefault(word, {})
    place[last] = value
    return _robot(folder, of_robot, table)


def scenario_cases(folder: Path) -> Iterator[Case]:
    """Write a scenario for each number and extreme."""
    for name in ("slalom", "stairs_up", "random_house", "random_yard", "doorway", "visitor"):
        path = data_folder("scenarios") / f"{name}.toml"
        table = tomllib.loads(path.read_text(encoding="utf-8"))
        draws = table.pop("vary", {})
        more = tomllib.loads(EVENTS + SENSORS)
        if name == "slalom":
            table["event"] = more.pop("event")
            table["course"].append({"kind": "box", "name": "box", "base": 0.1})
            table["course"].append({"kind": "stairs", "rise": [0.03] * 2, "tread": [0.1] * 2,
                                    "steps": 2, "turn": 0.1, "position": [3.0, 3.0]})  # fmt: skip
            table["course"].append({"kind": "rubble", "amplitude": 0.02, "size": [0.3, 0.3],
                                    "position": [-3.0, 3.0]})  # fmt: skip
            table |= {"vary": draws} | more
        made = folder / f"{name}.toml"
        for place in numbers(table):
            for number in EXTREMES:
                made.write_text(tomli_w.dumps(put(table, place, number)), encoding="utf-8")
                called = f"scenario {name} {'.'.join(map(str, place))} = {number}"
                yield called, str(made), (), None


CASES = {"robot": robot_cases, "settings": settings_cases, "scenario": scenario_cases}


def ran(case: Case, seconds: float) -> str:
    """Run a case here."""
    _, scenario, overrides, robot = case
    limit = (f"time_limit={seconds}",)
    try:
        own = () if Path(scenario).is_file() and "time_limit =" in case[0] else limit
        made = load_scenario(scenario, robot=str(robot or "") or None, overrides=own + overrides)
        if made.time_limit > seconds:
            return "ran"
        result = play_episode(Episode(made))
    except InputError as error:
        return f"refused {error}"
    except BaseException as error:
        return f"FAULT {type(error).__name__}: {error}"[:300]
    return f"FAULT {result.reason}"[:300] if result.outcome == "error" else "ran"


def main() -> int:
    """Run, and return 1 where there was a fault."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kinds", nargs="+", choices=CASES)
    parser.add_argument("--seconds", type=float, default=0.5)
    parser.add_argument("--every", type=int, default=1, help="leave out all but each so-manieth")
    parser.add_argument("--only", default="", help="cases that have this in their name")
    parser.add_argument("--show", action="store_true", help="print what came of each")
    add_options(parser)
    options = parser.parse_args()
    found: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        cases = (case for kind in options.kinds for case in CASES[kind](Path(folder)))
        for number, case in enumerate(cases):
            if number % options.every or options.only not in case[0]:
                continue
            came = apart(partial(ran, case, options.seconds), LONGEST_SECONDS)
            found[came.partition(" ")[0]] += 1
            if came.startswith("FAULT") or options.show:
                print(f"{case[0]}: {came}", flush=True)
            if number % 500 == 0:
                print(f"{case[0]}: {dict(found)}", file=sys.stderr, flush=True)
    print(dict(found))
    wrong = f"{found['FAULT']} in {found.total():,}"
    write(options, "Extreme numbers", [0], [{"what": "neither refused nor run", "measured": wrong}])
    return 1 if found["FAULT"] else 0


if __name__ == "__main__":
    sys.exit(main())
