"""A map of landmarks from ranges, bearings and odometry, with the robot's way among them."""

import json
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter
from typing import Final

import numpy as np

from treadwell._core import FastSlam
from treadwell.errors import InputError
from treadwell.files import write_text
from treadwell.interruption import Interruption
from treadwell.map_making.made import FrameProgress, MadeMap, stem, writing
from treadwell.map_making.recording import MapRecording
from treadwell.map_making.request import LANDMARKS, MapRequest
from treadwell.map_memory import RememberedMap
from treadwell.map_result import MappedLandmark, MappedSource, MapResult, counted, times
from treadwell.poses import pose_matrix
from treadwell.recording.cut_off import RESULT
from treadwell.recording.file import NAME as RECORDING
from treadwell.recording.map_file import NAME as MAP
from treadwell.recording.map_file import PICTURE, write_map
from treadwell.recording.run_folder import run_folder
from treadwell.recording.trajectory import ESTIMATE, Trajectory
from treadwell.sources.frame import Floats
from treadwell.sources.landmark_log import LandmarkLog, Look, open_landmark_log
from treadwell.version import __version__

_MARK_M: Final = 0.1
"""Size of what stands for a point in the recording."""
_LEAST_SURVEYED: Final = 3
"""Two points always fit but for their distance."""
_TOLD_FROM: Final = 0.05
"""By how much odometry must be wrong, of what it says, for a note."""


def make_landmark_map(
    request: MapRequest, *, out: Path | None, record: bool, progress: FrameProgress | None
) -> MadeMap:
    """Make a map of landmarks and write its folder; arguments and errors as of `make_map`."""
    if request.world_model not in (None, LANDMARKS):
        raise InputError(
            f"--world-model: found {request.world_model}; of ranges and bearings a map is made by "
            f"{LANDMARKS}"
        )
    if request.camera is not None or request.topics:
        raise InputError("--camera, --topic: ranges and bearings have no use for them")
    log = open_landmark_log(request.source, request.data.robots)
    if not log.looks:
        told = ", ".join(f"{reason}: {count}" for reason, count in log.unused.most_common())
        raise InputError(f"{log.path}: no reading can be used{f' ({told})' if told else ''}")
    making = _Making(request, log)
    with Interruption() as interruption:
        name = f"map-{stem(request.source)}"
        with run_folder(out, name, LANDMARKS, request.seed) as folder, writing(folder):
            recording = (
                MapRecording(folder / RECORDING, stem(request.source), _MARK_M) if record else None
            )
        with writing(folder):
            making.feed(interruption, recording, progress)
            interruption.hold()
            return making.write(folder, recording)


