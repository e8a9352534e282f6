"""A built wheel, in an empty environment and from another folder, finds all that it needs."""

import fcntl
import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import treadwell

ROOT = Path(__file__).resolve().parent.parent
pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]


def call(*command: str | Path, cwd: Path = ROOT) -> subprocess.CompletedProcess[str]:
    inherited = {
        key: os.environ[key] for key in os.environ if key not in {"PYTHONPATH", "VIRTUAL_ENV"}
    }
    return subprocess.run(
        [str(word) for word in command],
        cwd=cwd,
        env=inherited,
        check=False,
        capture_output=True,
        text=True,
    )


def uv() -> str | None:
    """The uv of the machine, or that of `make setup`."""
    own = ROOT / ".uv" / "bin" / "uv"
    return shutil.which("uv") or (str(own) if own.is_file() else None)


def no_network(what: str, done: subprocess.CompletedProcess[str]) -> None:
    """Skip where packages cannot be had; the continuous integration must not."""
    if done.returncode != 0:
        said = f"{what}: {done.stdout[-500:]}{done.stderr[-2000:]}"
        if os.environ.get("CI"):
            pytest.fail(said)
        pytest.skip(said)


def of_all_workers(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The session's folder, the same one in each worker that shares its tests."""
    base = tmp_path_factory.getbasetemp()
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base


@pytest.fixture(scope="session")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, built by the first worker that asks.

    Two builds at once would take the library from each other: maturin moves it out of the
    folder that both build in.
    """
    shared = of_all_workers(tmp_path_factory)
    with (shared / "wheel.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        out = shared / "wheel"
        if not list(out.glob("*.whl")):
            maturin = Path(sys.executable).parent / "maturin"
            to = ("--out", out, "-i", sys.executable)
            done = call(maturin, "build", "--release", "--locked", *to)
            assert done.returncode == 0, done.stderr[-3000:]
        (made,) = out.glob("*.whl")
    return made


@pytest.fixture(scope="module")
def programs(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the programs of an environment with nothing but the wheel and what it needs."""
    home = tmp_path_factory.mktemp("empty") / "venv"
    tool = uv()
    if tool is None:
        made = call(sys.executable, "-m", "venv", home)
        assert made.returncode == 0, made.stderr
        done = call(home / "bin" / "pip", "install", "--quiet", wheel)
    else:
        made = call(tool, "venv", "--quiet", "--python", sys.executable, home)
        assert made.returncode == 0, made.stderr
        python = home / "bin" / "python"
        done = call(tool, "pip", "install", "--quiet", "--python", python, wheel)
    no_network("the wheel's needs cannot be installed", done)
    return home / "bin"


def test_it_holds_models_scenarios_types_and_one_extension(wheel: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    for needed in ("models/qrio/qrio.xml", "models/qrio/robot.toml", "py.typed", "_core.pyi"):
        assert f"treadwell/{needed}" in names
    for path in (ROOT / "scenarios").glob("*.toml"):
        assert f"treadwell/scenarios/{path.name}" in names
    assert "treadwell/scenarios/suites/leaderboard.toml" in names
    assert [name for name in names if name.endswith(".so")] == ["treadwell/_core.abi3.so"]
    assert not [name for name in names if "__pycache__" in name or "tests/" in name]
    assert "cp311-abi3" in wheel.name


def test_it_runs_an_episode_from_another_folder(programs: Path, tmp_path: Path) -> None:
    done = call(
        programs / "treadwell", "run", "slalom", "--no-record", "--set", "time_limit=2", "--json",
        cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 1, done.stderr  # two seconds are too few to arrive
    result = json.loads(done.stdout)
    assert result["outcome"] == "timed_out"
    assert result["version"] == treadwell.__version__
    assert (tmp_path / "runs" / "latest" / "map.png").is_file()


def test_it_records_without_the_developers_tools(programs: Path, tmp_path: Path) -> None:
    limit = ("--set", "time_limit=1", "--out", "run")
    done = call(programs / "treadwell", "run", "visitor", *limit, cwd=tmp_path)
    assert done.returncode == 1, done.stderr
    verified = call(programs / "treadwell", "verify", "run", cwd=tmp_path)
    assert verified.returncode == 0, verified.stdout


def test_it_lists_what_there_is(programs: Path, tmp_path: Path) -> None:
    done = call(programs / "treadwell", "list", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    listed = json.loads(done.stdout)
    shipped = {path.stem for path in (ROOT / "scenarios").glob("*.toml")}
    assert {entry["name"] for entry in listed["scenarios"]} == shipped
    assert "qrio" in {entry["name"] for entry in listed["robots"]}


def test_its_import_reaches_no_source_folder(programs: Path, tmp_path: Path) -> None:
    code = "import treadwell, treadwell._core; print(treadwell._core.__file__)"
    done = call(programs / "python", "-c", code, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert str(programs.parent) in done.stdout
