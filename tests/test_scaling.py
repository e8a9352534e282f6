"""A scenario fitted to its robot's size: what is multiplied, what is drawn, what stays."""

import json
import math
import re
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from episode_builders import qrio, scenario
from hypothesis import given, settings
from hypothesis import strategies as st
from test_solvable import WALLS, gap

from treadwell.cli.app import execute
from treadwell.course.build import build_course
from treadwell.course.plan import plan_course
from treadwell.course.static_map import static_map
from treadwell.episode import Episode
from treadwell.errors import InputError
from treadwell.experiments.drawn import write_scenario
from treadwell.judging.contacts import RISER_IMPULSE, Collision
from treadwell.judging.judge import Judge
from treadwell.judging.level_changes import FootTrack
from treadwell.recording.cut_off import CutRun
from treadwell.reporting.run_data import RunData
from treadwell.robot.load import Robot
from treadwell.runner import play_episode
from treadwell.scenario.elements import named_file
from treadwell.scenario.events import EVENTS
from treadwell.scenario.faults import FAULTS
from treadwell.scenario.loading import load_scenario, scenario_names
from treadwell.scenario.model import Goal, Scenario, Start
from treadwell.scenario.scaling import (
    IMPULSES,
    LENGTHS,
    MASS_KG,
    SPEEDS,
    TIMES,
    scaled_event,
    size_of,
    to_robot,
)
from treadwell.scenario.types import Scale
from treadwell.solving.solvable import is_solvable

FITTED = ("scale_to_robot=true",)
EVENTS_TEXT = """
[[event]]
do = "push"
at = 4.0
impulse = [0.0, 0.5, 0.0]
[[event]]
do = "move"
name = "box"
near = [0.2, 0.0]
within = 0.3
path = [[1.0, 0.0], [1.0, 0.5]]
speed = 0.2
[[event]]
do = "fault"
at = 9.0
part = "feet"
kind = "stick"
foot = "left"
cell = 0
value = 20.0
duration = 2.0
[[event]]
do = "fault"
at = 9.0
part = "latency"
kind = "imu"
value = 0.02
"""
BOX = '[[course]]\nkind = "box"\nname = "box"\nposition = [1.0, 0.8]\n'


@dataclass(frozen=True)
class Size:
    scale: float
    mass: float = MASS_KG


class Larger(Robot):
    """qrio in a body three halves as long, as far as a course asks for it."""

    scale = 1.5


@cache
def larger() -> Robot:
    """Its model is qrio's, its file a robot's whose lengths are three halves of qrio's."""
    file, s = qrio().file, Larger.scale
    sole = file.legs.left.sole
    long = sole.model_copy(update={"length": s * sole.length, "width": s * sole.width})
    leg = file.legs.left.model_copy(update={"sole": long})
    body = {"radius": s * file.body.radius, "height": s * file.body.height}
    tables = {
        "body": file.body.model_copy(update=body),
        "legs": file.legs.model_copy(update={"left": leg}),
    }
    own = qrio()
    return Larger(own.name, own.folder, file.model_copy(update=tables), own.nominal)


def fitted(name: str, seed: int = 0) -> Scenario:
    return load_scenario(name, seed=seed, overrides=FITTED)


def test_a_robot_of_scale_one_and_a_scenario_that_does_not_ask_change_nothing() -> None:
    asked, silent = fitted("push"), load_scenario("push")
    assert to_robot(asked, Size(1.0, mass=5.4)) is asked
    assert to_robot(silent, Size(4.0)) is silent
    assert size_of(Size(1.0, mass=5.4)) == Scale()


def test_the_mass_that_impulses_are_held_against_is_that_of_qrio() -> None:
    assert qrio().mass == pytest.approx(MASS_KG)
    assert qrio().scale == 1.0


def test_lengths_times_speeds_impulses_and_expectations_follow_the_robot() -> None:
    made = scenario(BOX + EVENTS_TEXT + "[expect]\nmax_time = 50.0\nmax_height_error = 0.01\n")
    made = made.model_copy(update={"scale_to_robot": True})
    done = to_robot(made, Size(4.0, 21.0))
    assert done.goal.position == (8.0, 0.0)
    assert done.goal.radius == 4.0 * made.goal.radius
    assert done.time_limit == 2.0 * made.time_limit
    assert (done.expect.max_time, done.expect.max_height_error) == (100.0, 0.04)
    assert done.expect.max_falls == made.expect.max_falls
    push, move, stuck, late = done.event
    assert (push.at, push.impulse) == (8.0, (0.0, 0.5 * 3.0 * 2.0, 0.0))
    assert (move.near, move.within, move.speed) == ((0.8, 0.0), 1.2, 0.4)
    assert move.path == ((4.0, 0.0), (4.0, 2.0))
    assert (stuck.at, stuck.duration, stuck.value) == (18.0, 4.0, 60.0)
    assert late.value == 0.02


