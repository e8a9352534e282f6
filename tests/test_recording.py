"""Claims about recording.rrd: what is in it, that it outlives its writer, and what errors say."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from episode_builders import BOX, STEP, World, entities, flight, qrio, shown_as, trace, world

from treadwell.errors import InputError, RecordingError
from treadwell.footstep_plan import FootstepPlan, PlannedFootstep
from treadwell.protocols import Footstep
from treadwell.recording import map_shapes
from treadwell.recording import recorder as recording
from treadwell.recording.file import NAME, cut_to_whole_messages, whole_length
from treadwell.recording.layout import CLIMB, PATH
from treadwell.recording.recorder import Recorder
from treadwell.trace import Sole, SteppingTrace, Trace

FRAME = 80_000_000


@pytest.fixture(scope="module")
def made() -> World:
    return world(STEP + BOX.replace("0.5, 0.0", "0.6, 0.6"))


def recorder(folder: Path, made: World) -> Recorder:
    return Recorder(folder / NAME, made.model, made.course, made.scenario, qrio())


def test_a_recording_holds_world_map_camera_states_and_plots(tmp_path: Path, made: World) -> None:
    writer = recorder(tmp_path, made)
    for i in range(30):
        writer.frame(trace(made, i * FRAME, state="walk" if i < 20 else "search"))
    writer.close()
    found = entities(tmp_path / NAME)
    assert {
        "/world/robot/capsules",
        "/world/course/boxes",
        "/world/points",
        "/world/floor/0_0",
        "/world/obstacles/0_0",
        "/world/path",
        "/world/goal",
        "/world/trajectory/truth",
        "/map/floor",
        "/map/clearance",
        "/camera/depth",
        "/behaviour",
        "/error",
        "/timing",
    } <= found


def test_the_viewer_shows_scenario_robot_and_seed_as_the_recordings_name(
    tmp_path: Path, made: World
) -> None:
    recorder(tmp_path, made).close()
    name = f"{made.scenario.name}-qrio-{made.scenario.seed}"
    assert shown_as(tmp_path / NAME) == ("treadwell", name)


def test_stairs_climbs_landings_and_missteps_are_in_the_recording(
    tmp_path: Path, made: World
) -> None:
    writer = recorder(tmp_path, made)
    step = Footstep("left", 0.1, 0.04, 0.0, 0.03, -0.05, 0.05)
    for i in range(12):
        climbing: dict[str, object] = {
            "stairs": flight(steps_ago=int(i > 6)) if i < 10 else (),
            "climbs": ((1, 2),),
            "soles": (Sole(0.0, 0.04, 0.03, (1.0, 0.0)), Sole(0.0, -0.04, 0.0, (1.0, 0.0))),
            "touch": (i > 4, True),
            "footsteps": (step,) if i > 2 else (),
            "misstep": "no_ground" if i > 8 else None,
        }
        writer.frame(trace(made, i * FRAME, state="climb", **climbing))
    writer.close()
    assert {
        "/world/stairs",
        "/world/stairs/front",
        "/world/stairs/back",
        "/world/stairs/height",
        "/world/soles/planned",
        "/world/soles/landed",
        "/behaviour/misstep",
    } <= entities(tmp_path / NAME)


def test_planned_footsteps_are_drawn_with_the_ground_and_their_cost(
    tmp_path: Path, made: World
) -> None:
    step = PlannedFootstep(
        "left", 0.1, 0.04, 0.3, 0.03, (0.0, 0.0), (-0.05, 0.05), 0.8, "careful", 1.2, 0.1, 0.0, 0.0
    )
    ground = np.full((40, 50), 0.0, np.float32)
    ground[:, 30:] = np.nan
    plan = FootstepPlan((step, step), cost=2.6, whole_cost=9.0)
    writer = recorder(tmp_path, made)
    writer.frame(trace(made, 0))
    none = FootstepPlan((), "none")
    for count, (found, way_out) in enumerate(((plan, (0.3, 0.2)), (none, None))):
        seen = SteppingTrace(found, way_out, count + 1, (-0.2, -0.2), 0.01, ground)
        writer.frame(trace(made, (1 + count) * FRAME, stepping=seen))
    writer.close()
    assert {
        "/world/soles/plan",
        "/map/ground",
        "/map/ground/soles",
        "/map/ground/exit",
        "/footsteps/cost",
    } <= entities(tmp_path / NAME)


def test_a_course_without_stairs_has_none_in_the_recording(tmp_path: Path, made: World) -> None:
    writer = recorder(tmp_path, made)
    writer.frame(trace(made, 0))
    writer.close()
    found = entities(tmp_path / NAME)
    assert not {name for name in found if "stairs" in name or "soles" in name}


def test_walls_are_seen_through(tmp_path: Path) -> None:
    fence = '[[course]]\nkind = "wall"\nfrom = [0.0, 1.0]\nto = [2.0, 1.0]\nheight = 0.6\n'
    writer = recorder(tmp_path, world(fence + STEP))
    writer.close()
    assert {"/world/walls/boxes", "/world/course/boxes"} <= entities(tmp_path / NAME)


def test_a_path_changes_its_colour_and_its_height_where_it_climbs(made: World) -> None:
    height = np.zeros((40, 40), dtype=np.float32)
    height[:, 30:] = 0.03
    seen = trace(
        made,
        0,
        view_kind=np.ones((40, 40), dtype=np.uint8),
        view_height=height,
        path=np.array([[-0.6, 0.0], [0.3, 0.0], [0.5, 0.0], [0.7, 0.0], [5.0, 0.0]]),
        climbs=((1, 2),),
    )
    assert map_shapes.legs(seen) == [
        (slice(0, 2), PATH),
        (slice(1, 3), CLIMB),
        (slice(2, 5), PATH),
    ]
    heights = map_shapes.floor_heights(seen)
    assert heights == pytest.approx([0.0, 0.0, 0.03, 0.03, 0.03])


def test_a_frame_in_which_nothing_was_seen_can_be_recorded(tmp_path: Path, made: World) -> None:
    writer = recorder(tmp_path, made)
    nothing: dict[str, object] = {
        "depth": None,
        "points_in_robot": None,
        "labels": None,
        "map_from_camera": None,
        "clearance": None,
        "path": np.zeros((0, 2)),
        "view_kind": np.zeros((40, 40), dtype=np.uint8),
    }
    writer.frame(trace(made, 0, **nothing))
    writer.frame(trace(made, FRAME, depth=np.full((72, 88), np.nan, dtype=np.float32)))
    writer.close()
    assert "/world/robot/capsules" in entities(tmp_path / NAME)


def test_a_frame_is_recorded_within_a_few_milliseconds(tmp_path: Path, made: World) -> None:
    writer = recorder(tmp_path, made)
    costs = []
    for i in range(40):
        frame: Trace = trace(made, i * FRAME)
        begin = time.perf_counter()
        writer.frame(frame)
        costs.append(time.perf_counter() - begin)
    writer.close()
    assert min(costs) < 0.02  # the best one: others may use the machine meanwhile


ENDLESS = """
import resource, signal, sys
from pathlib import Path
sys.path.insert(0, sys.argv[2])
from test_recording import BOX, FRAME, STEP, Path, recorder, trace, world
from treadwell.errors import RecordingError
made = world(STEP + BOX.replace("0.5, 0.0", "0.6, 0.6"))
writer = recorder(Path(sys.argv[1]), made)
if sys.argv[3] != "0":
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[3]), int(sys.argv[3])))
print("ready", flush=True)
try:
    for i in range(1_000_000):
        writer.frame(trace(made, i * FRAME))
        print(i, flush=True)
