"""The robot that is served, and a core for each client: of what its hello says, and of no truth."""

import json
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, Final

from pydantic import ValidationError

from treadwell._core import Octree
from treadwell.components import COMPONENTS
from treadwell.core_settings import MAPPED, build_core, guards, told_settings, user_components
from treadwell.errors import InputError
from treadwell.guard import GuardedCore
from treadwell.physics.simulation import TICK_NS
from treadwell.recording.observation_log import read_octree
from treadwell.robot.description import focal_length
from treadwell.robot.load import Robot, load_robot
from treadwell.scenario.messages import describe, report, shown
from treadwell.scenario.model import SCHEMA, Scenario
from treadwell.scenario.overrides import assign, parse_setting, split_key
from treadwell.scenario.scaling import to_robot
from treadwell.serving.framing import Message, ProtocolError
from treadwell.serving.protocol import (
    HELLO,
    STATIC_MAP,
    VERSION,
    Shapes,
    check_keys,
    kind_of,
)
from treadwell.version import __version__

TABLES: Final = ("goal", "start", "navigation")
"""Those of a scenario that a client's hello has, with the same keys and defaults."""


class ServedRobot:
    """A robot, and how its cores are made.

    Attributes:
        robot: its folder, loaded.
        shapes: of its arrays.
    """

    def __init__(self, robot: str, settings: Sequence[str] = ()) -> None:
        """Load the robot.

        Args:
            robot: a name of `treadwell list robots`, or the path of a folder.
            settings: `KEY=VALUE` each of `navigation`; they beat what a client says.

        Raises:
            InputError: there is no such robot, or a setting is none of `navigation`.
        """
        self.robot: Robot = load_robot(robot)
        camera = self.robot.file.camera
        self.shapes = Shapes(len(self.robot.joints), (camera.height, camera.width))
        self._settings = [parse_setting(setting) for setting in settings]
        for key, _ in self._settings:
            if split_key(key)[0] != "navigation" or len(split_key(key)) < 2:
                raise InputError(f"--set {key}: a server sets navigation.* alone")

    def slots(self) -> dict[str, str]:
        """Return slot -> the component that a client gets who asks for none.

        Raises:
            InputError: a setting cannot be.
        """
        return self._own.navigation.slots()

    def check(self) -> None:
        """Make a core, to see whether one can be made before a client asks.

        Raises:
            InputError: a setting cannot be.
        """
        if not MAPPED & set(self.slots().values()):
            self._build(self._own, None)

    @cached_property
    def _own(self) -> Scenario:
        return self.scenario({"goal": {}}, "settings")

    def hello(self) -> dict[str, Any]:
        """Return what a client is told of the robot: the header of the server's hello."""
        camera, limits = self.robot.file.camera, self.robot.limits
        focal = focal_length(self.robot.file)
        return {
            "type": HELLO,
            "protocol": VERSION,
            "treadwell": __version__,
            "robot": self.robot.name,
            "tick_ns": TICK_NS,
            "joints": list(self.robot.joints),
            "stand": self.robot.stand.tolist(),
            "kp": limits.kp.tolist(),
            "kv": limits.kv.tolist(),
            "peak_torque": limits.peak_torque.tolist(),
            "camera": {
                "width": camera.width,
                "height": camera.height,
                "fx": focal,
                "fy": focal,
                "cx": (camera.width - 1.0) / 2.0,
                "cy": (camera.height - 1.0) / 2.0,
                "period_ns": round(1e9 * camera.period),
            },
        }

    def core(self, hello: Message) -> GuardedCore:
        """Return a new core, by a client's hello.

        Raises:
            ProtocolError: the message is no hello of this version and for this robot.
            InputError: what it asks for cannot be.
        """
        kind, version = kind_of(hello), hello.header.get("protocol")
        if kind != HELLO:
            raise ProtocolError(f"the first message: found {shown(kind)}; must be {HELLO}")
        if type(version) is not int or version != VERSION:
            raise ProtocolError(
                f"{HELLO}: protocol: found {shown(version)}; this server speaks {VERSION}"
            )
        check_keys(hello, ("protocol", "robot", *TABLES), (STATIC_MAP,))
        robot = hello.header.get("robot", self.robot.name)
        if robot != self.robot.name:
            raise ProtocolError(
                f"{HELLO}: robot: found {shown(robot)}; this server is for {self.robot.name}"
            )
        _refuse_python(hello.header.get("navigation"))
        scenario = self.scenario({key: hello.header.get(key, {}) for key in TABLES}, HELLO)
        return self._build(scenario, _static_map(hello, scenario))

    def scenario(self, tables: Mapping[str, Any], where: str) -> Scenario:
        """Return the scenario that a client's tables mean, the server's settings over them.

        Args:
            tables: `TABLES`, as in a scenario's file.
            where: its name, with which an error begins.

        Raises:
            InputError: a key or a value cannot be, with a line for each.
        """
        raw: dict[str, Any] = {"schema": SCHEMA, "name": where, "start": {}, **tables}
        raw |= {"robot": self.robot.name}
        lines = []
        for key, value in self._settings:
            try:
                assign(raw, key, value)
            except InputError as error:
                lines.append(str(error))
        try:
            scenario = Scenario.model_validate(raw)
        except ValidationError as error:
            lines += [describe(detail, raw) for detail in error.errors(include_url=False)]
        except RecursionError:
            lines.append("nested too deep")
        else:
            if not lines:
                return scenario
        raise InputError(report(where, list(dict.fromkeys(lines))))

    def _build(self, scenario: Scenario, static_map: Octree | None) -> GuardedCore:
        scenario = to_robot(scenario, self.robot)
        if scenario.navigation.localizer == "truth":
            raise InputError(
                f"{scenario.name}: navigation.localizer: found 'truth', which reads the simulator, "
                "and there is none; odometry, for example"
            )
        given = user_components(scenario, {})
        guarded = guards(scenario, given, ())
        given.update(guarded)
        place = scenario.start
        start = {
            "position": list(place.position),
            "height": place.height or 0.0,
            "yaw": place.yaw,
        }
        settings = told_settings(scenario, self.robot, start, scenario.goal.height)
        return GuardedCore(build_core(scenario, settings, given, static_map), guarded)


