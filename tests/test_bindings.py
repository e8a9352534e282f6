"""The border to the core: bad settings by their key, bad readings by their name, never a panic."""

import json
import sys
import threading
import time
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from core_builders import blank, observations, pilot, settings, with_depth
from hypothesis import given
from hypothesis import settings as budget
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import treadwell
from treadwell import _core
from treadwell._core import Pilot
from treadwell.errors import CoreError, InputError
from treadwell.observation import Frame, Observation

NAN = float("nan")
SETTLED = 90
"""Ticks after which pictures are taken into the map."""


def test_the_core_and_the_package_have_one_version() -> None:
    assert _core.version() == treadwell.__version__


def test_the_package_has_the_documented_doors_and_no_others() -> None:
    assert treadwell.Episode.__module__ == "treadwell.episode"
    assert treadwell.run.__module__ == "treadwell.runner"
    with pytest.raises(AttributeError, match="no attribute 'walk'"):
        treadwell.walk  # noqa: B018


@pytest.mark.parametrize(
    ("navigation", "message"),
    [
        ({"fog": {"cell": 0}}, r"navigation\.fog\.cell must be from 0\.001 to 10, got 0"),
        ({"fog": {"cell": -0.04}}, r"navigation\.fog\.cell must be from 0\.001 to 10, got -"),
        ({"fog": {"sell": 0.04}}, r"navigation\.fog\.sell: unknown field `sell`"),
        ({"fog": {"cell": "wide"}}, r"navigation\.fog\.cell: .*wide"),
        ({"scan_line": {"no": 1}}, r"navigation\.scan_line\.no: unknown field `no`"),
        ({"a_star": {"no": 1}}, r"navigation\.a_star\.no: unknown field `no`"),
        ({"terrain": {"no": 1}}, r"navigation\.terrain\.no: unknown field `no`"),
        ({"terrain": {"room": {"slack": 2}}}, r"navigation\.terrain\.room\.slack must be from 0"),
        ({"walking": {"no": 1}}, r"navigation\.walking\.no: unknown field `no`"),
        ({"odometry": {"no": 1}}, r"navigation\.odometry\.no: unknown field `no`"),
        ({"proprioception": {"no": 1}}, r"navigation\.proprioception\.no: unknown field `no`"),
        ({"ground": {"track_tilt": 0}}, r"navigation\.ground\.track_tilt must be > 0 and < 0\.5"),
        (
            {"averaging": {"rise": 0}, "world_model": "averaging"},
            r"averaging\.rise must be > 0, got 0",
        ),
        ({"self_filter": {"no": 1}}, r"navigation\.self_filter\.no: unknown field `no`"),
        ({"stairs": {"min_edge": 0}}, r"navigation\.stairs\.min_edge must be > 0, got 0"),
        ({"stairs": {"no": 1}}, r"navigation\.stairs\.no: unknown field `no`"),
        ({"stair_climbing": {"no": 1}}, r"navigation\.stair_climbing\.no: unknown field `no`"),
        ({"climbing": {"no": 1}}, r"navigation\.climbing\.no: unknown field `no`"),
        ({"climbing": {"side_room": -1}}, r"navigation\.climbing\.side_room must be >= 0, got -1"),
        (
            {"climbing": {"ascend": {"no": 1}}},
            r"navigation\.climbing\.ascend\.no: unknown .*approach_x",
        ),
        ({"climbing": {"ascend": {"step_min_z": 0}}}, r"climbing\.ascend\.step_min_z must be > 0"),
        (
            {"climbing": {"descend": {"step_max_z": 0}}},
            r"climbing\.descend\.step_max_z must be < 0",
        ),
        (
            {"planner": "b_star"},
            r"navigation\.planner must be one of a_star, voronoi, .*, ara_star, .*, got b_star",
        ),
        (
            {"world_model": "haze"},
            r"navigation\.world_model must be one of fog, averaging, octree, .*, got haze",
        ),
        ({"segmenter": "x"}, r"segmenter must be one of scan_line, .*, ransac, histogram, got x"),
        ({"segmenter": "hough", "hough": {"angle": 0}}, r"\.hough\.angle must be from 0\.03"),
        ({"segmenter": "ransac", "ransac": {"samples": 0}}, r"navigation\.ransac\.samples must"),
        ({"segmenter": "histogram", "histogram": {"bin": 0}}, r"navigation\.histogram\.bin must"),
        (
            {"segmenter": "scan_line_1994", "scan_line_1994": {"strip": 0}},
            r"navigation\.scan_line_1994\.strip must be from 1 to 32, got 0",
        ),
        ({"localizer": "truth"}, r"navigation\.localizer must be one of odometry, .*, got truth"),
        (
            {"localizer": "scan_match", "scan_match": {"offset": 0}},
            r"navigation\.scan_match\.offset must be > 0, got 0",
        ),
        (
            {"behaviour": "x"},
            r"navigation\.behaviour must be one of stair_climbing, continuous, walking, "
            "footsteps, got x",
        ),
    ],
)
def test_a_bad_setting_is_refused_by_its_key(navigation: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        pilot(**navigation)


def test_a_table_of_climbing_may_say_one_thing_only() -> None:
    pilot(climbing={"ascend": {"approach_x": -0.02}})
    pilot(climbing={"descend": {"step_min_z": -0.04}}, stairs={"min_depth": 0.08})


@pytest.mark.parametrize("key", ["robot", "start", "goals", "navigation"])
def test_settings_without_one_of_their_parts_are_refused(key: str) -> None:
    made = settings()
    del made[key]
    with pytest.raises(InputError, match=key):
        Pilot(json.dumps(made))


def test_settings_that_are_no_settings_are_refused() -> None:
    for text in ("", "{", "[]", "null", '{"robot": 1}', json.dumps(settings() | {"x": 1})):
        with pytest.raises(InputError):
            Pilot(text)
    with pytest.raises(InputError, match="goal must be one place or more"):
        Pilot(json.dumps(settings() | {"goals": []}))


@pytest.mark.parametrize(
    ("part", "value", "message"),
    [
        ("joint_positions", np.full(26, NAN), "joint_positions must be finite, got NaN"),
        ("joint_velocities", np.full(26, np.inf), "joint_velocities must be finite, got inf"),
        ("angular_velocity", np.full(3, NAN), "angular_velocity must be finite"),
        ("specific_force", np.full(3, NAN), "specific_force must be finite"),
        ("foot_forces", np.full((2, 4), NAN), "foot_forces must be finite"),
        ("joint_positions", np.zeros(25), "joint_positions must have 26 values, got 25"),
        ("joint_velocities", np.zeros(0), "joint_velocities must have 26 values, got 0"),
        ("angular_velocity", np.zeros(4), "angular_velocity must have 3 values, got 4"),
        ("specific_force", np.zeros(2), "specific_force must have 3 values, got 2"),
        ("foot_forces", np.zeros((4, 2)), r"foot_forces must be \(2, 4\), got \(4, 2\)"),
        (
            "joint_positions",
            np.zeros(26, np.float32),
            "1 axis of float64, got 1 axes of float32",
        ),
        (
            "joint_positions",
            np.zeros((26, 1)),
            "1 axis of float64, got 2 axes of float64",
        ),
        ("joint_positions", None, "joint_positions must be an array.*, got None"),
        ("time_ns", -1, "time_ns must be whole nanoseconds, 0 or more, got -1"),
        ("time_ns", 1.5, "time_ns must be whole nanoseconds, 0 or more, got 1.5"),
        ("depth", Frame(0, 0, blank()[:71]), "a depth image must be 72 x 88, got 71 x 88"),
        ("depth", Frame(0, 0, blank().T), "a depth image must be 72 x 88, got 88 x 72"),
        ("depth", Frame(0, 0, blank()[:0]), "a depth image must be 72 x 88, got 0 x 88"),
        ("depth", Frame(0, 0, blank().ravel()), "depth must be .* 2 axes of float32, got 1 axes"),
        ("depth", Frame(0, 0, np.ones((72, 88))), "got 2 axes of float64"),  # type: ignore[arg-type]
        ("depth", Frame(0, 0, np.ones((72, 88), np.uint16)), "got 2 axes of uint16"),  # type: ignore[arg-type]
        ("depth", "no picture", "exposure_ns"),
        ("depth", Frame(-1, 0, blank()), "exposure_ns must be whole nano"),
    ],
)
def test_a_bad_reading_is_refused_by_its_name_and_changes_nothing(
    part: str, value: object, message: str
) -> None:
    seen = observations()
    core, untouched = pilot(), pilot()
    for observation in seen[:5]:
        core.tick(observation)
        untouched.tick(observation)
    with pytest.raises(CoreError, match=f"observation: .*{message}"):
        core.tick(replace(seen[5], **{part: value}))
    for observation in seen[5:20]:
        assert same(core.tick(observation), untouched.tick(observation))


def same(one: _core.Tick, other: _core.Tick) -> bool:
    return (
        bool((one.positions == other.positions).all())
        and bool((one.torques == other.torques).all())
        and one.estimate == other.estimate
        and one.state == other.state
    )


def test_time_that_does_not_advance_is_refused() -> None:
    seen = observations()
    core = pilot()
    core.tick(seen[0])
    core.tick(seen[1])
    for before in (seen[1], seen[0]):
        with pytest.raises(CoreError, match="observation: time must advance"):
            core.tick(before)
    core.tick(seen[2])


@pytest.mark.parametrize("value", [NAN, 0.0, -1.0, np.inf, -np.inf, 1e-30, 1e30, 0.7, 1.0])
def test_a_picture_of_nothing_is_ignored_and_the_robot_goes_on(value: float) -> None:
    core = pilot()
    for observation in observations():
        frame = observation.depth
        tick = core.tick(observation if frame is None else with_depth(observation, blank(value)))
        assert np.isfinite(tick.positions).all()
        assert tick.outcome is None
    seen = core.view().kind
    far = np.ones_like(seen, dtype=bool)
    far[46:54, 46:54] = False
    if not 0.1 < value < 2.0:
        assert core.frames_used == 0 or not (seen[far] == 2).any()


@budget(max_examples=25, deadline=None)
@given(
    depth=hnp.arrays(
        np.float32,
        (72, 88),
        elements=st.floats(width=32) | st.floats(0.125, 3.0, width=32),
        fill=st.sampled_from([np.float32(NAN), np.float32(0.0), np.float32(0.8)]),
    ),
    exposure_ns=st.integers(0, 2**63),
)
def test_no_picture_whatsoever_is_a_panic(
    depth: np.ndarray[Any, np.dtype[np.float32]], exposure_ns: int
) -> None:
    core = pilot()
    for observation in observations()[:SETTLED]:
        core.tick(observation)
    for observation in observations()[SETTLED : SETTLED + 6]:
        frame = Frame(exposure_ns, observation.time_ns, depth)
        tick = core.tick(replace(observation, depth=frame))
        assert np.isfinite(tick.positions).all()
        assert np.isfinite(tick.estimate).all()


@budget(max_examples=40, deadline=None)
@given(data=st.data())
def test_no_reading_that_is_finite_is_a_panic(data: st.DataObject) -> None:
    """Whatever encoders, gyro and feet say: an answer, or an error with its stage."""
    core = pilot()
    numbers = st.floats(allow_nan=False, allow_infinity=False)
    for observation in observations()[:4]:
        wild = replace(
            observation,
            joint_positions=np.array(data.draw(st.lists(numbers, min_size=26, max_size=26))),
            angular_velocity=np.array(data.draw(st.lists(numbers, min_size=3, max_size=3))),
            specific_force=np.array(data.draw(st.lists(numbers, min_size=3, max_size=3))),
            foot_forces=np.full((2, 4), data.draw(numbers)),
        )
        try:
            core.tick(wild)
        except CoreError:
            return


def test_products_have_the_shapes_and_kinds_that_are_documented() -> None:
    core = pilot()
    for observation in observations():
        tick = core.tick(observation)
    for array in (tick.positions, tick.velocities, tick.torques):
        assert (array.shape, array.dtype) == ((26,), np.float64)
    for pose in (tick.estimate, tick.odometry):
        assert isinstance(pose, tuple)
        assert len(pose) == 4
    planes, view = core.planes(), core.view()
    assert (planes.labels.shape, planes.labels.dtype) == ((6336,), np.uint16)
    assert (planes.points_in_robot.shape, planes.points_in_robot.dtype) == ((6336, 3), np.float32)
    assert (planes.floor_height.shape, planes.floor_height.dtype) == ((6336,), np.float32)
    assert planes.robot_from_camera.shape == (4, 4)
    assert planes.labels.max() <= len(planes.regions)
    assert planes.ground is not None
    support, mean, normal, distance, height = planes.regions[planes.ground]
    assert support > 500
    assert np.dot(mean, normal) == pytest.approx(distance, abs=0.02)
    assert height == pytest.approx(0.0, abs=0.01)
    assert isinstance(view.origin, tuple)
    shape = view.kind.shape
    assert (view.kind.dtype, view.height.dtype, view.sightings.dtype) == (
        np.uint8, np.float32, np.uint16)  # fmt: skip
    assert view.height.shape == view.sightings.shape == shape
    assert set(np.unique(view.kind)) <= {0, 1, 2}
    assert (np.isnan(view.height) == (view.kind == 0)).all()
    path, clearance = core.path(), core.clearance()
    assert path is not None
    assert path.shape[1] == 2
    assert clearance is not None
    assert (clearance.shape, clearance.dtype) == (shape, np.float32)
    assert len(core.timing) == len(Pilot.stages)
    assert core.frames_used > 3


def test_stairs_climbs_and_stepping_are_there_to_look_at() -> None:
    core = pilot()
    assert core.climbs() is None
    for observation in observations():
        core.tick(observation)
    staircase, stepping = core.staircase(), core.stepping
    assert (type(staircase.frames), staircase.stairs) == (int, [])
    assert core.climbs() == []
    assert (stepping.landed, stepping.height_error, stepping.misstep) == (0, 0.0, None)
    with pytest.raises(AttributeError):
        stepping.landed = 1  # type: ignore[misc]


def test_a_staircase_ahead_is_told_edge_by_edge() -> None:
    episode = treadwell.Episode("stairs_up", seed=1, overrides=("time_limit=4",))
    for _ in episode:
        pass
    staircase = episode.pilot.staircase()
    steps = [stair for stair in staircase.stairs if stair.height > 0.015]
    assert staircase.frames > 0
    assert len(steps) >= 2
    for stair in steps:
        left, right = (np.array(end) for end in stair.front)
        assert min(abs(stair.height - 0.03 * i) for i in range(1, 5)) < 0.01
        assert left[2] == pytest.approx(stair.height, abs=0.02)
        assert 0.15 <= np.linalg.norm(left - right) < 0.6
        assert left[1] > right[1]  # for one who comes along +x
        assert stair.depth >= 0.07
        assert 0.4 < stair.reference[0] < 1.4
        assert min(stair.margins) >= 0.0
        assert stair.support > 0
        for fit in (stair.front_fit, stair.back_fit):
            assert fit is None or (fit[0] > 0 and 0.0 <= fit[1] < 0.1 and fit[2] >= 0.0)
    with pytest.raises(AttributeError):
        steps[0].height = 0.1  # type: ignore[misc]


def test_products_are_copies_that_the_next_tick_leaves_alone() -> None:
    core = pilot()
    seen = observations()
    for observation in seen[:20]:
        tick = core.tick(observation)
    view, before = core.view(), tick.positions.copy()
    kind = view.kind.copy()
    tick.positions[:] = 9.0
    for observation in seen[20:]:
        core.tick(observation)
    assert (view.kind == kind).all()
    fresh = pilot()
    for observation in seen[:20]:
        tick = fresh.tick(observation)
    assert (tick.positions == before).all()


def test_other_threads_run_while_the_core_works() -> None:
    """The interpreter's lock is handed over at each tick: else the other never gets it here."""
    core, seen = pilot(), observations()
    turns, done = [0], threading.Event()

    def count() -> None:
        while not done.is_set():
            turns[0] += 1
            time.sleep(0)

    interval = sys.getswitchinterval()
    other = threading.Thread(target=count)
    try:
        sys.setswitchinterval(1000.0)
        other.start()
        before = turns[0]
        for observation in seen:
            core.tick(observation)
        assert turns[0] > before
    finally:
        done.set()
        sys.setswitchinterval(interval)
        other.join()


def test_the_walker_alone_walks_as_it_is_told_and_refuses_what_the_pilot_refuses() -> None:
    walker = _core.Walker(json.dumps(settings()["robot"]))
    for observation in observations():
        positions, velocities, torques = walker.step(observation, (0.1, 0.0, 0.0))
        assert positions.shape == velocities.shape == torques.shape == (26,)
    with pytest.raises(InputError):
        _core.Walker("{}")


def test_an_observation_may_be_any_object_with_its_fields() -> None:
    class Duck:
        def __init__(self, seen: Observation) -> None:
            self.__dict__.update({name: getattr(seen, name) for name in seen.__slots__})

    one, other = pilot(), pilot()
    for observation in observations()[:10]:
        assert same(one.tick(observation), other.tick(Duck(observation)))  # type: ignore[arg-type]
