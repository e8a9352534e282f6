"""What a replay leaves behind: trajectories, the map and its picture, and `result.json`."""

from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError, RecordingError
from treadwell.recording.map_file import NAME as MAP
from treadwell.recording.map_file import PICTURE, write_map
from treadwell.recording.trajectory import ESTIMATE, TRUTH
from treadwell.replaying.findings import Findings
from treadwell.replaying.result import ReplayResult
from treadwell.scenario.model import Scenario


def write_folder(
    folder: Path,
    scenario: Scenario,
    result: ReplayResult,
    found: Findings,
    voxels: NDArray[np.float32],
) -> None:
    """Write everything, `result.json` last; the picture where MuJoCo and the robot are there.

    Args:
        folder: the replay's.
        scenario: as it was replayed.
        result: of the replay.
        found: on its way.
        voxels: (n, 4) m: middle and side of each occupied cube.

    Raises:
        RecordingError: the folder cannot be written.
    """
    try:
        found.estimate.write(folder / ESTIMATE)
        found.truth.write(folder / TRUTH)
        write_map(folder / MAP, found.memory.map(), voxels)
        with suppress(ImportError, InputError):
            _draw(folder / PICTURE, scenario, result, found)
        result.write(folder / "result.json")
    except OSError as error:
        raise RecordingError(f"{folder}: cannot be written: {error.strerror or error}") from error


def _draw(path: Path, scenario: Scenario, result: ReplayResult, found: Findings) -> None:
    # Late: a replay needs no MuJoCo, which builds the course.
    from treadwell.course.build import build_course
    from treadwell.recording.map_picture import Caption, draw_map
    from treadwell.recording.step_memory import StepMemory
    from treadwell.recording.steppable import step_limits
    from treadwell.robot.load import load_robot

    robot = load_robot(scenario.robot)
    course = build_course(scenario, robot)
    title = f"{result.scenario} · {result.robot} · seed {result.seed}"
    title += f"\nreplay of {result.simulated_seconds:.1f} s"
    caption = Caption(title, result.configuration["goal"])
    found.stairs.limits = step_limits(scenario, robot)
    sole = robot.file.legs.left.sole
    soles = (StepMemory(), (sole.length, sole.width))
    remembered = found.memory.map()
    draw_map(path, course, caption, remembered, found.estimate, found.truth, found.stairs, soles)
