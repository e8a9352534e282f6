"""Claims about where the shipped folders are found."""

from pathlib import Path

import pytest

import treadwell.data
from treadwell.data import data_folder
from treadwell.errors import TreadwellError


def test_the_robots_and_the_scenarios_are_found() -> None:
    assert (data_folder("models") / "qrio" / "robot.toml").is_file()
    assert data_folder("scenarios").is_dir()


def test_the_package_comes_before_the_source_tree(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "python" / "treadwell"
    (tmp_path / "models").mkdir()
    package.mkdir(parents=True)
    monkeypatch.setattr(treadwell.data, "PACKAGE", package)
    assert data_folder("models") == tmp_path / "models"
    (package / "models").mkdir()
    assert data_folder("models") == package / "models"


def test_a_missing_folder_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(treadwell.data, "PACKAGE", tmp_path / "python" / "treadwell")
    with pytest.raises(TreadwellError, match="models is missing"):
        data_folder("models")
