"""A map from beginning to end: read, feed, and write everything that comes of it."""

from collections.abc import Iterator
from pathlib import Path
from time import perf_counter
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.files import write_text
from treadwell.interruption import Interruption
from treadwell.map_making.landmarks import make_landmark_map
from treadwell.map_making.leaning import Leaning
from treadwell.map_making.made import FrameProgress, MadeMap, stem, title_of, writing
from treadwell.map_making.mapper import Mapper
from treadwell.map_making.placing import sensed
from treadwell.map_making.plan_view import Seen, plan_arrays
from treadwell.map_making.recording import MapRecording
from treadwell.map_making.request import LANDMARKS, TRUTH, MapRequest
from treadwell.map_making.room_labels import RGB, MapLabels
from treadwell.map_making.scan_matched import MatchedScans, no_scans
from treadwell.map_making.static_frames import StaticSource
from treadwell.map_memory import FLOOR, RememberedMap
from treadwell.map_result import MappedSource, MapResult, counted, times
from treadwell.recording.cut_off import RESULT
from treadwell.recording.file import NAME as RECORDING
from treadwell.recording.map_file import NAME as MAP
from treadwell.recording.map_file import PICTURE, write_map
from treadwell.recording.mesh_file import NAME as MESH
from treadwell.recording.mesh_file import write_mesh
from treadwell.recording.run_folder import run_folder
from treadwell.recording.trajectory import ESTIMATE, Trajectory
from treadwell.sources.frame import Floats, RangeFrame
from treadwell.sources.landmark_log import has_landmarks
from treadwell.sources.source import Source, open_source
from treadwell.version import __version__

_SURE: Final = 0.7
"""Of the mean of the pictures' downward directions, the part along an axis that is down."""


def make_map(
    request: MapRequest,
    *,
    out: Path | None = None,
    record: bool = True,
    progress: FrameProgress | None = None,
) -> MadeMap:
    """Make a map of recorded range data and write its folder: the same as `treadwell map`.

    A signal ends it with the frames that it has.

    Args:
        request: what is to be made of which data.
        out: the folder; it must be new or empty. None: a new one in `runs/`.
        record: False leaves out the recording.
        progress: is told how it gets on.

    Raises:
        InputError: anything that the user gave is bad, or no frame can be used; nothing is left.
        RecordingError: a file cannot be written.
    """
    if has_landmarks(request.source):
        if request.localizer != TRUTH:
            raise no_scans(request.localizer, request.source)
        return make_landmark_map(request, out=out, record=record, progress=progress)
    if request.world_model == LANDMARKS:
        raise InputError(
            f"--world-model: found {LANDMARKS}; {request.source} has no ranges and bearings: "
            "a folder with Odometry.dat, Measurement.dat and Barcodes.dat has"
        )
    source: Source = open_source(
        request.source,
        camera=request.camera,
        topics=request.topics,
        pose_within=request.data.pose_within,
    )
    if request.localizer != TRUTH:
        source = MatchedScans(source, request, progress)
    if request.data.leave_out_moving:
        source = StaticSource(source, request)
    frames = iter(source)
    first = next(frames, None)
    if first is None:
        raise InputError(f"{source.path}: no frame can be used{_reasons(source)}")
    mapper = Mapper(request, first)
    with Interruption() as interruption:
        name = f"map-{stem(request.source)}"
        with run_folder(out, name, mapper.world_model, request.seed) as folder, writing(folder):
            making = _Making(mapper, source, folder, progress)
            if request.data.labels:
                making.labels = MapLabels(request, first, mapper.place, source.kind)
            making.recording = _recording(request, mapper, folder) if record else None
            going_on = making.find_usable(first, frames)
        with writing(folder):
            if going_on:
                making.feed(frames, interruption)
            interruption.hold()
            return making.write(request)


