"""Claims about files that were changed at random: taken or refused, and no fault among them."""

from pathlib import Path

import fuzz_files
import pytest


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_changed_files_are_taken_or_refused(tmp_path: Path) -> None:
    fuzz_files.seeds(tmp_path)
    for kind, (file, read) in fuzz_files.READERS.items():
        if kind != "log":
            read(tmp_path / file)
    found = fuzz_files.fuzz(495, 2004, tmp_path)
    assert sum(found.values()) == 495
    assert not [kind for (kind, came), _ in found.items() if came == "FAULT"]
    assert all(found[kind, "refused"] for kind in ("scenario", "robot", "world", "stl", "log"))
