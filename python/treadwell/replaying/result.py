"""`result.json` of a replay: the keys of a run's, without what only the simulator knows."""

import json
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from treadwell.files import write_text
from treadwell.judging.entries import Count, Table
from treadwell.judging.result import SCHEMA, LocalizationErrors, StateEntry, Timing
from treadwell.summary import ShownReplay


class FirstDifference(Table):
    """The first tick at which core and recording differ, its time s, and in what."""

    tick: Count
    time: float
    what: str


class ReplayFacts(Table):
    """What is said of the replay itself.

    `observations`: control ticks that were replayed. `compared`: those whose recorded answer was
    there to compare with. `changed`: whether settings or components were others than the run's.
    `broken`: why and after what the log breaks off, null where it is whole. `declared`, `reason`:
    what the core declared at last, and why it refused. `error`: what ended the replay early.
    """

    run: str
    observations: Count
    compared: Count
    changed: bool
    broken: str | None = None
    declared: str | None = None
    reason: str | None = None
    error: str | None = None
    first_difference: FirstDifference | None = None
    core_seconds: float = 0.0


class ReplayResult(ShownReplay, Table):
    """The keys of `result.json` that are known without a simulator, and `replay`.

    `localization` is against the truth that the run recorded.
    """

    schema_: Annotated[Literal["treadwell.result/1"], Field(alias="schema")] = SCHEMA
    scenario: str
    robot: str
    seed: int
    version: str
    configuration: dict[str, Any]
    simulated_seconds: float
    wall_seconds: float
    real_time_factor: float
    steps_taken: Count
    replans: Count
    localization: LocalizationErrors | None = None
    behaviour: list[StateEntry]
    timing_ms: dict[str, Timing]
    replay: ReplayFacts

    def document(self) -> dict[str, Any]:
        """Return it as plain data, as in the file."""
        return self.model_dump(mode="json", by_alias=True)

    def write(self, path: Path) -> None:
        """Write the file whole or not at all.

        Raises:
            OSError: the file cannot be written.
        """
        write_text(path, json.dumps(self.document(), indent=2, allow_nan=False) + "\n")
