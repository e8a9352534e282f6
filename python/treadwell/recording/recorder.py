"""The recording for people: what the robot saw, believed and did, written as it happens."""

import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell._core import Octree
from treadwell.course.course import Course
from treadwell.course.pieces import bounds
from treadwell.errors import InputError, RecordingError
from treadwell.recording.file import NAME, cut_to_whole_messages, room
from treadwell.recording.quiet import first_import
from treadwell.robot.load import Robot
from treadwell.scenario.model import Scenario
from treadwell.trace import Trace

if TYPE_CHECKING:
    from treadwell.recording.shapes import Shapes

_FRAMES_A_BATCH: Final = 48
"""Camera frames, about four seconds, that are written at a time; then the file is looked at."""
_LONGEST_WAIT: Final = 0.3
"""Seconds of the clock after which frames are written before there are so many."""
_FLUSH_SECONDS: Final = 10.0
_SPARE_BYTES: Final = 16_000_000
"""Room that must be left for what is logged between two looks."""
_LEGS_M: Final = 0.15
"""Height of what is looked at above the ground: about the robot's knees."""
_WALLS: Final = 0.35
"""Opacity of walls: what happens behind them is to be seen."""
_ABANDONED: Final[list[object]] = []


class Recorder:
    """Writes `recording.rrd`. What was written stays readable whatever happens later."""

    def __init__(
        self,
        path: Path,
        model: mujoco.MjModel,
        course: Course,
        scenario: Scenario,
        robot: Robot,
        static_map: Octree | None = None,
    ) -> None:
        """Open the file and draw what never moves.

        Args:
            path: of the file, in a folder that exists.
            model: the compiled course with the robot in it.
            course: what stands where.
            scenario: for goal and name.
            robot: for its root link.
            static_map: what the robot knows of the place beforehand.

        Raises:
            RecordingError: the file cannot be opened.
        """
        # Late, because rerun takes a second to import.
        with first_import():
            import rerun as rr

        from treadwell.recording.frame_log import FrameLog
        from treadwell.recording.layout import blueprint
        from treadwell.recording.products import Products
        from treadwell.recording.shapes import Shapes, robot_geoms
        from treadwell.recording.volumes import Volumes

        self._path = path
        self._broken = False
        self._bodies: list[tuple[NDArray[np.float64], NDArray[np.float64]]] = []
        """Places and turns of all bodies at each frame that waits."""
        top = max((t.height for _, t in course.tops()), default=0.0)
        begin = (*course.start.position, course.start.height)
        centre, extent = _middle_and_extent(scenario, course)
        name = f"{scenario.name}-{robot.name}-{scenario.seed}"
        try:
            path.touch()
            self._check_room()
            self._stream = rr.RecordingStream(
                "treadwell",
                recording_id=name,
                send_properties=False,
            )
            views = blueprint(
                centre,
                extent,
                feet=begin if top > 0.0 else None,
                maps=static_map is not None,
                footsteps=scenario.navigation.behaviour == "footsteps",
            )
            # A table of contents would take memory, 14 kB with each batch of each entity.
            self._stream.save(path, views, write_footer=False)
            self._stream.send_recording_name(name)
        except (OSError, RuntimeError) as error:
            raise RecordingError(f"{path}: cannot be written: {_reason(error)}") from error
        self._stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._robot = Shapes(model, robot_geoms(model, robot.root), "world/robot")
        self._robot.draw(self._stream)
        self._movable = self._draw_course(model, course)
        self._draw_goal(scenario, course)
        sole = robot.file.legs.left.sole
        self._rows = FrameLog(self._stream)
        low, high = -0.05, max(0.05, top + 0.01)
        self._products = Products(self._rows, low=low, high=high, sole=(sole.length, sole.width))
        self._volumes = Volumes(self._rows, static_map, (low, high))
        self._check()

    def frame(self, trace: Trace) -> None:
        """Write one camera frame; after an error nothing more.

        Raises:
            RecordingError: the file does not take it any more.
        """
        if self._broken:
            return
        self._rows.begin(trace.time_ns)
        self._bodies.append((trace.body_positions, trace.body_orientations))
        self._products.log(trace)
        self._volumes.log(trace)
        if self._rows.frames >= _FRAMES_A_BATCH or self._rows.waiting_seconds > _LONGEST_WAIT:
            self._check()

    def close(self) -> None:
        """Write what is left and close the file. After an error there is nothing left to do.

        Raises:
            RecordingError: not all of it could be written.
        """
        if self._broken:
            return
        self._check()
        self._stream.disconnect()

    def _check(self) -> None:
        """Find out whether what was logged is in the file: `log` itself says nothing."""
        try:
            # Rerun's writer can hang where a disk is full, so it is stopped before that.
            try:
                self._check_room()
            except RecordingError:
                self._broken = True
                self._stream.disconnect()
                raise
            self._send()
            self._stream.flush(timeout_sec=_FLUSH_SECONDS)
            _ = self._path.stat()
        except (OSError, RuntimeError, ValueError) as error:
            self._abandon()
            raise RecordingError(
                f"{self._path}: writing failed, what was recorded before stays readable: "
                f"{_reason(error)}"
            ) from error

    def _send(self) -> None:
        """Hand over the frames that wait."""
        if self._bodies:
            places, turns = (np.array(values) for values in zip(*self._bodies, strict=True))
            self._bodies.clear()
            for shapes in (self._robot, self._movable):
                for entity, kind, fields in shapes.posed(places, turns):
                    self._rows.log_all(entity, kind, **fields)
        self._rows.send()

    def _check_room(self) -> None:
        """Find out whether there is room for what comes until the next look.

        Raises:
            RecordingError: there is not.
            OSError: the file is gone.
        """
        left = room(self._path)
        if left < _SPARE_BYTES:
            raise RecordingError(
                f"{self._path}: the disk is full, or the file as large as it may be: "
                f"{left / 1e6:.1f} MB are left, and {(_SPARE_BYTES - left) / 1e6:.1f} MB more are "
                "needed to go on; what was recorded before stays readable"
            )

    def _abandon(self) -> None:
        """Touch a stream whose writer has failed no more: to flush or to end it could hang."""
        import atexit

        import rerun as rr

        self._broken = True
        _ABANDONED.append(self._stream)
        atexit.unregister(rr.rerun_shutdown)
        cut_to_whole_messages(self._path)

    def _draw_course(self, model: mujoco.MjModel, course: Course) -> "Shapes":
        """Draw what stands still, and return what may move."""
        from treadwell.recording.shapes import Shapes

        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        fixed = [e for e in course.elements if e.mocap_id is None]
        walls = [g for e in fixed if e.kind == "wall" for g in e.geom_ids]
        others = [g for e in fixed if e.kind != "wall" for g in (*e.geom_ids, *e.soft_ids)]
        moving = [g for e in course.elements if e.mocap_id is not None for g in e.geom_ids]
        for name, geoms, opacity in (("course", others, 1.0), ("walls", walls, _WALLS)):
            ids = np.array(geoms, dtype=np.intp)
            shapes = Shapes(model, ids, f"world/{name}", opacity=opacity)
            shapes.draw(self._stream)
            for entity, kind, fields in shapes.posed(data.xpos[None], data.xquat[None]):
                still = {name: values[0] for name, values in fields.items()}
                self._stream.log(entity, kind.from_fields(**still), static=True)
        movable = Shapes(model, np.array(moving, dtype=np.intp), "world/movable")
        movable.draw(self._stream)
        return movable

    def _draw_goal(self, scenario: Scenario, course: Course) -> None:
        import rerun as rr

        from treadwell.recording.layout import GOAL

        radius = scenario.goal.radius
        discs = [*scenario.goal.via, scenario.goal.position]
        heights = [*course.height_at(np.array(discs))[:-1], course.goal_height]
        self._stream.log(
            "world/goal",
            rr.Cylinders3D(
                lengths=[0.004] * len(discs),
                radii=[radius] * len(discs),
                centers=[(x, y, z + 0.004) for (x, y), z in zip(discs, heights, strict=True)],
                colors=[GOAL] * len(discs),
                fill_mode=rr.components.FillMode.Solid,
            ),
            static=True,
        )


