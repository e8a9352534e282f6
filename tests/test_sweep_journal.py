"""The journal: a line counts when its end is there."""

import shutil
from pathlib import Path

import pytest

from treadwell.errors import InputError, RecordingError
from treadwell.sweeps.journal import Journal, read_rows


def test_what_was_appended_is_there_again(tmp_path: Path) -> None:
    path = tmp_path / "journal.jsonl"
    first = Journal(path)
    first.append({"seed": 1})
    first.append({"seed": 2})
    first.close()
    second = Journal(path)
    assert second.rows == [{"seed": 1}, {"seed": 2}]
    second.close()


def test_half_a_line_is_cut_off(tmp_path: Path) -> None:
    path = tmp_path / "journal.jsonl"
    whole = b'{"seed":1}\n'
    for half in (b"{", b'{"seed":2}', b'{"se\xff'):
        path.write_bytes(whole + half)
        journal = Journal(path)
        journal.append({"seed": 3})
        journal.close()
        assert path.read_bytes() == whole + b'{"seed":3}\n'


def test_rows_are_read_beside_a_writer_and_nothing_is_changed(tmp_path: Path) -> None:
    path = tmp_path / "journal.jsonl"
    assert read_rows(path) == []
    content = b'{"seed":1}\n{"seed":2}\n{"seed":'
    path.write_bytes(content)
    assert read_rows(path) == [{"seed": 1}, {"seed": 2}]
    assert path.read_bytes() == content


def test_a_broken_line_before_the_last_is_bad_input(tmp_path: Path) -> None:
    path = tmp_path / "journal.jsonl"
    for broken in (b"no\n{}\n", b"{}\n[1]\n"):
        path.write_bytes(broken)
        with pytest.raises(InputError, match=r"line [12]: not (a row|JSON)"):
            Journal(path)


def test_a_line_that_is_nested_too_deep_is_bad_input(tmp_path: Path) -> None:
    path = tmp_path / "journal.jsonl"
    path.write_bytes(b'{"seed":1}\n{"seed":' + b"[" * 10_000 + b"]" * 10_000 + b"}\n")
    with pytest.raises(InputError, match=r"journal\.jsonl: line 2: nested too deep"):
        Journal(path)
    assert read_rows(path) == [{"seed": 1}]


def test_a_journal_that_cannot_be_is_told(tmp_path: Path) -> None:
    with pytest.raises(RecordingError):
        Journal(tmp_path / "nowhere" / "journal.jsonl")


@pytest.mark.parametrize("removed", [True, False])
def test_a_folder_that_is_removed_or_renamed_is_told(tmp_path: Path, removed: bool) -> None:
    folder = tmp_path / "sweep"
    folder.mkdir()
    journal = Journal(folder / "journal.jsonl")
    journal.append({"seed": 1})
    folder.rename(tmp_path / "other")
    if removed:
        shutil.rmtree(tmp_path / "other")
    with pytest.raises(RecordingError, match="was removed or renamed while the sweep went on"):
        journal.append({"seed": 2})
    journal.close()
    if not removed:
        assert read_rows(tmp_path / "other" / "journal.jsonl") == [{"seed": 1}]
