"""What an experiment may look at in a run beyond its result: the truth beside what the core has."""

from typing import Any, Protocol

from treadwell.episode import Episode
from treadwell.trace import Trace


class Watch(Protocol):
    """Looks at each camera frame of an episode. For scoring alone: the core never hears of it."""

    def __init__(self, episode: Episode) -> None:
        """Watch this episode."""

    def frame(self, trace: Trace) -> None:
        """Take in a camera frame."""

    def findings(self) -> Any:  # noqa: ANN401 - each watch has its own
        """Return what was found; it can be pickled."""
