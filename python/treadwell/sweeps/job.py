"""One episode of a sweep as it is done in a worker process."""

from dataclasses import dataclass
from pathlib import Path

from treadwell.episode import Episode
from treadwell.runner import play_episode, run_episode
from treadwell.solving.solvable import is_solvable
from treadwell.sweeps.request import Key
from treadwell.sweeps.row import Row, make_row


@dataclass(frozen=True, slots=True)
class Job:
    """An episode to do.

    Attributes:
        key: which.
        file: the scenario's.
        robot: as the user gave it; None: the file's.
        settings: `KEY=VALUE` each.
        folder: for the recording; None: nothing is written.
        check: only build it, to find out whether what the user gave is good.
    """

    key: Key
    file: Path
    robot: str | None
    settings: tuple[str, ...]
    folder: Path | None = None
    check: bool = False


def do(job: Job) -> Row | None:
    """Run an episode and return its row; None of one that was only checked.

    Raises:
        InputError: it cannot be built.
        RecordingError: its folder cannot be written.
    """
    episode = Episode(job.file, robot=job.robot, seed=job.key.seed, overrides=job.settings)
    if job.check:
        return None
    if job.folder is None:
        result = play_episode(episode)
    else:
        result = run_episode(episode, out=job.folder).result
    frame = episode.judge.frame
    return make_row(
        job.key,
        result,
        episode.scenario,
        (frame.x, frame.y, frame.z),
        solvable=is_solvable(episode.scenario, episode.course, episode.robot),
    )
