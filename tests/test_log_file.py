"""Claims about reading MCAP: bounded, whoever wrote it, and up to where the file breaks off."""

import struct
import time
from pathlib import Path

import lz4.frame
import pytest
import zstandard
from mcap.writer import CompressionType, Writer

from treadwell.errors import InputError
from treadwell.recording.log_file import (
    LARGEST_RECORD,
    MOST_WAITING,
    BrokenLogError,
    read_front,
    read_in_order,
    read_messages,
)

MAGIC = b"\x89MCAP0\r\n"


def record(opcode: int, content: bytes) -> bytes:
    return struct.pack("<BQ", opcode, len(content)) + content


def chunk(data: bytes, size: int, kind: bytes = b"zstd", crc: int = 0) -> bytes:
    head = struct.pack("<QQQII", 0, 0, size, crc, len(kind)) + kind
    return record(6, head + struct.pack("<Q", len(data)) + data)


def log(path: Path, count: int = 100, compression: CompressionType = CompressionType.ZSTD) -> Path:
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=1 << 10, compression=compression)
        writer.start()
        numbers = [writer.register_channel(f"/{name}", "cdr", 0) for name in "ab"]
        writer.add_metadata("what", {"key": "value"})
        writer.add_attachment(0, 0, "table", "text/plain", b"content")
        for i in range(count):
            writer.add_message(numbers[i % 2], i, f"message {i}".encode() * 20, i + 5)
        writer.finish()  # type: ignore[no-untyped-call]
    return path


@pytest.mark.parametrize("compression", list(CompressionType))
def test_the_messages_of_a_topic_come_in_their_order(
    tmp_path: Path, compression: CompressionType
) -> None:
    found = list(read_messages(log(tmp_path / "x", compression=compression), ("/b",)))
    assert [message.log_ns for message in found] == list(range(1, 100, 2))
    assert found[0].publish_ns == 6
    assert found[3].data == b"message 7" * 20


def test_metadata_and_attachments_stand_before_the_messages(tmp_path: Path) -> None:
    front = read_front(log(tmp_path / "x"))
    assert front.metadata == {"what": {"key": "value"}}
    assert front.attachments == {"table": b"content"}


def times(path: Path, found: list[int]) -> list[int]:
    """Add to `found` as long as there is something; then the error comes."""
    for message in read_messages(path, ("/a", "/b")):
        found.append(message.log_ns)
    return []


def test_wherever_a_file_is_cut_what_is_whole_is_given(tmp_path: Path) -> None:
    content = log(tmp_path / "x").read_bytes()
    counts = []
    for length in range(0, len(content), 97):
        path = tmp_path / "cut"
        path.write_bytes(content[:length])
        found: list[int] = []
        with pytest.raises(BrokenLogError) as caught:
            found.extend(times(path, found))
        assert found == list(range(len(found)))
        assert 0 <= caught.value.lost_bytes <= length
        counts.append(len(found))
    assert counts == sorted(counts)
    assert counts[-1] == 100


def test_wherever_a_chunk_is_changed_it_is_told(tmp_path: Path) -> None:
    content = bytearray(log(tmp_path / "x").read_bytes())
    start = content.index(b"zstd") + 20
    for place in range(start, start + 40, 7):
        changed = bytearray(content)
        changed[place] ^= 0x10
        (tmp_path / "changed").write_bytes(changed)
        with pytest.raises(BrokenLogError):
            list(read_messages(tmp_path / "changed", ("/a", "/b")))


CHANNEL = record(4, struct.pack("<HHIII", 1, 0, 0, 0, 0))


def packed(records: bytes) -> bytes:
    """A chunk that is small in the file."""
    return chunk(zstandard.compress(records), len(records))