class _Making:
    """What is known on the way."""

    def __init__(self, request: MapRequest, log: LandmarkLog) -> None:
        self._request, self._log = request, log
        self._settings = {key: dict(table) for key, table in request.landmarks.items()}
        self._settings.setdefault("fast_slam", {}).setdefault("seed", request.seed)
        self._slam = FastSlam(json.dumps(self._settings))
        self._way: list[tuple[float, tuple[float, float, float]]] = []
        self._used = 0
        self._seconds: list[float] = []
        self._interrupted = False

    def feed(
        self,
        interruption: Interruption,
        recording: MapRecording | None,
        progress: FrameProgress | None,
    ) -> None:
        """Feed odometry and looks, as long as no signal comes."""
        unused = sum(self._log.unused.values())
        try:
            for look in self._moved_looks():
                self._slam.see(look.readings, look.names)
                x, y, yaw = self._slam.pose()
                self._way.append((look.time, (x, y, yaw)))
                self._used += len(look.names)
                if recording is not None:
                    recording.frame(look.time, pose_matrix(x, y, 0.0, yaw), _points(look))
                if progress is not None:
                    progress.update(self._used + unused, self._log.frames, self._used)
                interruption.check()
        except KeyboardInterrupt:
            self._interrupted = True

    def _moved_looks(self) -> Iterator[Look]:
        """Yield the looks, the filter moved up to each; the clock of the core runs meanwhile."""
        rows = self._log.odometry
        now, row, speed = float(rows[0, 0]), 0, (0.0, 0.0)
        for look in self._log.looks:
            started = perf_counter()
            while row < len(rows) and rows[row, 0] <= look.time:
                now = self._move(now, float(rows[row, 0]), speed)
                speed = (float(rows[row, 1]), float(rows[row, 2]))
                row += 1
            now = self._move(now, look.time, speed)
            yield look
            self._seconds.append(perf_counter() - started)

    def _move(self, now: float, until: float, speed: tuple[float, float]) -> float:
        passed = until - now
        if passed <= 0.0:
            return now
        self._slam.advance(speed[0] * passed, 0.0, speed[1] * passed, passed)
        return until

    def write(self, folder: Path, recording: MapRecording | None) -> MadeMap:
        """Write map, picture, way and `result.json`."""
        found = [
            MappedLandmark(
                x=x, y=y, covariance=spread, name=name, probability=sure, readings=readings
            )
            for (x, y), spread, name, sure, readings in self._slam.landmarks()
        ]
        table = _table(found)
        empty = RememberedMap(
            (0.0, 0.0),
            0.0,
            np.zeros((0, 0), np.uint8),
            np.zeros((0, 0), np.float32),
            np.zeros((0, 0), np.uint16),
        )
        cubes = np.zeros((0, 4), np.float32)
        if recording is not None:
            recording.landmarks(table)
            recording.finish(empty, np.zeros(3), cubes)
        write_map(folder / MAP, empty, cubes, {"landmarks": table})
        way = Trajectory()
        for time, (x, y, yaw) in self._way:
            way.add(round(1e9 * time), pose_matrix(x, y, 0.0, yaw))
        way.write(folder / ESTIMATE)
        surveyed, error = _surveyed(found, self._log.surveyed)
        result = self._result(found, empty).model_copy(update={"landmark_error": error})
        self._draw(result, table, surveyed, folder)
        write_text(folder / RESULT, result.model_dump_json(indent=2, by_alias=True) + "\n")
        return MadeMap(result, empty, folder)

    def _result(self, found: list[MappedLandmark], empty: RememberedMap) -> MapResult:
        return MapResult(
            schema="treadwell.map/1",
            version=__version__,
            source=MappedSource(kind=self._log.kind, path=str(self._request.source)),
            world_model=LANDMARKS,
            robot=None,
            seed=self._request.seed,
            frames=self._used + sum(self._log.unused.values()),
            frames_used=self._used,
            unused=dict(sorted(self._log.unused.items())),
            interrupted=self._interrupted,
            cells=counted(empty),
            landmarks=found,
            cell=empty.cell,
            origin=empty.origin,
            settings={LANDMARKS: self._settings},
            assumed={},
            notes=self._notes(),
            timing_ms={"map": times(self._seconds), "frame": times(self._seconds)},
        )

    def _notes(self) -> list[str]:
        """Return what was found out about the odometry."""
        notes = []
        names = ("ways", "turns to the left", "turns to the right")
        for name, (scale, sd) in zip(names, self._slam.scales(), strict=True):
            if abs(scale - 1.0) > max(_TOLD_FROM, 3.0 * sd):
                notes.append(f"{name} are {scale:.2f} of what odometry says")
        return notes

    def _draw(self, result: MapResult, table: Floats, surveyed: Floats, folder: Path) -> None:
        # Late: matplotlib takes its time.
        from treadwell.map_making.landmark_picture import draw_landmarks

        title = f"{stem(Path(result.source.path))} · {LANDMARKS} · "
        title += f"{result.frames_used} of {result.frames} readings"
        if result.landmark_error is not None:
            title += f"\n{1e3 * result.landmark_error:.0f} mm from where they were surveyed"
        way = np.array([pose[:2] for _, pose in self._way])
        draw_landmarks(folder / PICTURE, title, table, (way, surveyed))


def _points(look: Look) -> "np.ndarray[tuple[int, int], np.dtype[np.float32]]":
    """Return where a look's readings lie, (n, 3) m in the robot's frame."""
    distance, bearing = look.readings.T
    ends = [distance * np.cos(bearing), distance * np.sin(bearing), np.zeros(len(distance))]
    points: np.ndarray[tuple[int, int], np.dtype[np.float32]] = np.stack(ends, axis=1).astype(
        np.float32
    )
    return points


def _surveyed(
    found: list[MappedLandmark], surveyed: dict[int, tuple[float, float]]
) -> tuple[Floats, float | None]:
    """Return surveyed places (n, 2) m, turned and shifted onto the map, and its error, m."""
    pairs = [
        ((one.x, one.y), surveyed[one.name])
        for one in found
        if one.name is not None and one.name in surveyed
    ]
    if len(pairs) < _LEAST_SURVEYED:
        return np.zeros((0, 2)), None
    here, there = np.array(pairs).swapaxes(0, 1)
    middle, off = here.mean(axis=0), there - there.mean(axis=0)
    near = here - middle
    cross = (off[:, 0] * near[:, 1] - off[:, 1] * near[:, 0]).sum()
    angle = np.arctan2(cross, (off * near).sum())
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    placed = off @ turn.T
    error = float(np.sqrt(((placed - near) ** 2).sum(axis=1).mean()))
    return placed + middle, error


def _table(found: list[MappedLandmark]) -> Floats:
    """Return landmarks as rows, (n, 7), as `map.npz` has them."""
    rows = [
        (
            one.x,
            one.y,
            *one.covariance,
            one.probability,
            np.nan if one.name is None else one.name,
        )
        for one in found
    ]
    return np.array(rows, dtype=np.float64).reshape(-1, 7)
