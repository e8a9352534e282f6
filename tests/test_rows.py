"""Claims about rows that grow: all are there, in memory lies a block of them, files are whole."""

from pathlib import Path

import numpy as np
import pytest

from treadwell.errors import RecordingError
from treadwell.physics import rows
from treadwell.physics.rows import Rows


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rows, "_BLOCK_BYTES", 10 * 24)


@pytest.mark.parametrize("named", [None, 0, 17])
def test_single_rows_and_blocks_come_back_in_their_order(tmp_path: Path, named: int | None) -> None:
    made, given = Rows((3,)), np.random.default_rng(1).random((57, 3))
    for row in given[:17]:
        if named == 0 and not len(made):
            made.keep_in(tmp_path / "rows.npy")
        made.append(row)
    if named == 17:
        made.keep_in(tmp_path / "rows.npy")
    made.extend(given[17:50])
    assert np.array_equal(made.array(), given[:50])
    made.extend(given[50:])
    assert len(made) == 57
    assert np.array_equal(made.array(), given)
    made.flush()
    if named is not None:
        assert np.array_equal(np.load(tmp_path / "rows.npy"), given)


def test_a_file_is_whole_after_each_block(tmp_path: Path) -> None:
    made, given = Rows((3,)), np.random.default_rng(1).random((35, 3))
    made.keep_in(tmp_path / "rows.npy")
    assert np.load(tmp_path / "rows.npy").shape == (0, 3)
    for count, row in enumerate(given, start=1):
        made.append(row)
        there = np.load(tmp_path / "rows.npy")
        assert len(there) == count // 10 * 10
        assert np.array_equal(there, given[: len(there)])


@pytest.mark.parametrize("dtype", [np.int64, np.float32, np.uint8])
def test_rows_of_one_number_and_other_types_are_kept(tmp_path: Path, dtype: type) -> None:
    made = Rows((), dtype)
    made.keep_in(tmp_path / "rows.npy")
    for number in range(5):
        made.append(np.array(number))
    made.flush()
    assert np.load(tmp_path / "rows.npy").tolist() == [0, 1, 2, 3, 4]
    assert np.load(tmp_path / "rows.npy").dtype == dtype


def test_a_file_that_cannot_be_written_is_an_error_with_its_name(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"rows\.npy: cannot be written: No such file"):
        Rows((3,)).keep_in(tmp_path / "gone" / "rows.npy")


def test_a_full_disk_is_an_error() -> None:
    with pytest.raises(RecordingError, match="No space left"):
        Rows((3,)).keep_in(Path("/dev/full"))
