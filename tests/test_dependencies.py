"""What we build on: its licences and where it comes from, as `deny.toml` allows.

`cargo deny` says the same and more where it is there (`make deny`); this needs nothing but cargo.
"""

import json
import re
import shutil
import subprocess
import tomllib
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parent.parent
REGISTRY = "registry+https://github.com/rust-lang/crates.io-index"


def toml(name: str) -> dict[str, Any]:
    return tomllib.loads((ROOT / name).read_text(encoding="utf-8"))


def crates() -> list[dict[str, Any]]:
    """The crates of others that are compiled for the package, its tests and benches."""
    asked = ["cargo", "metadata", "--format-version", "1", "--locked"]
    for more in (["--offline"], []):  # crates for other systems may not have been loaded yet
        done = subprocess.run(
            [*asked, *more], cwd=ROOT, capture_output=True, text=True, check=False
        )
        if done.returncode == 0:
            listed: list[dict[str, Any]] = json.loads(done.stdout)["packages"]
            return [crate for crate in listed if crate["source"] is not None]
    raise AssertionError(done.stderr)


def is_allowed(licence: str, allowed: set[str]) -> bool:
    """Say whether an SPDX expression leaves a choice of licences that are all allowed."""
    if inner := re.search(r"\(([^()]*)\)", licence):
        word = "yes" if is_allowed(inner[1], allowed) else "no"
        return is_allowed(licence[: inner.start()] + word + licence[inner.end() :], allowed)
    choices = re.split(r" OR |/", licence)
    return any(
        all(one.strip() in {"yes", *allowed} for one in choice.split(" AND ")) for choice in choices
    )


@pytest.mark.parametrize(
    ("licence", "verdict"),
    [
        ("MIT", True),
        ("GPL-3.0", False),
        ("GPL-3.0 OR MIT", True),
        ("MIT/GPL-3.0", True),
        ("MIT AND GPL-3.0", False),
        ("(GPL-3.0 OR MIT) AND Zlib", True),
        ("(GPL-3.0 OR LGPL-3.0) AND Zlib", False),
        ("Apache-2.0 WITH LLVM-exception", False),
    ],
)
def test_a_licence_is_read_as_spdx_has_it(licence: str, verdict: bool) -> None:
    assert is_allowed(licence, {"MIT", "Zlib"}) is verdict


def test_every_crate_has_a_licence_that_is_allowed() -> None:
    allowed = set(toml("deny.toml")["licenses"]["allow"])
    found = crates()
    assert len(found) > 50
    refused = {
        c["name"]: c["license"] for c in found if not is_allowed(c["license"] or "", allowed)
    }
    assert refused == {}


def test_every_crate_comes_from_the_registry_with_its_checksum() -> None:
    others = [one for one in toml("Cargo.lock")["package"] if "source" in one]
    assert [one["name"] for one in others if one["source"] != REGISTRY] == []
    assert [one["name"] for one in others if "checksum" not in one] == []


def test_every_python_package_comes_from_the_registry_with_its_hash() -> None:
    others = [one for one in toml("uv.lock")["package"] if one["name"] != "treadwell"]
    assert len(others) > 50
    files = {
        one["name"]: [*one.get("wheels", ()), *([one["sdist"]] if "sdist" in one else [])]
        for one in others
    }
    assert [one["name"] for one in others if set(one["source"]) != {"registry"}] == []
    assert [name for name, listed in files.items() if not all("hash" in f for f in listed)] == []


def features(*of: str) -> dict[str, str]:
    """Crate and version -> the features that it is built with."""
    asked = ["cargo", "tree", "--locked", "--offline", "--prefix", "none", "--format", "{p}|{f}"]
    done = subprocess.run([*asked, *of], cwd=ROOT, capture_output=True, text=True, check=True)
    rows = (line.removesuffix(" (*)").partition("|") for line in done.stdout.splitlines())
    return {crate.partition(" (")[0]: found for crate, _, found in rows}


def test_package_and_tests_are_built_of_the_same_crates() -> None:
    """One feature that only tests switch on, and all that stands on it is compiled twice."""
    package = features("--package", "bindings", "--edges", "normal,build")
    tests = features("--workspace", "--exclude", "bindings", "--edges", "normal,build,dev")
    both = package.keys() & tests.keys()
    assert len(both) > 50
    assert {crate: package[crate] for crate in both} == {crate: tests[crate] for crate in both}


@pytest.mark.skipif(shutil.which("cargo-deny") is None, reason="cargo-deny is not installed")
def test_cargo_deny_says_so_too() -> None:
    asked = ["cargo", "deny", "--offline", "check", "licenses", "bans", "sources"]
    done = subprocess.run(asked, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
