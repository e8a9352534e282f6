"""Claims about the writer of MCAP files: its bytes are those of the `mcap` package."""

from io import BytesIO

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from treadwell.recording.log_writer import Entry, LogWriter

CHUNK = 1 << 12


def entries(count: int) -> list[Entry]:
    random = np.random.default_rng(count)
    made = []
    for i in range(count):
        log_ns = int(random.integers(0, 10**9)) if i % 7 == 0 else i * 10_000_000
        data = random.integers(0, 4, int(random.integers(0, 900)), np.uint8).tobytes()
        made.append((1 + int(random.integers(0, 3)) * (i > 5), log_ns, log_ns // 2, data))
    return made


def ours(given: list[Entry]) -> bytes:
    file = BytesIO()
    writer = LogWriter(file, CHUNK, "ros2", "a library")
    for number in range(3):
        writer.add_channel(f"/topic{number}", f"a/msg/Kind{number}", "uint64 time_ns\n" * number)
    writer.add_metadata("words", {"one": "1", "two": "zwei \u00e4"})
    writer.add_attachment("a.json", "application/json", b"{}")
    writer.add_attachment("b", "application/octet-stream", bytes(3000))
    writer.add_messages(given[:40])
    writer.add_messages(given[40:])
    writer.finish()
    return file.getvalue()


def theirs(given: list[Entry]) -> bytes:
    file = BytesIO()
    writer = Writer(file, chunk_size=CHUNK, compression=CompressionType.ZSTD)
    writer.start(profile="ros2", library="a library")
    for number in range(3):
        definition = ("uint64 time_ns\n" * number).encode()
        schema = writer.register_schema(f"a/msg/Kind{number}", "ros2msg", definition)
        writer.register_channel(f"/topic{number}", "cdr", schema)
    writer.add_metadata("words", {"one": "1", "two": "zwei \u00e4"})
    writer.add_attachment(0, 0, "a.json", "application/json", b"{}")
    writer.add_attachment(0, 0, "b", "application/octet-stream", bytes(3000))
    for channel, log_ns, publish_ns, data in given:
        writer.add_message(channel, log_ns, data, publish_ns)
    writer.finish()  # type: ignore[no-untyped-call]
    return file.getvalue()


@pytest.mark.parametrize("count", [0, 1, 3, 100, 333])
def test_the_bytes_are_those_of_the_mcap_package(count: int) -> None:
    given = entries(count)
    assert ours(given) == theirs(given)


def test_another_reader_finds_all_messages_in_their_order() -> None:
    given = entries(100)
    found = [
        (channel.id, message.log_time, message.publish_time, message.data)
        for _, channel, message in make_reader(BytesIO(ours(given))).iter_messages(
            log_time_order=False
        )
    ]
    assert found == given
