"""Events: each happens once, when its time or place has come, and writes only what it says."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from numpy.typing import ArrayLike

from treadwell.course.build import build_course
from treadwell.course.course import Course
from treadwell.course.events import PUSH_SECONDS, Events
from treadwell.course.geometry import PARKED
from treadwell.physics.recorded_audit import replay_audit
from treadwell.physics.simulation import Simulation, Start
from treadwell.protocols import JointTargets
from treadwell.robot.load import load_robot
from treadwell.scenario.events import EVENTS
from treadwell.scenario.loading import load_scenario
from treadwell.scenario.model import Scenario

ROBOT = load_robot("qrio")
TICK_STEPS = 5


@dataclass
class Stepless:
    """Stands in for the simulation: sets fields, counts steps, and moves nothing by itself."""

    model: mujoco.MjModel
    data: mujoco.MjData
    steps: int = 0
    written: list[tuple[int, str]] = field(default_factory=list)

    def set(self, name: str, value: ArrayLike) -> None:
        owner = self.model if name == "geom_friction" else self.data
        getattr(owner, name)[:] = value
        self.written.append((self.steps, name))


def prepared(*events: dict[str, Any], course: tuple[dict[str, Any], ...] = ()) -> tuple[
    Events, Stepless, Course
]:  # fmt: skip
    scenario = Scenario.model_validate(
        {"schema": 1, "name": "x", "start": {}, "goal": {}, "course": course, "event": events}
    )
    built = build_course(scenario, ROBOT)
    data = mujoco.MjData(built.model)
    data.qpos[:] = built.qpos
    return Events(scenario, built, ROBOT), Stepless(built.model, data), built


def advance(events: Events, physics: Stepless, seconds: float) -> None:
    for _ in range(round(seconds / (TICK_STEPS * physics.model.opt.timestep))):
        events.before_tick(physics)
        physics.steps += TICK_STEPS


def test_a_push_gives_its_impulse_in_a_tenth_of_a_second() -> None:
    events, physics, _ = prepared({"at": 0.5, "do": "push", "impulse": [0.3, -0.4, 0.1]})
    torso = physics.model.body(ROBOT.file.body.torso).id
    impulse = np.zeros(3)
    for _ in range(100):
        events.before_tick(physics)
        impulse += physics.data.xfrc_applied[torso, :3] * TICK_STEPS * physics.model.opt.timestep
        physics.steps += TICK_STEPS
    np.testing.assert_allclose(impulse, [0.3, -0.4, 0.1])
    assert [name for _, name in physics.written] == ["xfrc_applied"] * 2
    assert [step for step, _ in physics.written] == [250, 250 + round(PUSH_SECONDS / 0.002)]
    assert not physics.data.xfrc_applied.any()


def test_pushes_at_the_same_time_add_up() -> None:
    push = {"do": "push", "impulse": [0.1, 0.0, 0.0]}
    events, physics, _ = prepared({"at": 0.0, **push}, {"at": 0.05, **push})
    torso = physics.model.body(ROBOT.file.body.torso).id
    forces = []
    for _ in range(20):
        events.before_tick(physics)
        forces.append(round(float(physics.data.xfrc_applied[torso, 0]), 9))
        physics.steps += TICK_STEPS
    assert forces == [1.0] * 5 + [2.0] * 5 + [1.0] * 5 + [0.0] * 5


def test_nothing_happens_before_its_time_and_nothing_twice() -> None:
    events, physics, _ = prepared({"at": 1.0, "do": "friction", "value": 0.4})
    advance(events, physics, 1.0)
    assert not events.fired
    advance(events, physics, 1.0)
    assert events.fired == [(pytest.approx(1.0), "friction")]
    assert (physics.model.geom_friction[:, 0] == 0.4).all()
    assert len(physics.written) == 1


def test_a_place_triggers_when_the_robot_comes_near() -> None:
    events, physics, _ = prepared({"near": [1, 0], "within": 0.3, "do": "blind", "duration": 2})
    advance(events, physics, 0.5)
    assert not events.is_blind(0.4)
    physics.data.qpos[0] = 0.71
    advance(events, physics, 0.5)
    assert events.is_blind(0.6)
    assert events.is_blind(2.49)
    assert not events.is_blind(2.5)


def test_an_element_is_added_and_removed_where_the_file_has_it() -> None:
    element = {"kind": "box", "name": "visitor", "position": [1.5, 0.2]}
    events, physics, course = prepared(
        {"at": 0.1, "do": "add", "element": element}, {"at": 0.3, "do": "remove", "name": "visitor"}
    )
    visitor = course.element("visitor")
    assert visitor is not None
    assert visitor.mocap_id is not None
    assert "visitor" not in events.present
    advance(events, physics, 0.2)
    assert "visitor" in events.present
    np.testing.assert_allclose(physics.data.mocap_pos[visitor.mocap_id], [1.5, 0.2, 0.0])
    np.testing.assert_allclose(events.place(visitor, physics.data), 0.0)
    advance(events, physics, 0.2)
    assert "visitor" not in events.present
    assert physics.data.mocap_pos[visitor.mocap_id, 2] == PARKED


def test_an_added_box_stands_in_the_way_of_rays() -> None:
    element = {"kind": "box", "position": [1.5, 0.0], "size": [0.2, 0.2, 0.4]}
    events, physics, _ = prepared({"at": 0.1, "do": "add", "element": element})

    def reach() -> float:
        mujoco.mj_kinematics(physics.model, physics.data)
        geom = np.zeros(1, dtype=np.int32)
        start, ahead = np.array([0.5, 0.0, 0.2]), np.array([1.0, 0.0, 0.0])
        return float(mujoco.mj_ray(physics.model, physics.data, start, ahead, None, 1, -1, geom))

    assert reach() < 0.0
    advance(events, physics, 0.2)
    assert reach() == pytest.approx(0.9)


def test_a_moving_element_keeps_its_speed_and_stops_at_its_target() -> None:
    events, physics, course = prepared(
        {"at": 0.0, "do": "move", "name": "post", "to": [1.2, 0.0], "speed": 0.2},
        course=({"kind": "cylinder", "name": "post", "position": [1.2, -0.4]},),
    )
    post = course.element("post")
    assert post is not None
    assert post.mocap_id is not None
    advance(events, physics, 1.0)
    np.testing.assert_allclose(physics.data.mocap_pos[post.mocap_id], [1.2, -0.2, 0.0], atol=1e-9)
    advance(events, physics, 2.0)
    np.testing.assert_allclose(physics.data.mocap_pos[post.mocap_id], [1.2, 0.0, 0.0])
    np.testing.assert_allclose(events.place(post, physics.data), [0.0, 0.4, 0.0])
    assert max(step for step, _ in physics.written) <= 1005


@pytest.mark.parametrize("do", [{"do": "remove"}, {"do": "move", "to": [0, 1], "speed": 1}])
def test_what_is_not_there_is_neither_removed_nor_moved(do: dict[str, Any]) -> None:
    added = {"at": 9.0, "do": "add", "element": {"kind": "box", "name": "late"}}
    events, physics, _ = prepared(
        {"at": 0.0, "name": "late", **do}, {"at": 0.0, "name": "nobody", **do}, added
    )
    advance(events, physics, 1.0)
    assert not physics.written
    assert len(events.fired) == 2


def test_a_kidnapped_robot_keeps_its_height_above_the_surface() -> None:
    events, physics, _ = prepared(
        {"at": 0.1, "do": "kidnap", "position": [2.5, 0.0], "yaw": 1.0},
        course=({"kind": "platform"},),
    )
    before = physics.data.qpos.copy()
    advance(events, physics, 0.5)
    after = physics.data.qpos
    np.testing.assert_allclose(after[:3], [2.5, 0.0, before[2] + 0.03])
    np.testing.assert_allclose(after[3:7], [np.cos(0.5), 0.0, 0.0, np.sin(0.5)], atol=1e-12)
    np.testing.assert_array_equal(after[7:], before[7:])
    assert physics.written == [(50, "qpos")]


def test_encoder_offsets_add_up() -> None:
    offset = {"do": "encoder_offset", "joint": "left_knee_pitch", "value": 0.01}
    events, physics, _ = prepared({"at": 0.0, **offset}, {"at": 0.1, **offset})
    advance(events, physics, 0.5)
    assert events.encoder_offsets == {"left_knee_pitch": pytest.approx(0.02)}
    assert not physics.written


def test_every_kind_of_event_is_handled() -> None:
    tables: dict[str, dict[str, Any]] = {
        "add": {"element": {"kind": "box"}},
        "remove": {"name": "a"},
        "move": {"name": "a", "to": [0, 0]},
        "set_door": {"name": "door", "open": 0.0},
        "push": {"impulse": [0, 0, 0]},
        "kidnap": {"position": [1, 1]},
        "blind": {"duration": 1},
        "friction": {"value": 1},
        "encoder_offset": {"joint": "neck_pan", "value": 0.1},
        "fault": {"part": "imu", "kind": "zero", "duration": 0.02},
        "knock": {"pitch": 0.1},
    }
    assert set(tables) == set(EVENTS)
    happens = ({"at": 0, "do": do, **t} for do, t in tables.items())
    events, physics, _ = prepared(*happens, course=({"kind": "door"},))
    advance(events, physics, 0.05)
    assert [do for _, do in events.fired] == list(tables)
    assert [broken.kind for broken in events.broken(0.01)] == ["zero"]
    assert not events.broken(0.02)


def test_plain_mujoco_repeats_a_run_with_every_event_that_touches_the_physics(
    tmp_path: Path,
) -> None:
    scenario = Scenario.model_validate(
        {
            "schema": 1,
            "name": "x",
            "start": {},
            "goal": {},
            "course": [{"kind": "cylinder", "name": "post"}, {"kind": "door", "name": "door"}],
            "event": [
                {"at": 0.1, "do": "add", "element": {"kind": "box", "position": [0.3, 0.0]}},
                {"at": 0.1, "do": "push", "impulse": [0.3, 0.2, 0.0]},
                {"at": 0.15, "do": "move", "name": "post", "to": [0.2, 0.0], "speed": 5.0},
                {"at": 0.2, "do": "set_door", "name": "door", "open": 0.2},
                {"at": 0.3, "do": "friction", "value": 0.3},
                {"at": 0.4, "do": "kidnap", "position": [-1.0, 0.0], "yaw": 0.5},
                {"at": 0.5, "do": "remove", "name": "post"},
            ],
        }
    )
    course = build_course(scenario, ROBOT)
    simulation = Simulation(course.model, ROBOT, Start())
    events = Events(scenario, course, ROBOT)
    still = np.zeros(len(ROBOT.joints))
    for _ in range(70):
        events.before_tick(simulation)
        simulation.advance(JointTargets(ROBOT.stand, still, still))
    assert len(events.fired) == 7
    simulation.save_audit(tmp_path)
    assert replay_audit(tmp_path) is None


def on_the_first_step(name: str) -> tuple[Events, Simulation, Course]:
    """A shipped scenario with the robot put on its first step; its events are not yet asked."""
    scenario = load_scenario(name, overrides=("start.position=[0.2, 0.0]", "start.yaw=0.0"))
    built = build_course(scenario, ROBOT)
    simulation = Simulation(built.model, ROBOT, Start(0.66, 0.0, height=0.03))
    return Events(scenario, built, ROBOT), simulation, built


def surface_by_ray(physics: Simulation, x: float) -> float:
    """Height of what a ray from above meets first beside the robot, (x, 0.15), by MuJoCo."""
    mujoco.mj_kinematics(physics.model, physics.data)
    down, geom = np.array([0.0, 0.0, -1.0]), np.zeros(1, dtype=np.int32)
    start = np.array([x, 0.15, 2.0])
    return 2.0 - float(mujoco.mj_ray(physics.model, physics.data, start, down, None, 1, -1, geom))


@pytest.mark.parametrize(
    ("name", "x", "before", "after"),
    [("stair_removed", 0.9, 0.09, 0.0), ("stair_lifted", 0.78, 0.06, 0.068)],
)
def test_a_step_changes_under_a_robot_that_climbs_the_first_and_leaves_that_as_it_is(
    name: str, x: float, before: float, after: float
) -> None:
    events, simulation, _ = on_the_first_step(name)
    assert surface_by_ray(simulation, x) == pytest.approx(before)
    n = len(ROBOT.joints)
    for _ in range(50):
        events.before_tick(simulation)
        simulation.advance(JointTargets(ROBOT.stand, np.zeros(n), np.zeros(n)))
    assert len(events.fired) == 1
    assert surface_by_ray(simulation, x) == pytest.approx(after)
    assert simulation.data.qpos[2] == pytest.approx(ROBOT.stand_qpos[2] + 0.03, abs=3e-3)


@pytest.mark.parametrize("name", ["stair_removed", "stair_lifted", "stair_blind"])
def test_nothing_happens_to_the_stairs_while_the_robot_is_still_in_front_of_them(
    name: str,
) -> None:
    for seed in range(5):
        scenario = load_scenario(name, seed=seed)
        built = build_course(scenario, ROBOT)
        events = Events(scenario, built, ROBOT)
        place = built.start
        for x in (place.position[0], 0.6 - 0.0525):
            start = Start(x, place.position[1], yaw=place.yaw, height=place.height)
            events.before_tick(Simulation(built.model, ROBOT, start))
        assert events.fired == []
