"""The house rules that one would else have to trust: crate order, file length, tests."""

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
LONGEST_FILE = 400
# Tested through what uses them, by the test named.
TESTED_BY = {
    "cli.verify": "test_difference.py",
    "progress": "test_cli.py",
    "protocols": "test_components.py",
    "version": "test_bindings.py",
    "cli.compare": "test_comparison.py",
    "comparing.tables": "test_comparison.py",
    "cli.options": "test_cli.py",
    "cli.run_verbs": "test_cli.py",
    "cli.sweep": "test_sweeps.py",
    "cli.sweep_verbs": "test_sweeps.py",
    "cli.export": "test_exports.py",
    "cli.report": "test_reporting.py",
    "gymnasium_hook": "test_environment.py",
    "course.check": "test_course.py",
    "course.levels": "test_course.py",
    "course.pieces": "test_course.py",
    "recording.products": "test_recording.py",
    "recording.stair_shapes": "test_recording.py",
    "sweeps.folder": "test_sweeps.py",
    "sweeps.job": "test_sweeps.py",
    "sweeps.summary": "test_sweeps.py",
    "solving.climb_line": "test_solvable.py",
    "robot.stance": "test_robot_template.py",
    "scenario.messages": "test_scenario.py",
    "scenario.types": "test_scenario.py",
    "workers.log": "test_pool.py",
}


def members() -> list[str]:
    workspace = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]
    return [Path(member).name for member in workspace["members"]]


def sources(pattern: str, *folders: str) -> list[Path]:
    found = [path for folder in folders for path in sorted((ROOT / folder).rglob(pattern))]
    return [path for path in found if "__pycache__" not in path.parts]


@pytest.mark.parametrize("crate", members())
def test_a_crate_uses_only_the_crates_above_it(crate: str) -> None:
    order = members()
    manifest = tomllib.loads((ROOT / "rust" / crate / "Cargo.toml").read_text())
    used = [name for name in manifest.get("dependencies", {}) if name in order]
    below = [name for name in used if order.index(name) >= order.index(crate)]
    assert not below, f"{crate} uses {below}, which stand below it in Cargo.toml"


@pytest.mark.parametrize("crate", members())
def test_a_crate_is_named_like_its_folder_and_declares_only_what_it_uses(crate: str) -> None:
    folder = ROOT / "rust" / crate
    manifest = tomllib.loads((folder / "Cargo.toml").read_text())
    assert manifest["package"]["name"] == crate
    text = "\n".join(path.read_text() for path in folder.rglob("*.rs"))
    unused = [
        name
        for name in manifest.get("dependencies", {})
        if not re.search(rf"\b{name.replace('-', '_')}\b", text)
    ]
    assert not unused, f"{crate} declares {unused} and does not use them"


def test_no_source_file_is_longer_than_the_limit() -> None:
    files = sources("*.rs", "rust") + sources("*.py", "python", "tests", "benches")
    lengths = {path.relative_to(ROOT): len(path.read_text().splitlines()) for path in files}
    too_long = {str(path): n for path, n in lengths.items() if n > LONGEST_FILE}
    assert not too_long


def test_every_source_file_says_what_it_is_for() -> None:
    rust = [path for path in sources("*.rs", "rust") if not path.read_text().startswith("//!")]
    python = [path for path in sources("*.py", "python") if not path.read_text().startswith('"""')]
    assert not [str(path.relative_to(ROOT)) for path in rust + python]


def test_every_python_module_has_a_test() -> None:
    tests = {path.name for path in (ROOT / "tests").glob("test_*.py")}
    texts = "\n".join(path.read_text() for path in (ROOT / "tests").glob("test_*.py"))
    assert set(TESTED_BY.values()) <= tests
    untested = []
    package = ROOT / "python" / "treadwell"
    for path in sorted(package.rglob("*.py")):
        if path.stem == "__init__" or "__pycache__" in path.parts:
            continue
        name = ".".join(path.relative_to(package).with_suffix("").parts)
        parent, _, leaf = name.rpartition(".")
        imported = re.search(
            rf"treadwell\.{re.escape(name)}\b|from treadwell\.?{parent} import .*\b{leaf}\b", texts
        )
        own = {f"test_{leaf}.py", f"test_{parent}_{leaf}.py", TESTED_BY.get(name)}
        if not imported and not own & tests:
            untested.append(name)
    assert not untested


def test_every_rust_crate_has_tests_beside_its_code() -> None:
    for crate in members():
        if crate == "bindings":  # tested from Python: test_bindings.py
            continue
        text = "\n".join(path.read_text() for path in (ROOT / "rust" / crate).rglob("*.rs"))
        assert "#[test]" in text, crate


def test_the_senses_and_the_core_cannot_read_the_truth() -> None:
    """What runs before the core's tick imports no judge, and the core knows no simulator."""
    package = ROOT / "python" / "treadwell"
    before = [package / "observation.py", package / "protocols.py"]
    before += sorted((package / "senses").glob("*.py")) + sorted((package / "physics").glob("*.py"))
    assert len(before) > 6
    for path in before:
        assert not re.search(r"treadwell\.(judging|recording)", path.read_text()), path.name
    core = "\n".join(path.read_text() for path in (ROOT / "rust").rglob("*.rs"))
    assert "mujoco" not in core.lower().replace("mujoco's quaternions", "")
