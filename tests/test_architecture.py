"""The house rules that one would else have to trust: crate order, file length, tests."""

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
LONGEST_FILE = 400
# Tested through what uses them, by the test named.
TESTED_BY = {
    "__init__": "test_bindings.py",
    "protocols": "test_components.py",
    "course_check": "test_course.py",
    "course_levels": "test_course.py",
    "course_pieces": "test_course.py",
    "recording_products": "test_recording.py",
    "scenario_errors": "test_scenario.py",
    "scenario_types": "test_scenario.py",
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
    for path in sorted((ROOT / "python" / "treadwell").glob("*.py")):
        own = f"test_{path.stem}.py"
        imported = re.search(rf"treadwell\.{path.stem}\b|import {path.stem}\b", texts)
        if own not in tests and not imported and TESTED_BY.get(path.stem) not in tests:
            untested.append(path.stem)
    assert not untested


def test_every_rust_crate_has_tests_beside_its_code() -> None:
    for crate in members():
        if crate == "bindings":  # tested from Python: test_bindings.py
            continue
        text = "\n".join(path.read_text() for path in (ROOT / "rust" / crate).rglob("*.rs"))
        assert "#[test]" in text, crate


def test_only_judges_and_recorders_read_the_truth() -> None:
    """Nothing that runs before the core's tick may import what reads the truth."""
    folder = ROOT / "python" / "treadwell"
    for name in ("observation", "sensors", "body_senses", "depth", "stereo"):
        text = (folder / f"{name}.py").read_text()
        assert not re.search(r"treadwell\.(judge|score|recording)", text), name
    core = "\n".join(path.read_text() for path in (ROOT / "rust").rglob("*.rs"))
    assert "mujoco" not in core.lower().replace("mujoco's quaternions", "")