class _Making:
    """What is known on the way."""

    def __init__(
        self, mapper: Mapper, source: Source, folder: Path, progress: FrameProgress | None
    ) -> None:
        self._mapper, self._source, self._folder = mapper, source, folder
        self._progress = progress
        self.recording: MapRecording | None = None
        self.labels: MapLabels | None = None
        self._poses: list[tuple[float, Floats]] = []
        self._read = 0
        self._seconds: list[float] = []
        self._interrupted = False
        self._leaning = Leaning()

    def find_usable(self, first: RangeFrame, others: Iterator[RangeFrame]) -> bool:
        """Feed frames up to the first that is used; say whether there are more.

        Raises:
            InputError: none is.
        """
        frame: RangeFrame | None = first
        while frame is not None and not self._insert(frame):
            frame = next(others, None)
        if not self._poses:
            raise InputError(
                f"{self._source.path}: no frame can be used{_reasons(self._source, self._mapper)}"
            )
        return frame is not None

    def feed(self, frames: Iterator[RangeFrame], interruption: Interruption) -> None:
        """Feed the frames to the map, as long as no signal comes."""
        try:
            interruption.check()
            for frame in frames:
                self._insert(frame)
                interruption.check()
        except KeyboardInterrupt:
            self._interrupted = True

    def _insert(self, frame: RangeFrame) -> bool:
        started = perf_counter()
        self._read += 1
        pose = self._mapper.insert(frame)
        if pose is not None:
            self._poses.append((frame.time, pose))
            self._leaning.insert(frame, pose)
            if self.labels is not None:
                self.labels.insert(frame, pose)
            if self.recording is not None:
                self.recording.frame(frame.time, pose, sensed(frame))
        if self._progress is not None:
            passed = self._read + sum(self._source.unused.values())
            self._progress.update(passed, max(self._source.frames, passed), len(self._poses))
        self._seconds.append(perf_counter() - started)
        return pose is not None

    def write(self, request: MapRequest) -> MadeMap:
        """Write map, picture, way and `result.json`."""
        mapper, folder = self._mapper, self._folder
        unused = self._source.unused + mapper.unused
        found, voxels = mapper.map(), mapper.voxels()
        labelled = self._write_labels(request)
        surface = mapper.surface()
        if self.recording is not None:
            if surface is not None:
                self.recording.surface(surface, mapper.place.offset)
            self.recording.finish(found, mapper.place.offset, voxels)
        lines, probability = mapper.lines(), mapper.probability()
        topology = mapper.topology()
        more = plan_arrays(probability, lines) | (topology.arrays() if topology else {}) | labelled
        write_map(folder / MAP, found, voxels, more)
        if surface is not None:
            write_mesh(folder / MESH, surface)
        way = Trajectory()
        for time, pose in self._poses:
            placed = pose.copy()
            placed[:3, 3] += mapper.place.offset
            way.add(round(1e9 * time), placed)
        way.write(folder / ESTIMATE)
        level = self._level(request) or self._leaning.notes(request.data, mapper.place.turn)
        result = MapResult(
            schema="treadwell.map/1",
            version=__version__,
            source=MappedSource(kind=self._source.kind, path=str(request.source)),
            world_model=mapper.world_model,
            localizer=request.localizer,
            robot=mapper.robot,
            seed=request.seed,
            frames=self._read + sum(self._source.unused.values()),
            frames_used=len(self._poses),
            unused=dict(sorted(unused.items())),
            interrupted=self._interrupted,
            cells=counted(found),
            lines=lines,
            places=topology.places() if topology else None,
            matching=self._source.matching if isinstance(self._source, MatchedScans) else None,
            cell=found.cell,
            origin=found.origin,
            settings=mapper.sizes.parameters,
            assumed=mapper.sizes.assumed,
            notes=[*self._source.notes, *level, *self._no_floor(found, level)],
            timing_ms={"map": times(mapper.seconds), "frame": times(self._seconds)},
        )
        self._draw(result, found, folder, Seen(probability, lines, topology))
        write_text(folder / RESULT, result.model_dump_json(indent=2, by_alias=True) + "\n")
        return MadeMap(result, found, folder)

    def _write_labels(self, request: MapRequest) -> dict[str, NDArray[Any]]:
        """Draw and record what is what, where it was asked for; return it as arrays of the map."""
        if self.labels is None:
            return {}
        # Late: matplotlib takes its time.
        from treadwell.map_making.label_picture import PICTURE as LABELS
        from treadwell.map_making.label_picture import draw_labels

        places, labels = self.labels.points()
        title = f"{stem(request.source)} · what is what, in cubes"
        draw_labels(self._folder / LABELS, title, places, labels)
        if self.recording is not None:
            self.recording.labels(places, RGB[labels], self._mapper.place.offset)
        return {"label_places": places, "labels": labels}

    def _draw(
        self,
        result: MapResult,
        found: RememberedMap,
        folder: Path,
        seen: Seen,
    ) -> None:
        # Late: matplotlib takes its time.
        from treadwell.map_making.picture import draw_map

        title = title_of(
            stem(Path(result.source.path)),
            result.world_model,
            (result.frames_used, result.frames),
            result.cell,
        )
        if result.lines is not None:
            title += f" · {result.lines.count} lines hold {result.lines.held:.1%} of the points"
        if result.places is not None:
            title += f" · {result.places.count} places, {len(result.places.ways)} ways, "
            title += f"{result.places.rooms} rooms"
        if result.matching is not None:
            title += f" · {result.localizer}: {result.matching.loops_closed} loops closed between "
            title += f"{result.matching.local_maps} local maps"
        if result.cells.floor == 0:
            title += "".join(f"\n{note}" for note in result.notes)
        known = self._source.kind not in ("cloud", "height image")
        way = np.array([pose[:2, 3] for _, pose in self._poses]) + self._mapper.place.offset[:2]
        shown = way if known else way[:0]
        if self._mapper.is_plan:
            from treadwell.map_making.plan_picture import draw_plan

            draw_plan(folder / PICTURE, title, found, seen, shown)
            return
        draw_map(folder / PICTURE, title, found, shown)

    def _level(self, request: MapRequest) -> list[str]:
        """Return a note where pictures were not taken upright, with the axis that may be up."""
        if request.data.up != "z" or not self._mapper.sees_pictures:
            return []
        mean = np.mean([pose[:3, 1] for _, pose in self._poses], axis=0)
        axis = int(np.abs(mean).argmax())
        if np.abs(mean[axis]) < _SURE or (axis, mean[axis] < 0.0) == (2, True):
            return []
        up = f"{'-' if mean[axis] > 0 else ''}{'xyz'[axis]}"
        return [f"the pictures were taken with the world's {up} up, not z: --set map.up={up}"]

    def _no_floor(self, found: RememberedMap, level: list[str]) -> list[str]:
        """Return a note where pictures showed no floor at all, which is seldom what was wanted."""
        if not self._mapper.sees_pictures or level or (found.kind == FLOOR).any():
            return []
        return ["no cell is floor: no level surface was seen"]


def _recording(request: MapRequest, mapper: Mapper, folder: Path) -> MapRecording:
    return MapRecording(folder / RECORDING, stem(request.source), mapper.sizes.cell)


def _reasons(source: Source, mapper: Mapper | None = None) -> str:
    counts = source.unused + (mapper.unused if mapper is not None else type(source.unused)())
    told = ", ".join(f"{reason}: {count}" for reason, count in counts.most_common())
    return f" ({told})" if told else ""
