"""When both feet had made each change of level, by the truth."""

from dataclasses import dataclass
from itertools import pairwise

from treadwell.episode import Episode
from treadwell.trace import Trace


@dataclass(frozen=True, slots=True)
class LevelTimes:
    """What a run's feet did.

    Attributes:
        times: s, simulated, at which both feet had made or passed each step up or down that was
            not taken back, to the camera frame.
    """

    times: tuple[float, ...]

    def intervals(self) -> list[float]:
        """Return the seconds from each change of level to the following."""
        return [after - before for before, after in pairwise(self.times)]


class LevelWatch:
    """Notes the time of each change of level that the judge counts."""

    def __init__(self, episode: Episode) -> None:
        """Watch this episode."""
        self._judge = episode.judge
        self._times: list[float] = []

    def frame(self, trace: Trace) -> None:
        """Take in a camera frame."""
        changes = self._judge.stairs_climbed + self._judge.stairs_descended
        del self._times[changes:]
        self._times += [1e-9 * trace.time_ns] * (changes - len(self._times))

    def findings(self) -> LevelTimes:
        """Return the times."""
        return LevelTimes(tuple(self._times))
