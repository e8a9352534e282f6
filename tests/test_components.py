"""A part of the user's own takes a slot, by object or by name; a broken one is named."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from user_parts import PARTS, AllGround, Legs, Meadow, Still, Straight

import treadwell
from treadwell import protocols
from treadwell._core import BodyState, Planes, Situation, Staircase
from treadwell.components import COMPONENTS
from treadwell.errors import CoreError, InputError
from treadwell.plugins import METHODS
from treadwell.protocols import Decision, Footstep, Plan, Pose, Segmentation

SECONDS = ("time_limit=1.2",)


def run(**parts: Any) -> treadwell.Episode:  # noqa: ANN401 - any part
    episode = treadwell.Episode("slalom", seed=2, overrides=SECONDS, **parts)
    for _ in episode:
        pass
    return episode


def test_every_slot_has_a_protocol_with_the_methods_that_are_asked_for() -> None:
    assert set(METHODS) == set(COMPONENTS) == set(PARTS)
    for slot, methods in METHODS.items():
        protocol = getattr(protocols, "".join(word.title() for word in slot.split("_")))
        own = {name for name in vars(protocol) if not name.startswith("_")}
        assert own == set(methods)


@pytest.mark.parametrize(
    ("slot", "name"), [(slot, name) for slot, names in COMPONENTS.items() for name in names]
)
def test_every_component_of_the_list_takes_its_slot(slot: str, name: str) -> None:
    choice = f"navigation.{slot}={name}"
    episode = treadwell.Episode("slalom", seed=2, overrides=("time_limit=1.6", choice))
    for _ in episode:
        pass
    assert episode.pilot.frames_used > 0
    assert (episode.pilot.view().kind == 1).sum() > 100
    assert episode.pilot.planes().ground is not None


def test_a_planner_is_given_map_stairs_pose_and_goal_and_its_path_is_taken() -> None:
    part = Straight(points=7)
    episode = run(planner=part)
    view, stairs, start, goal = part.seen[-1]
    assert view.kind.shape == (100, 100)
    assert isinstance(stairs, Staircase)
    assert np.hypot(*start[:2]) < 0.2
    assert goal.position == pytest.approx((2.8, 0.0))
    assert goal.radius == pytest.approx(0.15)
    assert goal.height is None
    path = episode.pilot.path()
    assert path is not None
    assert path.shape == (7, 2)
    assert episode.pilot.replans == 0


def test_a_behaviour_is_given_the_situation_and_its_word_is_done() -> None:
    part = Still()
    episode = treadwell.Episode("slalom", seed=2, overrides=SECONDS, behaviour=part)
    assert {step.state for step in episode} == {"idle"}
    last = part.seen[-1]
    assert last.goal == pytest.approx((2.8, 0.0))
    assert last.goal_radius == pytest.approx(0.15)
    assert last.last_goal
    assert last.standing
    assert last.no_way is None or ":" in last.no_way
    assert last.time_ns == 1_190_000_000
    assert last.frames_used == episode.pilot.frames_used > 0
    assert last.view().kind.shape == (100, 100)
    assert isinstance(last.stairs, Staircase)
    assert last.climbs == []
    assert (last.stepping.landed, last.stepping.misstep) == (0, None)
    assert episode.pilot.gaze == pytest.approx((0.3, 0.5), abs=0.05)
    assert episode.pilot.steps_taken == 0


@pytest.mark.parametrize("manner", ["careful", "walked"])
def test_footsteps_of_a_behaviour_are_taken_one_by_one(manner: str) -> None:
    listed = (
        Footstep("left", 0.04, 0.042, 0.0, 0.0, -0.05, 0.05, manner),
        Footstep("right", 0.04, -0.042, 0.0, 0.0, -0.05, 0.05, manner),
    )

    class Marching:
        def __init__(self) -> None:
            self.begun, self.done = False, False

        def next(self, situation: Situation) -> Decision:
            self.begun |= not situation.standing
            self.done |= self.begun and situation.standing
            waits = self.done or situation.time_ns < 500_000_000
            return Decision("march", footsteps=() if waits else listed)

    part = Marching()
    episode = treadwell.Episode("slalom", seed=2, overrides=("time_limit=6",), behaviour=part)
    for step in episode:
        pose = step.estimate.pose
        if part.done:
            break
    assert part.done
    assert episode.pilot.steps_taken == episode.pilot.stepping.landed == 2
    assert pose[0] == pytest.approx(0.04, abs=0.015)
    assert (step.time_ns < 3_200_000_000) == (manner == "walked")


def test_a_localizer_is_asked_at_every_tick_and_told_of_every_frame() -> None:
    part = Legs()
    episode = run(localizer=part)
    assert not episode.ablation
    assert len({body.time_ns for body in part.seen}) == 120
    assert part.corrections > 5
    assert part.seen[-1].foot_loads.sum() == pytest.approx(7.0 * 9.81, rel=0.3)


def test_a_segmenter_is_given_a_scan_and_its_planes_are_taken() -> None:
    part = AllGround()
    episode = run(segmenter=part)
    scan = part.seen[-1]
    assert (scan.disparity.shape, scan.disparity.dtype) == ((72, 88), np.float32)
    depth = scan.focal * scan.baseline / scan.disparity[np.isfinite(scan.disparity)]
    assert 0.2 < np.median(depth) < 2.0
    planes = episode.pilot.planes()
    assert planes.ground == 0
    assert len(planes.regions) == 1
    assert planes.exposure_ns == scan.exposure_ns
    assert planes.regions[0][0] == np.count_nonzero(planes.labels)
    lonely = planes.labels == 0
    assert np.isnan(planes.floor_height[lonely]).all()
    assert (planes.floor_height[~lonely] == 0.0).all()


def test_a_world_model_is_given_planes_and_its_view_is_planned_on() -> None:
    part = Meadow()
    episode = run(world_model=part)
    planes, pose = part.seen[-1]
    assert len(pose) == 4
    assert planes.labels.shape == (6336,)
    view = episode.pilot.view()
    assert (view.kind == 1).all()
    assert view.origin == (-2.0, -1.5)
    assert view.cell == 0.05
    assert (view.sightings == np.iinfo(np.uint16).max).all()
    assert episode.pilot.frames_used == len(part.seen)


def test_a_world_model_may_count_what_it_saw() -> None:
    class Counting(Meadow):
        class View(Meadow.View):
            sightings = np.arange(60 * 80, dtype=np.uint16).reshape(60, 80)

    episode = run(world_model=Counting())
    assert (episode.pilot.view().sightings == Counting.View.sightings).all()


class Jumping(Legs):
    """Finds itself a metre further on at its fifth frame."""

    def estimate(self, body: BodyState) -> Pose:
        x, y, z, yaw = super().estimate(body)
        return x + (self.corrections >= 5), y, z, yaw


def test_a_map_and_a_planner_are_told_once_that_the_robot_is_elsewhere() -> None:
    calls: list[str] = []

    class Map(Meadow):
        def insert(self, planes: Planes, pose: Pose) -> bool:
            calls.append("insert")
            return super().insert(planes, pose)

        def forget(self) -> None:
            calls.append("map forgets")

    class Way(Straight):
        def forget(self) -> None:
            calls.append("planner forgets")

    run(localizer=Jumping(), world_model=Map(), planner=Way())
    assert calls.index("map forgets") == 4
    assert [call for call in calls if call != "insert"] == ["map forgets", "planner forgets"]
    assert len(calls) > 8


def test_what_forgetting_raises_ends_the_run_with_the_parts_name() -> None:
    class Clinging(Straight):
        def forget(self) -> None:
            raise RuntimeError("never")

    with pytest.raises(CoreError, match=r"planner: Clinging: RuntimeError\('never'\)"):
        run(localizer=Jumping(), planner=Clinging())


@pytest.mark.parametrize("slot", PARTS)
def test_a_part_is_found_by_its_name(slot: str) -> None:
    name = f"user_parts:{PARTS[slot].__name__}"
    episode = treadwell.Episode("slalom", overrides=("time_limit=0.2", f"navigation.{slot}={name}"))
    assert episode.scenario.configuration()["navigation"][slot] == name
    assert len([*episode]) > 0


def test_a_named_parts_table_goes_to_its_constructor() -> None:
    named = ("navigation.planner=user_parts:Straight", "navigation.Straight.points=5")
    episode = treadwell.Episode("slalom", overrides=(*SECONDS, *named))
    for _ in episode:
        pass
    path = episode.pilot.path()
    assert path is not None
    assert len(path) == 5


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("navigation.planner=no_such_package:Thing", "there is no module no_such_package"),
        ("navigation.planner=user_parts:Thing", "user_parts has no class Thing"),
        ("navigation.planner=user_parts:Still", "Still has no method plan"),
        ("navigation.Straight.points=1", r"cannot make user_parts:Straight.*2 or more"),
        ("navigation.Straight.pints=3", "cannot make user_parts:Straight.*pints"),
    ],
)
def test_a_part_that_cannot_be_had_is_bad_input(setting: str, message: str) -> None:
    named = ("navigation.planner=user_parts:Straight", setting)
    with pytest.raises(InputError, match=message):
        treadwell.Episode("slalom", overrides=named)


def test_an_object_that_does_not_fit_its_slot_is_bad_input() -> None:
    with pytest.raises(InputError, match="planner: Still has no method plan"):
        treadwell.Episode("slalom", planner=Still())
    with pytest.raises(InputError, match="navigator: no such component; there are world_model"):
        treadwell.Episode("slalom", navigator=Still())


class Broken:
    """Any part: fails at the third call of anything."""

    def __init__(self) -> None:
        self.calls = 0

    def fail(self, *_: object) -> Any:  # noqa: ANN401 - it never returns anything good
        self.calls += 1
        raise RuntimeError("a wheel came off")

    segment = insert = view = correct = estimate = plan = next = step = fail


@pytest.mark.parametrize("slot", PARTS)
def test_an_exception_ends_the_run_with_error_and_the_parts_name(slot: str, tmp_path: Path) -> None:
    parts: dict[str, Any] = {slot: Broken()}
    out = tmp_path / "run"
    done = treadwell.run("slalom", overrides=SECONDS, out=out, record=False, **parts)
    assert done.outcome == "error"
    assert not done.passed
    assert done.result.reason is not None
    assert done.result.reason.startswith(f"error: {slot}: ")
    assert "a wheel came off" in done.result.reason
    assert " at " in done.result.reason
    assert {"result.json", "trajectory.tum", "physics.npz", "model.mjb", "map.png"} <= {
        path.name for path in out.iterdir()
    }


def segmentation(**changes: object) -> Segmentation:
    facts: dict[str, Any] = {
        "labels": np.zeros(6336, np.uint16),
        "floor_heights": [],
        "robot_from_camera": np.eye(4),
        "ground": None,
        "reliable": True,
    }
    return Segmentation(**facts | changes)


def marching(velocity: tuple[float, float, float] | None = None, **changes: Any) -> Decision:  # noqa: ANN401 - whatever a footstep may be wrong in
    step = Footstep("left", 0.04, 0.042, 0.0, 0.0, -0.05, 0.05)._replace(**changes)
    return Decision("march", velocity=velocity, footsteps=(step,))


class BadView:
    origin = (0.0, 0.0)
    cell = 0.04
    kind = np.zeros((4, 4), np.uint8)
    height = np.zeros((4, 5), np.float32)


class Miscounting(Meadow.View):
    sightings = np.zeros((60, 81), np.uint16)


@pytest.mark.parametrize(
    ("slot", "answer", "message"),
    [
        ("planner", None, r"planner: Odd: .*plan\(\) must return a Plan, got None"),
        ("planner", (1, 2), r"plan\(\) must return a Plan, got tuple \(int, int\)"),
        ("planner", Plan(np.zeros((3, 3))), r"planner: .*path must be \(n, 2\)"),
        ("planner", Plan(np.zeros((0, 2))), "planner: .*n > 0"),
        ("planner", Plan(np.full((2, 2), np.nan)), "planner: .*path must be finite"),
        ("behaviour", None, r"behaviour: .*next\(\) must return a Decision, got None"),
        ("behaviour", Decision("x", velocity=(np.nan, 0.0, 0.0)), "behaviour: .*finite"),
        ("behaviour", Decision("x", gaze=(np.inf, 0.0)), "behaviour: .*finite"),
        ("behaviour", marching(side="middle"), "behaviour: .*left or right, got middle"),
        ("behaviour", marching(manner="hopped"), "behaviour: .*walked or careful, got hopped"),
        ("behaviour", marching(x=np.nan), "behaviour: .*footsteps must be finite"),
        ("behaviour", marching(bearing_to=-0.06), "behaviour: .*bearing_from must be below"),
        ("behaviour", marching((0.1, 0.0, 0.0)), "behaviour: .*velocity must be None"),
        ("behaviour", Decision("x", footsteps=((1, 2),)), "behaviour: "),  # type: ignore[arg-type]
        ("localizer", (0.0, 0.0, 0.0), "localizer: "),
        ("localizer", (0.0, 0.0, np.nan, 0.0), "localizer: Odd: .*estimate must be finite"),
        ("segmenter", None, r"segment\(\) must return a Segmentation, got None"),
        ("segmenter", segmentation(labels=np.zeros(5, np.uint16)), "6336 values, got 5"),
        ("segmenter", segmentation(labels=np.ones(6336, np.uint16)), "at most 0, got 1"),
        ("segmenter", segmentation(robot_from_camera=np.eye(3)), "segmenter: .*finite"),
        ("world_model", BadView, r"world_model: .*one shape"),
        ("world_model", Miscounting, r"world_model: .*kind and sightings must have one shape"),
        ("world_model", "no view", "world_model: "),
        ("world_model", None, r"view\(\) must return a FloorMap, got None"),
        ("walker", None, r"step\(\) must return JointTargets, got None"),
    ],
)
def test_an_answer_that_makes_no_sense_is_an_error_with_the_parts_name(
    slot: str, answer: object, message: str
) -> None:
    class Odd(Broken):
        def fail(self, *_: object) -> Any:  # noqa: ANN401 - whatever it is
            return answer

        segment = insert = view = correct = estimate = plan = next = step = fail

    parts: dict[str, Any] = {slot: Odd()}
    with pytest.raises(CoreError, match=message):
        run(**parts)


def test_a_planner_that_finds_no_way_says_why() -> None:
    class Lazy:
        def plan(self, *_: object) -> Plan:
            return Plan(None, "it is too far")

    still = Still()
    run(planner=Lazy(), behaviour=still)
    assert still.seen[-1].no_way == "no_path: it is too far"
    assert still.seen[-1].path is None


@pytest.mark.parametrize("outcome", ["goal_reached", "blocked: a user said so"])
def test_a_behaviours_outcome_ends_the_episode(outcome: str) -> None:
    class Ready:
        def next(self, *_: object) -> Decision:
            return Decision("done", outcome=outcome)

    episode = treadwell.Episode("slalom", behaviour=Ready())
    for _ in episode:
        pass
    assert episode.verdict is not None
    if outcome == "goal_reached":  # which is not so: the judge sees it
        assert episode.verdict.outcome == "stuck"
    else:
        assert episode.verdict.outcome == "refused"
        assert episode.verdict.reason == outcome
