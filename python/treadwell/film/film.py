"""A film of a run: the robot from behind, the map beside it; MP4, or GIF by the file's ending."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from treadwell.errors import InputError, RecordingError
from treadwell.extras import install_hint
from treadwell.files import whole_file
from treadwell.film.follower import Follower, follow
from treadwell.film.plan_panel import PlanPanel
from treadwell.film.poses import TICK_S, RecordedPoses
from treadwell.film.ray_camera import Disc, RayCamera
from treadwell.judging.result import StateEntry, read_result
from treadwell.recording.cut_off import cut_run
from treadwell.recording.map_file import NAME as MAP
from treadwell.recording.map_file import read_map
from treadwell.recording.trajectory import ESTIMATE, TRUTH, read_trajectory

Picture = NDArray[np.uint8]
SUFFIXES: Final = (".mp4", ".gif")
FRAMES_A_SECOND: Final = 10
LONGEST_S: Final = 20.0
"""Seconds that a film lasts at most; a longer run is shown so many times faster."""
_SIZE, _PLAN = (432, 320), (288, 320)
"""Pixels: multiples of 16, which the encoder wants."""


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """What a run's pictures are drawn from.

    Attributes:
        poses: where everything was.
        follower: where the camera is.
        camera: draws.
        goal: x, y and radius, m.
        behaviour: the states, each with the time at which it began.
        ways: (n, 8) the believed and the true trajectory; without rows where one is missing.
    """

    poses: RecordedPoses
    follower: Follower
    camera: RayCamera
    goal: tuple[float, float, float]
    behaviour: Sequence[StateEntry]
    ways: tuple[NDArray[np.float64], NDArray[np.float64]]

    def picture(self, row: int) -> Picture:
        """Return what the following camera sees at a row of the audit."""
        return self.camera.picture(self.poses.set(row), self.follower.eye(row))

    def heading(self, row: int) -> float:
        """Return the true heading of the robot's root, rad."""
        matrix = self.poses.set(row).xmat[self.poses.root()].reshape(3, 3)
        return math.atan2(matrix[1, 0], matrix[0, 0])


def scene_of(folder: Path, size: tuple[int, int] = _SIZE) -> Scene:
    """Return what pictures of a run are drawn from.

    Args:
        folder: the run's.
        size: width and height of a picture, pixels.

    Raises:
        InputError: result or audit are missing or broken, or the run ended before its first tick.
    """
    cut = cut_run(folder)
    told = cut or read_result(folder / "result.json")
    ways = _ways(folder) if cut is None else (cut.estimate, cut.truth)
    poses = RecordedPoses(folder)
    if not poses.count:
        raise InputError(f"{folder / 'physics.npz'}: not one tick was run")
    goal = goal_of(told.configuration, folder, told.scale)
    camera = RayCamera(poses.model, size, Disc(*goal))
    return Scene(poses, follow(poses), camera, goal, told.behaviour, ways)


