"""Which episodes a sweep is asked for, on the command line or in Python."""

import math
import shlex
from dataclasses import dataclass
from pathlib import Path

from treadwell.errors import InputError
from treadwell.sweeps.conduct import GIGABYTE, Care
from treadwell.sweeps.request import Request, crossed
from treadwell.sweeps.suite import find_suite


@dataclass(frozen=True, slots=True)
class Asked:
    """Which episodes are asked for, as the options of the command line say it."""

    scenarios: tuple[str, ...]
    suite: str | None
    episodes: int | None
    first_seed: int
    robot: str | None
    settings: tuple[str, ...]
    vary: tuple[str, ...]

    @property
    def name(self) -> str:
        """What a folder is called after."""
        return self.suite or Path(self.scenarios[0]).stem

    @property
    def command(self) -> str:
        """What asks for the same again, but for the folder."""
        words = ["treadwell", "sweep", *self.scenarios]
        words += ["--suite", self.suite] if self.suite else []
        words += ["--episodes", str(self.episodes)] if self.episodes is not None else []
        words += ["--first-seed", str(self.first_seed)] if self.first_seed else []
        words += ["--robot", self.robot] if self.robot else []
        words += [word for setting in self.settings for word in ("--set", setting)]
        words += [word for one in self.vary for word in ("--vary", one)]
        return shlex.join(words)

    def request(self) -> Request:
        """Return the sweep.

        Raises:
            InputError: what was given is bad, or does not go together.
        """
        if self.suite is not None:
            if self.scenarios or self.episodes is not None or self.first_seed or self.robot:
                raise InputError(
                    "--suite: a suite has its scenarios, seeds and robots; only --set and --vary "
                    "go with it"
                )
            return find_suite(self.suite).request(self.settings, self.vary)
        if not self.scenarios:
            raise InputError("sweep: there is no scenario; name one or more, or --suite NAME")
        if self.episodes is None:
            raise InputError("sweep: --episodes N is missing")
        seeds = range(self.first_seed, self.first_seed + self.episodes)
        return crossed(
            self.scenarios,
            seeds=seeds,
            robot=self.robot,
            settings=self.settings,
            vary=self.vary,
        )


def care(timeout_s: float, memory_gb: float, keep: int) -> Care:
    """Return how episodes are treated.

    Raises:
        InputError: a limit is no number.
    """
    if math.isnan(timeout_s) or math.isnan(memory_gb):
        raise InputError("--timeout, --memory: found nan; must be a number")
    return Care(timeout_s, int(memory_gb * GIGABYTE), keep)
