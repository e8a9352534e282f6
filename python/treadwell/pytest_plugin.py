"""The pytest plugin: a scenario file is a test, passed when it meets its expectations."""

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import pytest

from treadwell.errors import InputError, TreadwellError
from treadwell.files import opened

if TYPE_CHECKING:
    from treadwell.judging.result import Result

_RUNS = "treadwell_runs"
_NO_USER_CODE = "--treadwell-no-user-code"
_SEEDS = "treadwell_seeds"
_SEEDS_OPTION = "--treadwell-seeds"
_SEEDS_OF_CONFIG: Final = pytest.StashKey[tuple[int, ...]]()
MOST_SEEDS: Final = 10_000


class ScenarioFailedError(Exception):
    """A scenario ran and did not meet its expectations."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Let seeds and the folder for failed runs be chosen, and the user's code be refused."""
    parser.addoption(
        _NO_USER_CODE, action="store_true", help="refuse scenarios that name a Python class"
    )
    parser.addoption(
        _SEEDS_OPTION, metavar="SEEDS", help="run each scenario file once a seed: 0-4, or 0,3,7"
    )
    parser.addini(_RUNS, "folder for the runs of failed scenarios", default="runs/pytest")
    parser.addini(_SEEDS, f"seeds of scenario files where {_SEEDS_OPTION} names none", default="")


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker that every scenario has; read the seeds."""
    config.addinivalue_line("markers", "scenario: closed-loop episodes of a scenario file")
    asked = config.getoption(_SEEDS_OPTION)
    word, text = (_SEEDS, config.getini(_SEEDS)) if asked is None else (_SEEDS_OPTION, asked)
    try:
        config.stash[_SEEDS_OF_CONFIG] = read_seeds(str(text)) if text or asked == "" else ()
    except InputError as error:
        raise pytest.UsageError(f"{word}: {error}") from None


def read_seeds(text: str) -> tuple[int, ...]:
    """Return the seeds that a text names: `5`, `0,3,7`, `0-4`, `0-4,9`; each once, in its order.

    Raises:
        InputError: it is none of that, or names too many.
    """
    fault = f"found {text!r}; must be seeds from 0 on, as in 5, 0,3,7 or 0-4"
    seeds: dict[int, None] = {}
    for part in text.split(","):
        ends = re.fullmatch(r"\s*(\d{1,15})\s*(?:-\s*(\d{1,15})\s*)?", part, re.ASCII)
        if ends is None:
            raise InputError(fault)
        first = int(ends[1])
        last = first if ends[2] is None else int(ends[2])
        if last < first:
            raise InputError(fault)
        if last - first >= MOST_SEEDS or len(seeds) > MOST_SEEDS:
            raise InputError(f"found {text!r}, which is more than {MOST_SEEDS} seeds")
        seeds.update(dict.fromkeys(range(first, last + 1)))
    return tuple(seeds)


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Collect every TOML file that says to be a scenario."""
    if file_path.suffix != ".toml" or not is_scenario(file_path):
        return None
    return ScenarioFile.from_parent(parent, path=file_path)


def is_scenario(path: Path) -> bool:
    """Say whether a file looks like a scenario, broken or not, and not like a suite of them."""
    try:
        with opened(path) as file:
            lines = file.read(20_000).decode(errors="replace").splitlines()
    except (InputError, OSError):
        return False
    keys = {line.partition("=")[0].strip() for line in lines if "=" in line}
    is_suite = any(line.strip() == "[[entry]]" for line in lines)
    return "schema" in keys and {"name", "position"} & keys != set() and not is_suite


def pytest_report_collectionfinish(config: pytest.Config, items: list[pytest.Item]) -> list[str]:
    """Return which Python the collected scenario files are about to run, a line each."""
    if not user_code(config):
        return []
    files = dict.fromkeys(item.path for item in items if isinstance(item, ScenarioItem))
    return [f"{path}: {line}" for path in files for line in _python_of(path)]


