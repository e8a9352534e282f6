"""A sweep from Python: the same as `treadwell sweep`, with its rows as an Arrow table."""

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from treadwell.errors import InputError
from treadwell.recording.run_folder import sweep_folder
from treadwell.scenario.messages import shown
from treadwell.scenario.overrides import Overrides, plain_number
from treadwell.scenario.values import flag
from treadwell.sweeps.asked import Asked, care
from treadwell.sweeps.conduct import Progress, conduct
from treadwell.sweeps.engine import Engine, local_engine
from treadwell.sweeps.row import row_of
from treadwell.sweeps.settings import Vary, setting_texts, vary_texts
from treadwell.sweeps.summary import summary_table
from treadwell.sweeps.table import rows_table

if TYPE_CHECKING:
    import pyarrow as pa

ENGINES = ("local", "ray")


@dataclass(frozen=True, slots=True, repr=False)
class Sweep:
    """What came of a sweep.

    Attributes:
        folder: where everything lies.
        document: as in `results.json`.
        notes: a sentence on each class that was edited since the sweep began, and on each setting
            that changed nothing.
    """

    folder: Path
    document: dict[str, Any]
    notes: tuple[str, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether every episode was a success."""
        return bool(self.document["passed"])

    def table(self) -> "pa.Table":
        """Return the episodes as an Arrow table, a row each, as `episodes.parquet` has them."""
        return rows_table([row_of(row) for row in self.document["episodes"]])

    def __repr__(self) -> str:
        episodes = self.document["episodes"]
        good = sum(row["success"] for row in episodes)
        return f"<Sweep {self.folder}: {good} of {len(episodes)} episodes succeeded>"

    def _repr_html_(self) -> str:
        return summary_table(self.document, f"Sweep {self.folder}", self.notes).html()


def sweep(  # noqa: PLR0913 - one an option
    scenarios: str | Path | Sequence[str | Path] = (),
    *,
    episodes: int | None = None,
    first_seed: int = 0,
    suite: str | Path | None = None,
    vary: Vary = (),
    overrides: Overrides = (),
    robot: str | Path | None = None,
    workers: int | None = None,
    engine: Literal["local", "ray"] = "local",
    timeout: float = 600.0,
    memory: float = 4.0,
    keep: int = 3,
    out: str | Path | None = None,
    user_code: bool = True,
    progress: Progress | None = None,
    **components: type | str,
) -> Sweep:
    """Run many episodes, side by side: the same as `treadwell sweep`.

    The same call with the same `out` goes on where it was stopped, with more episodes as well; what
    ran with a class that was edited since runs again.

    Args:
        scenarios: a name or a path, or several.
        episodes: seeds of each, from `first_seed` on.
        first_seed: the first of them.
        suite: a frozen list of episodes instead of scenarios and seeds.
        vary: a variant for each value: `KEY=A,B,C` each, or a mapping of keys to values, among
            which may be classes.
        overrides: settings `KEY=VALUE` for all, or a mapping of keys to values.
        robot: its name or folder, instead of the scenarios'.
        workers: episodes at a time; None: as many as there are cores.
        engine: `local`, this machine, or `ray`, a cluster.
        timeout: s, of the clock, that one may take.
        memory: GB that one may take.
        keep: so many first seeds of each line are recorded and kept even where all goes well.
        out: the folder; None: a new one in `runs/`.
        user_code: False: a scenario that names a Python class is refused.
        progress: is told how it gets on.
        components: classes of the user's by slot, as in `planner=MyPlanner`. Each episode makes its
            own in another process, which finds the class by module and name: one that is defined in
            a notebook, or in the program that runs, is refused.

    Returns:
        The results: `table()` has a row for each episode.

    Raises:
        InputError: anything that was given is bad; nothing was run.
        RecordingError: the folder cannot be written; what was done before is kept.

    Example:
        >>> import treadwell
        >>> maps = treadwell.sweep(  # doctest: +SKIP
        ...     ["slalom", "doorway"],
        ...     episodes=20,
        ...     vary={"navigation.world_model": ["fog", "averaging"]},
        ...     out="runs/maps",
        ... )
        >>> maps.table().column("success")  # doctest: +SKIP
    """
    named = [scenarios] if isinstance(scenarios, str | Path) else scenarios
    asked = Asked(
        scenarios=tuple(str(one) for one in named),
        suite=None if suite is None else str(suite),
        episodes=_whole("episodes", episodes, 1),
        first_seed=_whole("first_seed", first_seed, 0) or 0,
        robot=None if robot is None else str(robot),
        settings=setting_texts(overrides, components),
        vary=vary_texts(vary),
    )
    made = chosen_engine(engine, _whole("workers", workers, 1))
    limits = care(timeout, memory, _whole("keep", keep, 0) or 0)
    request = asked.request()
    if not flag("user_code", user_code):
        request.refuse_user_code()
    request.python()
    folder = sweep_folder(None if out is None else Path(out), asked.name)
    notes = request.unread()
    document = conduct(
        request,
        folder,
        made,
        care=limits,
        progress=progress,
        command=asked.command,
        told=notes.append,
    )
    return Sweep(folder, document, tuple(notes))


def chosen_engine(name: str, workers: int | None) -> Callable[[], Engine]:
    """Return what makes an engine by its name.

    Raises:
        InputError: there is no such engine.
    """
    if name not in ENGINES:
        raise InputError(f"engine: found {shown(name)}; must be one of {', '.join(ENGINES)}")
    if name == "ray":
        from treadwell.sweeps.ray_engine import ray_engine

        return lambda: ray_engine(workers)
    return lambda: local_engine(workers or os.cpu_count() or 1)


def _whole(name: str, value: object, least: int) -> int | None:
    """Return a whole number that was given, or None.

    Raises:
        InputError: it is none, or too small.
    """
    if value is None:
        return None
    value = plain_number(value)
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise InputError(f"{name}: found {shown(value)}; must be a whole number from {least} on")
    return value
