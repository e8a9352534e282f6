"""The example of a planner in Rust builds outside the workspace, and its core takes ours' place."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from treadwell.errors import InputError
from treadwell.own_core import MODULE, OwnCore

ROOT = Path(__file__).resolve().parent.parent
EXAMPLE = ROOT / "examples" / "own_planner"
pytestmark = pytest.mark.slow


def cargo(*words: str, folder: Path) -> None:
    target = os.environ.get("CARGO_TARGET_DIR", str(ROOT / "target"))
    done = subprocess.run(
        ["cargo", *words, "--quiet"],
        cwd=folder,
        env={"PYO3_PYTHON": sys.executable, **os.environ, "CARGO_TARGET_DIR": target},
        check=False,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr[-3000:]


def libraries_of_the_tests() -> str:
    """What the workspace's tests use: it switches features of what the example uses on."""
    named = r"^(?:approx|criterion|pathfinding|proptest) = .*\n"
    found = re.findall(named, (ROOT / "Cargo.toml").read_text(), re.MULTILINE)
    assert len(found) == 4
    return "".join(found)


@pytest.fixture(scope="module")
def core(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example, built where a user's crate may lie, with what is built for the workspace."""
    folder = tmp_path_factory.mktemp("user") / "own_planner"
    shutil.copytree(EXAMPLE, folder, ignore=shutil.ignore_patterns("target", "Cargo.lock"))
    manifest = folder / "Cargo.toml"
    # The same versions and features as in the workspace: no library is compiled twice.
    table = "[dependencies]\n"
    text = manifest.read_text().replace("../../", f"{ROOT}/")
    manifest.write_text(text.replace(table, table + libraries_of_the_tests()))
    shutil.copy(ROOT / "Cargo.lock", folder)
    cargo("fmt", "--check", folder=folder)
    cargo("test", "--lib", folder=folder)
    cargo("build", folder=folder)
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    kept = folder / "libown_planner.so"
    shutil.copy(target / "debug" / "libown_planner.so", kept)
    return kept


def treadwell(core: Path | str, *words: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "treadwell.cli.app", *words],
        cwd=cwd,
        env={**os.environ, "TREADWELL_CORE": str(core), "PYTHONPATH": str(ROOT / "python")},
        check=False,
        capture_output=True,
        text=True,
    )


@pytest.mark.long
@pytest.mark.timeout(900)
def test_its_planner_is_listed_and_finds_the_way(core: Path, tmp_path: Path) -> None:
    listed = treadwell(core, "list", "components", "--json", cwd=tmp_path)
    planners = json.loads(listed.stdout)["components"]["planner"]
    assert planners["beeline"] == "straight to the goal, or not at all"
    words = ["run", "open_floor", "--no-record", "--json", "--out", "run"]
    words += ["--set", "navigation.planner=beeline", "--set", "navigation.beeline.spacing=0.1"]
    words += ["--set", "goal.position=[0.5, 0.0]", "--set", "start.yaw=0.0"]
    done = treadwell(core, *words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    result = json.loads((tmp_path / "run" / "result.json").read_text())
    assert result["outcome"] == "goal_reached"
    assert result["configuration"]["navigation"]["planner"] == "beeline"


@pytest.mark.long
@pytest.mark.timeout(900)
def test_its_parameters_are_read_by_the_crate(core: Path, tmp_path: Path) -> None:
    named = ("--set", "navigation.planner=beeline")
    for setting, message in (("spacing=0.0", "must be > 0, got 0"), ("spaces=1", "spacing")):
        words = ("check", "open_floor", *named, "--set", f"navigation.beeline.{setting}")
        done = treadwell(core, *words, cwd=tmp_path)
        assert done.returncode == 2
        assert "navigation.beeline" in done.stderr
        assert message in done.stderr
        assert "Traceback" not in done.stderr


@pytest.mark.parametrize("found", ["nothing", "text"])
def test_a_file_that_is_no_core_is_bad_input(found: str, tmp_path: Path) -> None:
    path = tmp_path / "core.so"
    if found == "text":
        path.write_text("no library")
    done = treadwell(path, "check", "open_floor", cwd=tmp_path)
    assert done.returncode == 2
    assert f"TREADWELL_CORE: {path}" in done.stderr
    assert "Traceback" not in done.stderr


def test_only_the_core_is_looked_for(tmp_path: Path) -> None:
    finder = OwnCore(str(tmp_path / "none.so"))
    assert finder.find_spec("treadwell.episode") is None
    with pytest.raises(InputError, match="no such file"):
        finder.find_spec(MODULE)