except RecordingError as error:
    print("RecordingError", error, flush=True)
    try:
        writer.close()
    except RecordingError:
        print("closed", flush=True)
"""


def endless(folder: Path, limit: int) -> subprocess.Popen[str]:
    """A process that records on and on, into a file of limited size where the limit is not 0."""
    return subprocess.Popen(
        [sys.executable, "-c", ENDLESS, str(folder), str(Path(__file__).parent), str(limit)],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )


@pytest.mark.slow
def test_a_killed_run_leaves_a_recording_that_can_be_read(tmp_path: Path) -> None:
    with endless(tmp_path, 0) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if line.strip() == "60":
                process.send_signal(signal.SIGKILL)
                break
    assert {"/world/robot/capsules", "/camera/depth"} <= entities(tmp_path / NAME)


@pytest.mark.slow
def test_a_full_disk_is_one_clear_error_and_what_was_recorded_can_be_read(tmp_path: Path) -> None:
    with endless(tmp_path, 18_000_000) as process:
        output = process.communicate(timeout=120)[0].splitlines()
    (error,) = [line for line in output if line.startswith("RecordingError")]
    assert NAME in error
    assert "disk is full" in error
    assert "/world/robot/capsules" in entities(tmp_path / NAME)


def test_what_breaks_off_amid_a_message_is_cut_behind_the_last_whole_one(
    tmp_path: Path, made: World
) -> None:
    writer = recorder(tmp_path, made)
    for i in range(40):
        # Without points: most of the file would be one message of them.
        writer.frame(trace(made, i * FRAME, labels=None))
    writer.close()
    path = tmp_path / NAME
    assert whole_length(path) == path.stat().st_size
    whole = path.read_bytes()
    path.write_bytes(whole[: int(0.8 * len(whole))])
    cut_to_whole_messages(path)
    assert whole.startswith(path.read_bytes())
    assert path.stat().st_size > 0.5 * len(whole)
    assert "/world/floor/0_0" in entities(path)


def test_a_recording_that_cannot_be_opened_is_an_error(tmp_path: Path, made: World) -> None:
    with pytest.raises(RecordingError, match=NAME):
        recorder(tmp_path / "nowhere", made)


def test_inspecting_what_is_not_there_says_so(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such run"):
        recording.inspect(tmp_path / "nowhere")
    with pytest.raises(InputError, match="no recording"):
        recording.inspect(tmp_path)


def test_the_viewer_listens_on_this_machine_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / NAME).write_bytes(b"RRF2")
    commands: list[list[str]] = []

    def run(command: list[str], **_: object) -> subprocess.CompletedProcess[bytes]:
        commands.append(command)
        return subprocess.CompletedProcess(command, 0)

    monkeypatch.setattr(recording.subprocess, "run", run)
    recording.inspect(tmp_path)
    recording.inspect(tmp_path, web=True)
    for command in commands:
        assert command[command.index("--bind") + 1] == "127.0.0.1"
        assert command[-1] == str(tmp_path / NAME)
    assert "--web-viewer" in commands[1]


def test_a_viewer_that_fails_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / NAME).write_bytes(b"RRF2")
    failed = subprocess.CompletedProcess([], 101)
    monkeypatch.setattr(recording.subprocess, "run", lambda *_, **__: failed)
    with pytest.raises(RecordingError, match="--web"):
        recording.inspect(tmp_path)