def test_a_smaller_robot_is_given_no_less_time() -> None:
    done = to_robot(fitted("push"), Size(0.64))
    assert done.time_limit == load_scenario("push").time_limit
    assert done.event[0].at == pytest.approx(0.8 * 6.0)


def test_what_was_fitted_once_is_not_fitted_again_and_is_written_down_as_it_was_read() -> None:
    made = fitted("slalom")
    done = to_robot(made, Size(2.5))
    assert to_robot(done, Size(2.5)) is done
    assert done.written is made
    assert done.configuration() == made.configuration()
    assert done.configuration()["scale_to_robot"] is True
    again = Scenario.model_validate(done.configuration())
    assert to_robot(again, Size(2.5)).goal == done.goal


@pytest.mark.parametrize("kind", ["start", "goal", *EVENTS])
def test_every_key_with_a_length_a_time_a_speed_or_an_impulse_is_multiplied(kind: str) -> None:
    model = {"start": Start, "goal": Goal}.get(kind) or EVENTS[kind]
    units = ((LENGTHS, r", m[.,:;]"), (SPEEDS, r"m/s"), (TIMES, r"seconds[.;]"), (IMPULSES, r"N·s"))
    for key, field in model.model_fields.items():
        text = field.description or ""
        if (kind, key) in {("fault", "value"), ("move", "gives_way")}:
            continue  # by its kind, below; of `Motion`
        for keys, unit in units:
            assert (key in keys) == bool(re.search(unit, text)), (kind, key, text)


def test_of_a_fault_only_what_is_a_force_grows() -> None:
    forces = {(p, k) for p, kinds in FAULTS.items() for k, kind in kinds.items() if kind.is_force}
    assert forces == {("feet", "stick")}


def lengths_of(name: str, seed: int, robot: Robot) -> list[np.ndarray]:
    plan = plan_course(to_robot(fitted(name, seed), robot), robot)
    found = []
    for element in plan.elements:
        found += [element.origin, *(top.polygon for top in element.tops)]
        found += [each for p in element.pieces for each in (p.vertices, p.center, p.size)]
        found += [mesh[0] for mesh in (element.shape, element.stems) if mesh is not None]
    moved = [np.array(e.way()) for e in plan.events if e.do == "move"]
    return [*found, *moved]