def _python_of(path: Path) -> list[str]:
    """Return what `treadwell run` says of a file's Python; nothing of a file that is refused."""
    from treadwell.plugins import examined, foreign_parts
    from treadwell.scenario.loading import load_scenario

    try:
        parts = foreign_parts(load_scenario(path).navigation.slots())
        return [part.said(file) for part, file in examined(parts, str(path)).items()]
    except TreadwellError:
        return []  # its test says why


class ScenarioFile(pytest.File):
    """A scenario file."""

    def collect(self) -> Iterator[pytest.Item]:
        """Yield the one test that it is; or, where seeds are asked for, one a seed."""
        for seed in self.config.stash[_SEEDS_OF_CONFIG]:
            yield ScenarioItem.from_parent(self, name=f"{self.path.stem}[seed-{seed}]", seed=seed)
        if not self.config.stash[_SEEDS_OF_CONFIG]:
            yield ScenarioItem.from_parent(self, name=self.path.stem)


class ScenarioItem(pytest.Item):
    """The run of a scenario.

    Attributes:
        seed: instead of the file's own; None: the file's.
    """

    def __init__(self, *, seed: int | None = None, **kwargs: Any) -> None:  # noqa: ANN401 - pytest's own arguments
        """Mark it as a scenario, so that `-m` can choose."""
        super().__init__(**kwargs)
        self.seed = seed
        self.add_marker("scenario")

    def runtest(self) -> None:
        """Run it."""
        run_scenario(
            self.path,
            runs_folder(self.config),
            seed=self.seed,
            user_code=user_code(self.config),
        )

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], *_: object) -> str:
        """Return what was not met and where the run lies, without a traceback of ours."""
        if isinstance(excinfo.value, ScenarioFailedError | TreadwellError):
            return str(excinfo.value)
        return str(super().repr_failure(excinfo))

    def reportinfo(self) -> tuple[Path, None, str]:
        """Return where the test is and what it is called."""
        return self.path, None, f"scenario {self.name}"


@pytest.fixture
def treadwell_scenario(request: pytest.FixtureRequest) -> Callable[..., "Result"]:
    """A function that runs a scenario as `treadwell.run` does, and fails where it does not pass."""

    def run(scenario: str | Path, **options: Any) -> "Result":  # noqa: ANN401 - as treadwell.run
        allowed = options.pop("user_code", True) and user_code(request.config)
        return run_scenario(scenario, runs_folder(request.config), user_code=allowed, **options)

    return run


def runs_folder(config: pytest.Config) -> Path:
    """Return the folder for the runs of failed scenarios."""
    return config.rootpath / str(config.getini(_RUNS))


def user_code(config: pytest.Config) -> bool:
    """Return whether a scenario may name a Python class."""
    return not config.getoption(_NO_USER_CODE)


def run_scenario(
    scenario: str | Path,
    runs: Path,
    *,
    seed: int | None = None,
    **options: Any,  # noqa: ANN401
) -> "Result":
    """Run a scenario; its folder stays when it fails and goes when it passes.

    Args:
        scenario: name or path.
        runs: folder in which the run's own folder is made.
        seed: instead of the scenario's; None: the scenario's.
        options: as for `treadwell.run`.

    Raises:
        ScenarioFailedError: it does not meet its expectations; the run's folder is named.
        TreadwellError: it could not be run.
    """
    import shutil

    import treadwell

    name = Path(scenario).stem + ("" if seed is None else f"-{seed}")
    out = free_folder(runs, name)
    run = treadwell.run(scenario, seed=seed, out=out, **options)
    if not run.passed:
        said = "\n".join(f"  {failure}" for failure in run.result.failures)
        raise ScenarioFailedError(
            f"{run.result.scenario}: {run.outcome}\n{said}\nrun: {run.folder}"
        )
    shutil.rmtree(run.folder)
    result: Result = run.result
    return result


def free_folder(runs: Path, name: str) -> Path:
    """Return a folder in `runs` that does not exist yet: the name, or with a number behind it."""
    number, folder = 1, runs / name
    while folder.exists():
        number += 1
        folder = runs / f"{name}-{number}"
    return folder
