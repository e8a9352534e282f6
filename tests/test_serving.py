"""The core over a socket: the same answers as in a run, and one message for whatever is wrong."""

import socket
import struct
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from run_folders import recorded_run
from serving_builders import GOAL, HELLO, Running, answers, observation, running, told

from treadwell._core import Octree
from treadwell.errors import InputError
from treadwell.physics.simulation import TICK_NS
from treadwell.recording.observation_log import read_observations
from treadwell.serving.client import Client
from treadwell.serving.connection import Connection, connected
from treadwell.serving.framing import Message, ProtocolError, pack
from treadwell.serving.protocol import Targets
from treadwell.serving.served import ServedRobot
from treadwell.serving.server import Attended


@pytest.fixture(scope="module")
def served() -> ServedRobot:
    return ServedRobot("qrio")


@pytest.fixture(scope="module")
def here(served: ServedRobot, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    with running(served, tmp_path_factory.mktemp("s") / "core.sock") as found:
        yield found


def test_what_a_client_is_told_of_the_robot(here: Running, served: ServedRobot) -> None:
    with Client(here.address, goal=GOAL) as core:
        robot = core.robot
    assert (robot["protocol"], robot["tick_ns"]) == (1, TICK_NS)
    assert robot["joints"] == list(served.robot.joints)
    description = served.robot.description()
    camera = description["camera"]
    assert robot["camera"] == {
        "width": camera["width"],
        "height": camera["height"],
        "fx": camera["focal"],
        "fy": camera["focal"],
        "cx": (camera["width"] - 1) / 2,
        "cy": (camera["height"] - 1) / 2,
        "period_ns": 80_000_000,
    }
    assert robot["kp"] == [link["joint"]["kp"] for link in description["links"] if link["joint"]]
    assert robot["stand"] == description["stand"]


def test_a_core_is_each_clients_own_and_begins_anew(here: Running, served: ServedRobot) -> None:
    def walk() -> list[Targets]:
        with Client(here.address, goal=GOAL, start={"position": [0.5, 0.2], "yaw": 1.0}) as core:
            return [core.tick(observation(served, i)) for i in range(5)]

    first, second = walk(), walk()
    for a, b in zip(first, second, strict=True):
        assert a.position.tobytes() == b.position.tobytes()
        assert (a.estimate, a.state, a.outcome) == (b.estimate, b.state, b.outcome)
    assert first[0].estimate == pytest.approx((0.5, 0.2, 0.0, 1.0))
    assert first[3].time_ns == 3 * TICK_NS


FIRST: list[tuple[bytes, str]] = [
    (b"GET / HTTP/1.1\r\n\r\n", "a message begins with the length of its header"),
    (struct.pack("<Q", 10**10) + b"x" * 100, "a header of 10000000000 bytes"),
    (struct.pack("<Q", 5) + b"hello", "not JSON"),
    (pack({}), "type: found None; must be a message's type"),
    (pack({"type": "goodbye"}), 'the first message: found "goodbye"; must be hello'),
    (pack({"type": "hello"}), "protocol: found None; this server speaks 1"),
    (pack({"type": "hello", "protocol": 2, "new": 1}), "protocol: found 2; this server speaks 1"),
    (pack({"type": "hello", "protocol": True}), "protocol: found true"),
    (
        pack({"type": "hello", "protocol": 1, "gaol": {}}),
        "hello: gaol: unknown key; allowed: type, protocol, robot, goal, start, navigation; "
        "did you mean 'goal'?",
    ),
    (pack({"type": "hello", "protocol": 1, "robot": "nao"}), "this server is for qrio"),
    (pack({"type": "hello", "protocol": 1, "goal": 3}), "hello: goal: found 3"),
    (
        pack({"type": "hello", "protocol": 1, "goal": {"position": [0.0]}}),
        "hello: goal.position",
    ),
    (pack({"type": "hello", "protocol": 1}, {"maps": np.zeros(1)}), "hello: maps: unknown array"),
]
NAVIGATION: list[tuple[dict[str, Any], str]] = [
    ({"planner": "a_stra"}, "did you mean 'a_star'?"),
    ({"planner": "os:system"}, "a client names no Python"),
    ({"localizer": "truth"}, "reads the simulator"),
    ({"localizer": "monte_carlo"}, "static_map: is missing: monte_carlo has to be told a map"),
    ({"static_map": {"file": "house.bt"}}, "static_map.file: a server opens no map"),
    ({"fog": {"sell": 1}}, "sell"),
    ({"fog": {"cell": 0.0}}, "hello: navigation.fog.cell must be"),
]


@pytest.mark.parametrize(("data", "message"), FIRST)
def test_a_bad_hello_is_one_message_and_the_next_client_is_served(
    here: Running, data: bytes, message: str
) -> None:
    (error,) = answers(here, data)
    assert error.header["type"] == "error"
    assert message in error.header["message"]
    Client(here.address, goal=GOAL).close()


@pytest.mark.parametrize(("navigation", "message"), NAVIGATION)
def test_what_cannot_navigate_is_refused_by_key(
    here: Running, navigation: dict[str, Any], message: str
) -> None:
    with pytest.raises(ProtocolError) as caught:
        Client(here.address, goal=GOAL, navigation=navigation)
    assert str(caught.value).startswith("the server: hello: ")
    assert message in str(caught.value)


def test_a_known_map_is_told(here: Running, served: ServedRobot, tmp_path: Path) -> None:
    tree = Octree(0.04)
    x, y = np.meshgrid(np.arange(-1.0, 3.0, 0.04), np.arange(-1.0, 1.0, 0.04))
    ground = np.stack([x.ravel(), y.ravel(), np.full(x.size, -0.02)], axis=1)
    tree.insert(ground, np.array([0.0, 0.0, 0.5]))
    tree.write(str(tmp_path / "map.ot"))
    navigation, content = {"localizer": "monte_carlo"}, (tmp_path / "map.ot").read_bytes()
    with Client(here.address, goal=GOAL, navigation=navigation, static_map=content) as core:
        assert core.tick(observation(served)).state
    with pytest.raises(ProtocolError, match="hello: static_map: "):
        Client(here.address, goal=GOAL, navigation=navigation, static_map=content[:50])


WRONG: list[tuple[dict[str, Any], dict[str, Any], str]] = [
    ({"type": "observatoin"}, {}, "must be observation or goodbye now"),
    ({"type": "goodbye"}, {}, "unknown key; allowed: type"),
    ({"time_ns": -1}, {}, "time_ns: found -1; must be whole nanoseconds"),
    ({"time_ns": 1.5}, {}, "time_ns: found 1.5"),
    ({"time_ns": 2**64}, {}, "must be whole nanoseconds, 0 to"),
    ({"time": 0}, {}, "observation: time: unknown key"),
    ({"exposure_ns": 0}, {}, "and no array depth"),
    ({}, {"joint_positions": None}, "joint_positions: is missing; an array of float64 ["),
    ({}, {"joint_positions": np.zeros(3)}, "joint_positions: found float64 [3]; must be float64 ["),
    ({}, {"foot_forces": np.zeros(8)}, "foot_forces: found float64 [8]; must be float64 [2, 4]"),
    ({}, {"angular_velocity": np.zeros(3, np.float32)}, "found float32 [3]; must be float64 [3]"),
    ({}, {"specific_force": np.array([0.0, np.nan, 9.81])}, "specific_force: has a number that is"),
    ({}, {"foot_forces": np.full((2, 4), np.inf)}, "foot_forces: has a number that is not finite"),
    ({}, {"dept": np.zeros(1)}, "unknown array; allowed: joint_positions"),
    ({}, {"depth": np.zeros((72, 88), np.float32)}, "arrival_ns: found None"),
    (
        {"arrival_ns": 0, "exposure_ns": 1},
        {"depth": np.zeros((72, 88), np.float32)},
        "exposure_ns: found 1; must be whole nanoseconds, 0 to 0",
    ),
    (
        {"arrival_ns": 0, "exposure_ns": 0},
        {"depth": np.zeros((88, 72), np.float32)},
        "depth: found float32 [88, 72]; must be float32 [72, 88]",
    ),
]


@pytest.mark.parametrize(("header", "arrays", "message"), WRONG)
def test_a_bad_observation_is_one_message(
    here: Running,
    served: ServedRobot,
    header: dict[str, Any],
    arrays: dict[str, Any],
    message: str,
) -> None:
    if header.get("type") == "goodbye":
        wrong = pack({"type": "goodbye", "when": "now"})
    else:
        wrong = told(served, header, **arrays)
    hello, fine, error = answers(here, HELLO + told(served, {"time_ns": 0}) + wrong)
    assert (hello.header["type"], fine.header["type"]) == ("hello", "targets")
    assert error.header["type"] == "error"
    assert message in error.header["message"]
    assert len(error.header["message"].splitlines()) == 1


def test_time_that_stands_still_is_refused(here: Running, served: ServedRobot) -> None:
    core = Client(here.address, goal=GOAL)
    core.tick(observation(served, 3))
    with pytest.raises(ProtocolError, match="time_ns: found 30000000; must be later than 3"):
        core.tick(observation(served, 3))
    core.abandon()


@settings(
    deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(st.data())
def test_any_damage_to_a_session_is_told_and_the_next_client_is_served(
    here: Running, served: ServedRobot, data: st.DataObject
) -> None:
    whole = HELLO + told(served) + told(served, {"time_ns": TICK_NS}) + pack({"type": "goodbye"})
    damaged = bytearray(whole[: data.draw(st.integers(1, len(whole)))])
    for _ in range(data.draw(st.integers(0, 3))):
        damaged[data.draw(st.integers(0, len(damaged) - 1))] = data.draw(st.integers(0, 255))
    with connected(here.address, 20.0) as connection:
        connection._socket.sendall(damaged)
        connection._socket.shutdown(socket.SHUT_WR)
        kinds = []
        while (message := connection.receive()) is not None:
            kinds.append(message.header["type"])
    assert kinds[-1] in ("error", "goodbye")
    assert "error" not in kinds[:-1]
    assert damaged != whole or kinds == ["hello", "targets", "targets", "goodbye"]
    Client(here.address, goal=GOAL).close()


@pytest.mark.parametrize("cut", [1, 8, 30, len(HELLO), len(HELLO) + 5, -1])
def test_who_leaves_in_the_middle_leaves_the_server_waiting(
    served: ServedRobot, tmp_path: Path, cut: int
) -> None:
    with running(served, tmp_path / "s") as here:
        with connected(here.address, 20.0) as connection:
            connection._socket.sendall((HELLO + told(served))[:cut])
        assert "error: the connection " in here.last(1)
        Client(here.address, goal=GOAL).close()
        assert "goodbye after 0 ticks" in here.last(2)


def test_who_says_nothing_or_dribbles_is_let_go(served: ServedRobot, tmp_path: Path) -> None:
    with running(served, tmp_path / "s", timeout_s=1.0) as here:
        (error,) = answers(here, b"")
        assert error.header["message"] == "no whole message came for 1 s, the time-out"
        with connected(here.address, 20.0) as connection:
            sent = 0
            while sent < len(HELLO) and not here.said[1:]:
                with suppress(OSError):
                    connection._socket.send(HELLO[sent : sent + 1])
                sent += 1
                time.sleep(0.05)
            assert sent < len(HELLO)
            answer = connection.receive()
        assert answer is not None
        assert "the time-out" in answer.header["message"]
        Client(here.address, goal=GOAL).close()


def test_who_takes_no_answer_is_let_go() -> None:
    ours, theirs = socket.socketpair()
    numbers = np.zeros(1 << 22)
    with (
        Connection(ours, 0.2) as connection,
        theirs,
        pytest.raises(ProtocolError, match=r"took no message for 0\.2 s"),
    ):
        connection.send({}, {"a": numbers})


BROKEN = """
class Broken:
    def next(self, situation):
        raise RuntimeError("no idea")
"""


def test_a_part_of_the_servers_that_fails_is_told_and_the_server_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "broken_part.py").write_text(BROKEN)
    monkeypatch.syspath_prepend(tmp_path)
    robot = ServedRobot("qrio", ["navigation.behaviour=broken_part:Broken"])
    robot.check()
    with running(robot, tmp_path / "s") as here:
        for number in (1, 2):
            core = Client(here.address, goal=GOAL)
            with pytest.raises(ProtocolError, match="the server: behaviour: broken_part:Broken"):
                core.tick(observation(robot))
            core.abandon()
            assert "no idea" in here.last(number)


def test_who_leaves_without_a_word_is_no_client(served: ServedRobot, tmp_path: Path) -> None:
    with running(served, tmp_path / "s") as here:
        connected(here.address, 20.0).close()
        Client(here.address, goal=GOAL).close()
        assert "goodbye after 0 ticks (0.00 s, no state): nothing declared" in here.last(1)
    lines = Attended(3, 2 * TICK_NS, "walk", "refused", "blocked: no way")
    assert lines.sentence() == "goodbye after 3 ticks (0.02 s, walk): blocked: no way"


def test_settings_of_the_server_beat_the_clients() -> None:
    robot = ServedRobot("qrio", ["navigation.fog.cell=0.0", "navigation.planner=a_star"])
    with pytest.raises(InputError, match=r"settings: navigation\.fog\.cell must be"):
        robot.check()
    fine = ServedRobot("qrio", ["navigation.fog.cell=0.05"])
    fine.check()
    assert fine.slots()["planner"] == "a_star"
    tables = {"goal": GOAL, "navigation": {"fog": {"cell": 0.02}}}
    scenario = fine.scenario(tables, "hello")
    assert scenario.navigation.parameters() == {"fog": {"cell": 0.05}}
    for setting, message in (
        ("course.x=1", r"a server sets navigation\.\* alone"),
        ("navigation=1", r"a server sets navigation\.\* alone"),
        ("navigation", "KEY=VALUE"),
    ):
        with pytest.raises(InputError, match=message):
            ServedRobot("qrio", [setting])
    with pytest.raises(InputError, match="did you mean 'qrio'"):
        ServedRobot("qiro")
    with pytest.raises(InputError, match=r"settings: navigation\.planner: found"):
        ServedRobot("qrio", ["navigation.planner=a_stra"]).check()


def test_a_recorded_run_over_tcp_answers_as_it_did(served: ServedRobot) -> None:
    observations = list(read_observations(recorded_run() / "observations.mcap"))[:60]
    with running(served, 0) as here:
        assert isinstance(here.address, int)
        with Client(here.address, goal=GOAL, timeout_s=20.0) as core:
            over = [core.tick(each) for each in observations]
    core_here = served.core(Message({"type": "hello", "protocol": 1, "goal": GOAL}))
    for each, targets in zip(observations, over, strict=True):
        tick = core_here.tick(each)
        assert tick.positions.tobytes() == targets.position.tobytes()
        assert tick.torques.tobytes() == targets.torque.tobytes()
        assert (tick.estimate, tick.state) == (targets.estimate, targets.state)
