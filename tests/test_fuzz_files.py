"""Claims about files that were changed at random: taken or refused, and no fault among them."""

from pathlib import Path

import fuzz_files
import fuzz_readers
import pytest


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("good")
    fuzz_readers.seeds(folder)
    return folder


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_good_files_are_taken(good: Path) -> None:
    for file, read in fuzz_readers.READERS.values():
        read(good / file)


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.parametrize("way", fuzz_files.WAYS)
def test_changed_files_are_taken_or_refused(good: Path, way: str) -> None:
    found = fuzz_files.fuzz(495, 2004, good, way=way)
    assert sum(found.values()) == 495
    assert not [kind for (kind, came), _ in found.items() if came == "FAULT"]
    assert all(found[kind, "refused"] for kind in ("scenario", "robot", "journal", "log"))