def _ways(folder: Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return what there is of the trajectories."""
    found = []
    for name in (ESTIMATE, TRUTH):
        try:
            found.append(read_trajectory(folder / name))
        except InputError:
            found.append(np.empty((0, 8)))
    return found[0], found[1]


def goal_of(
    configuration: Mapping[str, Any], folder: Path, scale: float = 1.0
) -> tuple[float, float, float]:
    """Return x, y and radius of the goal, m.

    Args:
        configuration: the run's.
        folder: the run's, for messages.
        scale: what the lengths in the configuration were multiplied by.

    Raises:
        InputError: the configuration has none.
    """
    try:
        goal = configuration["goal"]
        x, y, radius = (scale * float(v) for v in (*goal["position"], goal["radius"]))
    except (KeyError, TypeError, ValueError):
        raise InputError(f"{folder}: its configuration has no goal") from None
    return x, y, radius


def write_film(
    folder: Path, path: Path, progress: Callable[[int, int], None] | None = None
) -> float:
    """Write a film of a run.

    Args:
        folder: the run's.
        path: of the film; `.mp4` or `.gif`.
        progress: is told frames done and frames in all.

    Returns:
        How many times faster than the run the film is.

    Raises:
        InputError: the run lacks what is drawn, or the ending is none of these, or the encoder is
            not installed.
        RecordingError: the film cannot be written.
    """
    encode = _encoder(path)
    scene = scene_of(folder)
    seconds = scene.poses.count * TICK_S
    speed = max(1.0, math.ceil(seconds / LONGEST_S))
    step = round(speed / FRAMES_A_SECOND / TICK_S)
    rows = [*range(0, scene.poses.count, step), scene.poses.count - 1]
    frames = _frames(scene, _plan(folder, scene), rows, speed, progress)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with whole_file(path) as temporary:
            encode(temporary, frames)
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror or error}") from None
    return speed


def _plan(folder: Path, scene: Scene) -> PlanPanel:
    """Return the map's panel, of what is there of it."""
    try:
        surface = read_map(folder / MAP).surface
    except InputError:
        surface = None
    estimate, truth = (way[:, :4] for way in scene.ways)
    return PlanPanel(_PLAN, surface, truth, estimate, scene.goal)


def _frames(
    scene: Scene,
    plan: PlanPanel,
    rows: list[int],
    speed: float,
    progress: Callable[[int, int], None] | None,
) -> Iterator[Picture]:
    font = ImageFont.load_default(15)
    for number, row in enumerate(rows):
        time_s = (row + 1) * TICK_S
        both = np.hstack([scene.picture(row), plan.at(time_s, scene.heading(row))])
        frame = Image.fromarray(both)
        text = f"{time_s:5.1f} s   {state_at(scene.behaviour, time_s)}"
        text += f"   {speed:g} x" if speed > 1.0 else ""
        ImageDraw.Draw(frame).text(
            (10, 8), text, font=font, fill=(20, 22, 28), stroke_width=2, stroke_fill=(240, 242, 245)
        )
        yield np.asarray(frame, np.uint8)
        if progress is not None:
            progress(number + 1, len(rows))


def state_at(behaviour: Sequence[StateEntry], time_s: float) -> str:
    """Return the behaviour's state at a time."""
    states = [entry.state for entry in behaviour if entry.time <= time_s]
    return states[-1] if states else ""


def _encoder(path: Path) -> Callable[[Path, Iterator[Picture]], None]:
    """Return what writes a film with this ending."""
    suffix = path.suffix.lower()
    if suffix == ".gif":
        return _write_gif
    if suffix != ".mp4":
        raise InputError(f"--video: {path}: must end in {' or '.join(SUFFIXES)}")
    try:
        import_module("imageio_ffmpeg")
    except ImportError:
        raise InputError(
            f"--video: an MP4 needs the extra `video`: {install_hint('video')}; "
            "a name that ends in .gif needs nothing"
        ) from None
    return _write_mp4


def _write_mp4(path: Path, frames: Iterator[Picture]) -> None:
    imageio_ffmpeg = import_module("imageio_ffmpeg")
    size = (_SIZE[0] + _PLAN[0], _SIZE[1])
    writer = imageio_ffmpeg.write_frames(
        str(path), size, fps=FRAMES_A_SECOND, quality=6, ffmpeg_log_level="error"
    )
    writer.send(None)
    try:
        for frame in frames:
            writer.send(np.ascontiguousarray(frame))
    finally:
        writer.close()
    if not path.is_file() or path.stat().st_size == 0:
        raise OSError(None, "the encoder wrote nothing")


def _write_gif(path: Path, frames: Iterator[Picture]) -> None:
    palette = None
    pictures = []
    for frame in frames:
        picture = Image.fromarray(frame)
        if palette is None:
            palette = picture.quantize(128)
        # One palette for all: what stands still then does not flicker, and is stored once.
        pictures.append(picture.quantize(palette=palette, dither=Image.Dither.NONE))
    pictures[0].save(
        path,
        save_all=True,
        append_images=pictures[1:],
        duration=round(1000 / FRAMES_A_SECOND),
        loop=0,
        optimize=False,
    )