def _refuse_python(navigation: object) -> None:
    """Refuse classes that a client names: only who started the server may name what it runs."""
    if not isinstance(navigation, dict):
        return
    for slot in COMPONENTS:
        name = navigation.get(slot)
        if isinstance(name, str) and ":" in name:
            raise ProtocolError(
                f"{HELLO}: navigation.{slot}: found {shown(json.dumps(name))}: a client names no "
                f"Python; `treadwell serve --set navigation.{slot}=...` does"
            )


def _static_map(hello: Message, scenario: Scenario) -> Octree | None:
    """Return the map that the client sent, where a component asks for one."""
    if "file" in scenario.navigation.parameters().get("static_map", {}):
        raise InputError(
            f"{scenario.name}: navigation.static_map.file: a server opens no map's file; the "
            f"client sends its bytes as the array {STATIC_MAP}"
        )
    asking = sorted(MAPPED & set(scenario.navigation.slots().values()))
    sent = hello.arrays.get(STATIC_MAP)
    if not asking:
        return None
    if sent is None:
        raise ProtocolError(
            f"{HELLO}: {STATIC_MAP}: is missing: {asking[0]} has to be told a map, the bytes of an "
            "OctoMap file (.ot) as an array of uint8"
        )
    if sent.dtype != "uint8" or sent.ndim != 1:
        raise ProtocolError(f"{HELLO}: {STATIC_MAP}: must be the bytes of a file: uint8 [n]")
    return read_octree(sent.tobytes(), f"{HELLO}: {STATIC_MAP}")
