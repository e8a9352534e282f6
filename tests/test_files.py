"""Claims about reading a stranger's file: of a bounded size, UTF-8, and a file at all."""

import os
from pathlib import Path

import pytest

from treadwell.errors import InputError
from treadwell.files import read_content, read_text


def test_a_small_file_is_read(tmp_path: Path) -> None:
    (tmp_path / "x").write_text("ä")
    assert read_text(tmp_path / "x", 2) == "ä"
    with pytest.raises(InputError, match="larger than 1 bytes"):
        read_content(tmp_path / "x", 1)


def test_what_is_no_file_or_no_text_is_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "x").write_bytes(b"\xff")
    for name, word in (("pipe", "no file"), (".", "no file"), ("none", "cannot be read")):
        with pytest.raises(InputError, match=word):
            read_content(tmp_path / name, 10)
    with pytest.raises(InputError, match="not UTF-8"):
        read_text(tmp_path / "x", 10)
    with pytest.raises(InputError, match="not a file's name"):
        read_text(tmp_path / "a\0b", 10)
