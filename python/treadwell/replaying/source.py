"""What a replay is made from: a run's log, and the settings that are to be others."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

from treadwell._core import Octree
from treadwell.careful_json import json_of
from treadwell.core_settings import MAPPED, CoreInput, navigation_settings, told_map
from treadwell.errors import InputError
from treadwell.recording import observation_log as log
from treadwell.recording.log_file import Front, read_front
from treadwell.scenario.messages import describe, report
from treadwell.scenario.model import Scenario
from treadwell.scenario.overrides import (
    Overrides,
    assign,
    mentioned,
    read_overrides,
    split_key,
)

_OBSERVED: Final = (
    "a replay changes navigation.* alone: what the robot did and sensed is recorded as it was"
)


@dataclass(frozen=True, slots=True, eq=False)
class Source:
    """A log that can be replayed.

    Attributes:
        path: the file.
        header: what its metadata says.
        scenario: as the replay runs it.
        core: what the core is made of.
        changed: whether anything in the core is another than it was.
    """

    path: Path
    header: Mapping[str, str]
    scenario: Scenario
    core: CoreInput
    changed: bool

    @property
    def joints(self) -> list[str]:
        """Names of the joints in joint order."""
        return self.header.get("joints", "").split(",")


def open_source(run_dir: Path, overrides: Overrides = (), brought: Sequence[str] = ()) -> Source:
    """Read what a run was, and change what is asked for.

    Args:
        run_dir: the run's folder.
        overrides: settings of `navigation`: `KEY=VALUE`, or a mapping of keys to values.
        brought: slots for which the caller has an object of its own.

    Raises:
        InputError: the log is missing, no recording, or cannot be replayed; a setting is bad.
    """
    path = run_dir / log.NAME
    if not path.is_file():
        raise InputError(
            f"{path}: there is no recording to replay; `treadwell run` keeps one by --record"
        )
    front = read_front(path)
    header = log.header_of(front, path)
    configuration = _table(front, log.CONFIGURATION, path)
    core = _table(front, log.CORE, path)
    recorded = _scenario(configuration, (), path)
    scenario = _scenario(configuration, overrides, path) if overrides else recorded
    given = {str(k): str(v) for k, v in _part(core, "given", path).items()}
    asked = {split_key(key)[-1] for key, _ in read_overrides(overrides)}
    _check_parts(scenario, given, asked, brought, path)
    settings = _part(core, "settings", path)
    of_robot = _part(core, "robot_navigation", path)
    if overrides:
        settings = settings | {"navigation": navigation_settings(scenario.navigation, of_robot)}
    static_map = _static_map(front, recorded, scenario, path)
    text = json.dumps(settings, allow_nan=False)
    made = CoreInput(text, of_robot, static_map, given)
    return Source(path, header, scenario, made, bool(overrides or brought))


def _scenario(configuration: dict[str, Any], overrides: Overrides, path: Path) -> Scenario:
    raw: dict[str, Any] = json.loads(json.dumps(configuration))
    lines, given = [], mentioned(overrides)
    for key, value in read_overrides(overrides):
        words = split_key(key)
        if words[0] != "navigation" or len(words) < 2:
            raise InputError(f"{given} {key}: {_OBSERVED}")
        try:
            assign(raw, key, value)
        except InputError as error:
            lines.append(f"{given} {error}")
    try:
        scenario = Scenario.model_validate(raw)
    except ValidationError as error:
        lines += [describe(detail, raw) for detail in error.errors(include_url=False)]
    except RecursionError:
        lines.append("nested too deep")
    else:
        if not lines:
            return scenario
    raise InputError(report(str(path), list(dict.fromkeys(lines))))


def _check_parts(
    scenario: Scenario,
    given: Mapping[str, str],
    asked: set[str],
    brought: Sequence[str],
    path: Path,
) -> None:
    """Refuse what a recording cannot bring back."""
    for slot, name in given.items():
        if slot not in asked and slot not in brought:
            raise InputError(
                f"{path}: the run's {slot} was an object of {name}, which no recording holds; "
                f"give one to treadwell.replay({slot}=...), or --set navigation.{slot}=NAME"
            )
    if scenario.navigation.localizer == "truth" and "localizer" not in brought:
        raise InputError(
            f"{path}: navigation.localizer: found 'truth', which reads the simulator, and there "
            "is none in a replay; --set navigation.localizer=odometry, for example"
        )


def _static_map(front: Front, recorded: Scenario, scenario: Scenario, path: Path) -> Octree | None:
    """Return the map that the core is told: the recorded one, or one of the recorded course."""
    if not MAPPED & set(scenario.navigation.slots().values()):
        return None
    told, key = front.attachments.get(log.STATIC_MAP), "static_map"
    same = recorded.navigation.parameters().get(key) == scenario.navigation.parameters().get(key)
    if told is not None and same:
        return log.read_octree(told, f"{path}: {log.STATIC_MAP}")
    # MuJoCo knows what the course's solids are; nothing of it is stepped.
    from treadwell.course.build import build_course
    from treadwell.robot.load import load_robot

    robot = load_robot(scenario.robot)
    return told_map(scenario, robot, build_course(scenario, robot))


def _table(front: Front, name: str, path: Path) -> dict[str, Any]:
    if name not in front.attachments:
        raise InputError(
            f"{path}: has no {name}, without which it cannot be replayed; it was written by an "
            "older treadwell, or by other software"
        )
    table = json_of(front.attachments[name], f"{path}: {name}: is broken")
    if not isinstance(table, dict):
        raise InputError(f"{path}: {name}: is broken: must be a table")
    return table


def _part(table: dict[str, Any], key: str, path: Path) -> dict[str, Any]:
    part = table.get(key)
    if not isinstance(part, dict):
        raise InputError(f"{path}: {log.CORE}: {key}: is missing or no table")
    return part
