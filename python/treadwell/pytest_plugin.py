"""The pytest plugin: a scenario file is a test, passed when it meets its expectations."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from treadwell.errors import InputError, TreadwellError
from treadwell.files import opened

if TYPE_CHECKING:
    from treadwell.judging.result import Result

_RUNS = "treadwell_runs"
_NO_USER_CODE = "--treadwell-no-user-code"


class ScenarioFailedError(Exception):
    """A scenario ran and did not meet its expectations."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Let a folder for the runs of failed scenarios be chosen, and the user's code be refused."""
    parser.addoption(
        _NO_USER_CODE, action="store_true", help="refuse scenarios that name a Python class"
    )
    parser.addini(_RUNS, "folder for the runs of failed scenarios", default="runs/pytest")


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker that every scenario has."""
    config.addinivalue_line("markers", "scenario: closed-loop episodes of a scenario file")


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


class ScenarioFile(pytest.File):
    """A scenario file."""

    def collect(self) -> Iterator[pytest.Item]:
        """Yield the one test that it is."""
        yield ScenarioItem.from_parent(self, name=self.path.stem)


class ScenarioItem(pytest.Item):
    """The run of a scenario."""

    def __init__(self, **kwargs: Any) -> None:  # noqa: ANN401 - pytest's own arguments
        """Mark it as a scenario, so that `-m` can choose."""
        super().__init__(**kwargs)
        self.add_marker("scenario")

    def runtest(self) -> None:
        """Run it."""
        run_scenario(self.path, runs_folder(self.config), user_code=user_code(self.config))

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], *_: object) -> str:
        """Return what was not met and where the run lies, without a traceback of ours."""
        if isinstance(excinfo.value, ScenarioFailedError | TreadwellError):
            return str(excinfo.value)
        return str(super().repr_failure(excinfo))

    def reportinfo(self) -> tuple[Path, None, str]:
        """Return where the test is and what it is called."""
        return self.path, None, f"scenario {self.path.stem}"


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


def run_scenario(scenario: str | Path, runs: Path, **options: Any) -> "Result":  # noqa: ANN401
    """Run a scenario; its folder stays when it fails and goes when it passes.

    Args:
        scenario: name or path.
        runs: folder in which the run's own folder is made.
        options: as for `treadwell.run`.

    Raises:
        ScenarioFailedError: it does not meet its expectations; the run's folder is named.
        TreadwellError: it could not be run.
    """
    import shutil

    import treadwell

    out = free_folder(runs, Path(scenario).stem)
    run = treadwell.run(scenario, out=out, **options)
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