BOMB = zstandard.compress(bytes(300 << 20), level=1)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"MCAP",
        MAGIC,
        MAGIC + b"\x06",
        MAGIC + struct.pack("<BQ", 6, 1 << 62),
        MAGIC + struct.pack("<BQ", 6, LARGEST_RECORD + 1) + bytes(100),
        MAGIC + chunk(BOMB, 300 << 20),
        MAGIC + chunk(BOMB, 1000),
        MAGIC + chunk(BOMB, 1 << 63),
        MAGIC + chunk(b"no zstd", 1000),
        MAGIC + chunk(b"x", 1, b"lz4"),
        MAGIC + chunk(bytes(30), 30, b"", crc=5),
        MAGIC + chunk(struct.pack("<BQ", 5, 1 << 60), 9, b""),
        MAGIC + chunk(record(5, b"short"), 14, b""),
        MAGIC + chunk(record(5, struct.pack("<HIQQ", 7, 0, 0, 0)), 31, b""),
        MAGIC + packed(record(15, b"") * 400_000),
        MAGIC + packed(record(4, struct.pack("<HHIII", 1, 0, 0, 0, 0)) * 400_000),
        MAGIC + packed(CHANNEL + record(5, struct.pack("<HIQQ", 1, 0, 0, 0)) * 600_000),
        MAGIC + record(6, b"\xff" * 60),
        MAGIC + record(4, struct.pack("<HHI", 1, 0, 1 << 31)),
        MAGIC + record(4, struct.pack("<HHI", 1, 0, 2) + b"\xff\xff"),
        MAGIC + b"".join(record(4, struct.pack("<HHIII", i, 0, 0, 0, 0)) for i in range(2000)),
    ],
)
def test_a_file_that_would_do_harm_is_refused_at_once(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "x"
    path.write_bytes(content)
    begin = time.process_time()
    with pytest.raises(BrokenLogError, match="breaks off or is no recording"):
        list(read_messages(path, ("/a",)))
    assert time.process_time() - begin < 1.0


@pytest.mark.parametrize(
    "content",
    [
        MAGIC + record(9, struct.pack("<QQIIQ", 0, 0, 0, 0, 1 << 63) + bytes(4)),
        MAGIC + record(9, b""),
        MAGIC + record(12, struct.pack("<II", 0, 1 << 30)),
        MAGIC + b"".join(record(12, struct.pack("<III", 4, i, 0)) for i in range(300)),
        MAGIC + record(9, struct.pack("<QQIIQ", 0, 0, 0, 0, 2) + b"ab" + bytes(4)),
    ],
)
def test_a_front_that_would_do_harm_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "x").write_bytes(content)
    with pytest.raises(InputError, match="breaks off or is no recording"):
        read_front(tmp_path / "x")


@pytest.mark.parametrize("name", ["nowhere", ".", "a\0b"])
def test_what_is_no_file_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        read_front(tmp_path / name)


def test_what_lz4_packed_unpacks_to_no_more_than_it_says(tmp_path: Path) -> None:
    bomb = lz4.frame.compress(bytes(1 << 24))
    path = tmp_path / "x"
    for said in (100, 1 << 23, (1 << 24) + 1):
        path.write_bytes(MAGIC + chunk(bomb, said, b"lz4"))
        with pytest.raises(BrokenLogError, match="another size than it says"):
            list(read_messages(path, ("/a",)))
    path.write_bytes(MAGIC + chunk(b"\x04\x22\x4d\x18" + bomb[8:], 100, b"lz4"))
    with pytest.raises(BrokenLogError):
        list(read_messages(path, ("/a",)))


def test_messages_come_by_time_and_those_of_one_time_by_topic(tmp_path: Path) -> None:
    path = tmp_path / "x"
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE)
        writer.start()
        numbers = {name: writer.register_channel(name, "cdr", 0) for name in ("/b", "/a")}
        for tick, names in enumerate((("/b", "/a"), ("/a", "/b"), ("/b", "/a", "/a"))):
            for count, name in enumerate(names):
                writer.add_message(numbers[name], tick, str(count).encode(), tick)
        writer.finish()  # type: ignore[no-untyped-call]
    found = [(m.log_ns, m.topic, m.data) for m in read_in_order(path, ("/a", "/b"))]
    assert found == [
        (0, "/a", b"1"), (0, "/b", b"0"), (1, "/a", b"0"), (1, "/b", b"1"),
        (2, "/a", b"1"), (2, "/a", b"2"), (2, "/b", b"0"),
    ]  # fmt: skip


def test_what_stands_far_behind_its_time_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "x"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        number = writer.register_channel("/a", "cdr", 0)
        for tick in (*range(1, 2 * MOST_WAITING[0]), 0):
            writer.add_message(number, tick, b"", tick)
        writer.finish()  # type: ignore[no-untyped-call]
    with pytest.raises(InputError, match="no recording in the order of time"):
        list(read_in_order(path, ("/a",)))
