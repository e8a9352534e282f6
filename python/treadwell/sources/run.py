"""A run of ours: what its depth camera saw, from where the robot believed it to be.

Depth images come from `observations.mcap`, the camera's poses from `recording.rrd`, where each
frame has the pose that the core gave it: the localizer's estimate, with the body's pose at the
exposure and the correction by the ground. `trajectory.tum` has the robot's alone. That estimate is
of the tick at which the frame arrived; where a camera is late, it is moved back to the exposure.
"""

from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from treadwell.errors import InputError
from treadwell.exports.recorded_points import camera_poses
from treadwell.poses import pose_matrix
from treadwell.protocols import Pose
from treadwell.recording.log_file import BrokenLogError
from treadwell.recording.messages import decode_estimate
from treadwell.recording.observation_log import (
    NAME,
    read_answers,
    read_observations,
)
from treadwell.recording.recorded_camera import recorded_camera
from treadwell.sources.frame import Floats, PinholeCamera, RangeFrame


@dataclass(slots=True, eq=False)
class RunSource:
    """A run's depth images.

    Attributes:
        path: the run's folder.
        camera: the robot's.
        poses: map from camera, by the time in ns at which the frame arrived.
        beliefs: the robot's x, y, z m and yaw rad, by the time in ns; filled where it is needed.
        kind: "run".
        unused: reason -> count, of the frames so far.
        notes: what its user should know.
    """

    path: Path
    camera: PinholeCamera
    poses: dict[int, Floats]
    beliefs: dict[int, Pose] = field(default_factory=dict)
    kind: str = "run"
    unused: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)

    @property
    def frames(self) -> int:
        """How many images have a pose, or one more: the last is written again at the end."""
        return len(self.poses)

    def __iter__(self) -> Iterator[RangeFrame]:
        """Yield the images that have a pose; their time is that of the exposure.

        Raises:
            InputError: the log is broken before its first image.
        """
        self.unused.clear()
        self.notes.clear()
        shape, given = (self.camera.height, self.camera.width), 0
        try:
            for observation in read_observations(self.path / NAME):
                frame = observation.depth
                if frame is None:
                    continue
                # The core answers a frame at the tick at which it has it.
                pose = self.poses.get(observation.time_ns)
                if frame.depth.shape != shape:
                    self.unused[f"image that is not {shape[1]}x{shape[0]}"] += 1
                elif pose is None:
                    self.unused["no pose in the recording"] += 1
                else:
                    given += 1
                    pose = self._at_exposure(pose, frame.exposure_ns, observation.time_ns)
                    time = 1e-9 * frame.exposure_ns
                    yield RangeFrame(time, pose, self.camera, frame.depth, None, "picture")
        except BrokenLogError as error:
            if not given:
                raise InputError(str(error)) from None
            self.notes.append(f"{error}; what came before is used")

    def _at_exposure(self, pose: Floats, exposure_ns: int, now_ns: int) -> Floats:
        """Return a camera's pose with the robot where it was believed to be at the exposure."""
        if exposure_ns == now_ns:
            return pose
        if not self.beliefs:
            with suppress(BrokenLogError):
                for _, answer in read_answers(self.path / NAME):
                    belief = decode_estimate(answer)
                    self.beliefs[belief.time_ns] = belief.pose
        if not {exposure_ns, now_ns} <= self.beliefs.keys():
            return pose
        then, now = (pose_matrix(*self.beliefs[time_ns]) for time_ns in (exposure_ns, now_ns))
        moved: Floats = then @ np.linalg.solve(now, pose)
        return moved


def open_run(folder: Path) -> RunSource:
    """Open a run's folder.

    Raises:
        InputError: it was made without a recording, or that is broken.
    """
    told = recorded_camera(folder / NAME)
    column, row = told.centre
    camera = PinholeCamera(told.width, told.height, told.focal, told.focal, column, row)
    return RunSource(folder, camera, camera_poses(folder))