@pytest.mark.parametrize("name", scenario_names())
def test_one_seed_draws_the_same_course_for_a_larger_robot_and_multiplies_it(name: str) -> None:
    for seed in (0, 5):
        usual, large = (lengths_of(name, seed, robot) for robot in (qrio(), larger()))
        assert len(usual) == len(large)
        for one, other in zip(usual, large, strict=True):
            np.testing.assert_allclose(other, 1.5 * one, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("name", ["bridge_over", "terrain", "vegetation", "door_shuts", "slabs"])
def test_what_is_built_is_multiplied_to_the_last_geom(name: str) -> None:
    usual, large = (build_course(fitted(name), robot) for robot in (qrio(), larger()))
    assert (usual.scale, large.scale) == (1.0, 1.5)
    assert large.goal_height == pytest.approx(1.5 * usual.goal_height, abs=1e-5)
    own = np.flatnonzero(usual.geom_element >= 0)
    before, after = usual.model.geom_aabb[own], large.model.geom_aabb[own]
    np.testing.assert_allclose(after, 1.5 * before, rtol=1e-5, atol=1e-6)
    assert len(usual.events) == len(large.events)
    points = np.array([[x, 0.02] for x in np.linspace(-0.5, 4.0, 90)])
    heights = usual.height_at(points)
    np.testing.assert_allclose(large.height_at(1.5 * points), 1.5 * heights, atol=1e-6)


@settings(max_examples=30, deadline=None)
@given(factor=st.floats(0.2, 8.0), x=st.floats(-1.0, 4.0), y=st.floats(-0.8, 0.8))
def test_a_multiplied_surface_has_multiplied_heights(factor: float, x: float, y: float) -> None:
    for name in ("terrain", "slope_up"):
        for element in plan_course(load_scenario(name), qrio()).elements:
            for top in element.tops:
                point = np.array([[x, y]])
                expected = factor * top.height_at(point)
                found = top.multiplied(factor).height_at(factor * point)
                np.testing.assert_allclose(found, expected, atol=1e-9 * factor)


@pytest.mark.parametrize(
    "name", ["slalom", "stairs_up", "stairs_down", "stairs_too_high", "boxed_in", "beam_low"]
)
def test_a_larger_robot_finds_a_way_where_qrio_does(name: str) -> None:
    answers = [
        is_solvable(fitted(name), build_course(fitted(name), r), r) for r in (qrio(), larger())
    ]
    assert answers[0] == answers[1]


def test_a_larger_robot_finds_no_way_through_what_is_not_multiplied_with_it() -> None:
    plain = scenario(WALLS.format(y=0.5) + gap(0.36))
    usual, large = (is_solvable(plain, build_course(plain, r), r) for r in (qrio(), larger()))
    assert (usual, large) == (True, False)
    made = plain.model_copy(update={"scale_to_robot": True})
    assert is_solvable(made, build_course(made, larger()), larger()) is True


def test_the_map_of_a_larger_course_has_as_many_larger_voxels() -> None:
    usual, large = (build_course(fitted("slalom"), robot) for robot in (qrio(), larger()))
    sizes = [len(static_map(c, 0.04 * c.scale, "x").occupied()) for c in (usual, large)]
    assert sizes[1] == pytest.approx(sizes[0], rel=0.02)


def test_what_the_judge_allows_follows_robot_and_course() -> None:
    made = scenario().model_copy(update={"scale_to_robot": True})
    episode_course = build_course(made, larger())
    judge = Judge(episode_course.model, episode_course, to_robot(made, larger()), larger())
    usual = Judge(episode_course.model, replace(episode_course, scale=1.0), made, qrio())
    for key in ("_drift", "_goal_rise", "_spacing", "_stuck_radius"):
        assert getattr(judge, key) == pytest.approx(1.5 * getattr(usual, key)), key
    assert judge._stuck_seconds == pytest.approx(math.sqrt(1.5) * usual._stuck_seconds)
    hit = Collision(1.0, "left_foot", "step", 1.5 * RISER_IMPULSE, 1.0, riser_only=True)
    assert hit.counts
    assert not replace(hit, least=size_of(larger()).impulse * 2.0 * RISER_IMPULSE).counts


def test_a_change_of_level_is_counted_by_the_lengths_of_the_course() -> None:
    def rises(scale: float, height: float) -> int:
        track = FootTrack(lambda points: np.zeros(len(points)), scale)
        for x, z in ((0.0, 0.0), (0.05, height)):
            for _ in range(5):
                track.look(x, 0.0, z, touching=True)
            track.look(x, 0.0, z, touching=False)
        return track.rises

    assert (rises(1.0, 0.02), rises(2.0, 0.02), rises(2.0, 0.04)) == (1, 0, 1)


def test_a_run_says_by_what_its_lengths_were_multiplied(monkeypatch: pytest.MonkeyPatch) -> None:
    ends = ("goal.position=[0.25, 0.0]", "goal.radius=0.2")
    plain = play_episode(Episode("open_floor", overrides=ends))
    assert "scale" not in plain.document()
    monkeypatch.setattr(Robot, "scale", 1.3)
    result = play_episode(Episode("open_floor", overrides=(*FITTED, *ends)))
    assert result.outcome == "goal_reached"
    assert result.document()["scale"] == 1.3
    assert result.configuration["goal"]["position"] == [0.25, 0.0]
    assert result.configuration["scale_to_robot"] is True
    told = RunData(Path(), result, {}, [], np.empty((0, 8)), np.empty((0, 8)))
    assert told.scale == 1.3
    assert replace(told, result=None, cut=CutRun(1.0, scale=2.0)).scale == 2.0


@pytest.mark.parametrize("value", ['"yes"', "1", "2.0", "[true]"])
def test_what_is_not_true_or_false_is_refused_in_a_line(value: str) -> None:
    with pytest.raises(InputError) as refused:
        load_scenario("slalom", overrides=(f"scale_to_robot={value}",))
    text = str(refused.value)
    assert "scale_to_robot: found" in text
    assert "must be true or false" in text
    assert len(text.splitlines()) <= 2


def test_the_verb_check_tells_the_lengths_as_they_are_built(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setattr(Robot, "scale", 2.0)
    table = load_scenario("open_floor").configuration()
    file = write_scenario(
        tmp_path / "own.toml",
        {"schema": 1, "name": "own", "scale_to_robot": True, "start": {},
         "goal": {"position": table["goal"]["position"]}},
    )  # fmt: skip
    assert execute(["check", file, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["goal"]["position"] == [5.0, 0.0]
    assert told["configuration"]["goal"]["position"] == [2.5, 0.0]


def test_events_of_drawn_elements_are_multiplied_as_those_of_the_file() -> None:
    robot = larger()
    for seed in range(6):
        usual = plan_course(fitted("random_house", seed), qrio()).events
        large = plan_course(to_robot(fitted("random_house", seed), robot), robot).events
        for one, other in zip(usual, large, strict=True):
            assert other == scaled_event(one, size_of(robot))


def test_files_of_elements_are_those_of_the_file() -> None:
    made = fitted("bridge_over")
    names = [named_file(element) for element in to_robot(made, larger()).course]
    assert names == [named_file(element) for element in made.course]