def inspect(run_dir: Path, *, web: bool = False) -> None:
    """Open a run's recording in rerun's viewer, which listens on this machine only.

    Args:
        run_dir: a run's folder.
        web: in a browser instead of a window; returns when the viewer is ended.

    Raises:
        InputError: the run has no recording.
        RecordingError: the viewer cannot be started.
    """
    path = run_dir / NAME
    if not run_dir.is_dir():
        raise InputError(f"{run_dir}: there is no such run")
    if not path.is_file() or path.stat().st_size == 0:
        raise InputError(f"{path}: the run has no recording (was it run with --no-record?)")
    command = [sys.executable, "-m", "rerun", "--bind", "127.0.0.1", str(path)]
    if web:
        command.insert(-1, "--web-viewer")
    try:
        status = subprocess.run(command, check=False).returncode
    except OSError as error:
        raise RecordingError(f"the viewer cannot be started: {_reason(error)}") from error
    if status:
        raise RecordingError(
            f"the viewer ended with status {status}; where there is no display, use --web"
        )


def _middle_and_extent(
    scenario: Scenario, course: Course
) -> tuple[tuple[float, float, float], float]:
    """Return what the first view looks at, world m, and the diagonal of all that it holds, m.

    That is the middle of the way's stops and of what stands there as seen from above, at the
    robot's knees, half way between the levels of start and goal.
    """
    goal = scenario.goal
    stops = np.array([course.start.position, *goal.via, goal.position])
    pieces = [piece for one in course.elements if one.present for piece in one.pieces]
    low, high = bounds(pieces, stops)
    x, y = (0.5 * (low + high)).tolist()
    height = 0.5 * (course.start.height + course.goal_height) + _LEGS_M
    return (x, y, height), float(np.linalg.norm(high - low))


def _reason(error: Exception) -> str:
    return " ".join(str(getattr(error, "strerror", None) or error).split())
