"""Reading an MCAP file from front to back: bounded, and up to where it breaks off.

The records are framed here and not by the `mcap` package: its reader believes every length that a
file states, a few bytes that unpack to gigabytes among them, and takes ten times as long.
"""

import heapq
import struct
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import BinaryIO, Final, NamedTuple

import lz4.frame
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Chunk, Metadata, Schema

from treadwell.errors import InputError
from treadwell.files import opened

LARGEST_RECORD: Final = 1 << 26
"""Bytes of one record, and of what a chunk unpacks to."""
MOST_TIMES: Final = 1000
"""What a file may unpack to over its own size; a run's has 3 to 4, one of a still picture more."""
LEAST_PACKED: Final = 4
"""Bytes of the file for each record of a chunk, at least."""
BESIDES: Final = (1 << 24, 100_000)
"""Bytes and records that a file may hold besides, however small it is."""
MOST_WAITING: Final = (100, 1 << 26)
"""Messages and bytes that wait for what is earlier but stands behind them."""
MOST_CHANNELS: Final = 1000
MOST_ATTACHMENTS: Final = 100
_MAGIC: Final = b"\x89MCAP0\r\n"
_IN_CHUNKS: Final = (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE)
_FRAME: Final = struct.Struct("<BQ")
_MESSAGE: Final = struct.Struct("<HIQQ")
_FAULTS: Final = (
    McapError,
    ValueError,
    struct.error,
    EOFError,
    IndexError,
    OSError,
    OverflowError,
    RuntimeError,  # what lz4 raises
    zstandard.ZstdError,
)


class BrokenLogError(InputError):
    """A log that breaks off: what came before is good.

    Attributes:
        lost_bytes: bytes of the file behind the last whole record.
    """

    def __init__(self, message: str, lost_bytes: int) -> None:
        """Keep both."""
        super().__init__(message)
        self.lost_bytes = lost_bytes


class Message(NamedTuple):
    """One message of a log; times in nanoseconds since the start."""

    topic: str
    log_ns: int
    publish_ns: int
    data: bytes


class ChannelKind(NamedTuple):
    """What the messages of a topic are: name of their type, and how they are encoded."""

    schema: str
    encoding: str


@dataclass(frozen=True, slots=True)
class Front:
    """What stands before the first message.

    Attributes:
        metadata: name -> key -> value.
        attachments: name -> content.
    """

    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    attachments: dict[str, bytes] = field(default_factory=dict)


@dataclass(slots=True)
class _Allowance:
    """What a file may still unpack to: bytes, and records of chunks."""

    data: int
    records: int


def read_front(path: Path) -> Front:
    """Return metadata and attachments of a log.

    Raises:
        BrokenLogError: the file breaks off before the first message.
        InputError: the file is missing, or is no MCAP file.
    """
    front = Front()
    with opened(path) as file:
        try:
            for opcode, content in _records(file, path):
                if opcode == Opcode.METADATA:
                    metadata = Metadata.read(ReadDataStream(BytesIO(content)))
                    front.metadata[metadata.name] = dict(metadata.metadata)
                elif opcode == Opcode.ATTACHMENT:
                    if zlib.crc32(content[:-4]) != int.from_bytes(content[-4:], "little"):
                        raise ValueError("an attachment whose checksum is wrong")
                    attachment = Attachment.read(ReadDataStream(BytesIO(content)))
                    front.attachments[attachment.name] = attachment.data
                if opcode in (Opcode.CHUNK, Opcode.MESSAGE, Opcode.DATA_END):
                    break
                if len(front.metadata) + len(front.attachments) > MOST_ATTACHMENTS:
                    raise ValueError(f"more than {MOST_ATTACHMENTS} attachments")
        except EOFError as error:
            raise BrokenLogError(f"{path}: breaks off: {_line(error)}", 0) from None
        except _FAULTS as error:
            raise InputError(f"{path}: breaks off or is no recording: {_line(error)}") from None
    return front


def read_channels(path: Path) -> dict[str, ChannelKind]:
    """Return what the messages of each topic are; of a log that breaks off as far as it is whole.

    Raises:
        BrokenLogError: it breaks off before its first channel, or is no MCAP file.
        InputError: the file is missing.
    """
    found: dict[str, ChannelKind] = {}
    schemas: dict[int, str] = {}
    with opened(path) as file:
        allowance = _allowance(path.stat().st_size)
        try:
            for opcode, content in _records(file, path):
                records = [(opcode, content)]
                if opcode == Opcode.CHUNK:
                    records = list(_parts(_unpacked(content), allowance))
                for kind, record in records:
                    if kind == Opcode.SCHEMA:
                        schema = Schema.read(ReadDataStream(BytesIO(record)))
                        schemas[schema.id] = schema.name
                    elif kind == Opcode.CHANNEL:
                        channel = Channel.read(ReadDataStream(BytesIO(record)))
                        name = schemas.get(channel.schema_id, "")
                        found[channel.topic] = ChannelKind(name, channel.message_encoding)
                if len(found) + len(schemas) > 2 * MOST_CHANNELS:
                    raise ValueError(f"more than {MOST_CHANNELS} channels")
        except _FAULTS as error:
            if not found:
                what = f"{path}: breaks off or is no recording: {_line(error)}"
                raise BrokenLogError(what, 0) from None
    return found


def read_messages(path: Path, topics: Sequence[str]) -> Iterator[Message]:
    """Return the messages of some topics, in the order in which they were written.

    Raises:
        BrokenLogError: the file breaks off, after all that is whole was given.
        InputError: the file is missing.
    """
    channels: dict[int, str | None] = {}
    with opened(path) as file:
        whole, size = 0, path.stat().st_size
        allowance = _allowance(size)
        try:
            for opcode, content in _records(file, path):
                if opcode == Opcode.CHUNK:
                    yield from _messages(_unpacked(content), channels, topics, allowance)
                elif opcode in (Opcode.MESSAGE, Opcode.CHANNEL):
                    message = _taken(opcode, content, channels, topics)
                    if message is not None:
                        yield message
                whole = file.tell()
        except _FAULTS as error:
            raise BrokenLogError(
                f"{path}: breaks off or is no recording: {_line(error)}", size - whole
            ) from None


def read_in_order(path: Path, topics: Sequence[str]) -> Iterator[Message]:
    """Return the messages of some topics by time; those of one time in the order of the topics.

    Who writes a log anew, as a merge or a filter does, may order what has one time as he likes.

    Raises:
        BrokenLogError: the file breaks off, after all that is whole was given.
        InputError: the file is missing, or a message stands far behind a later one.
    """
    rank = {topic: number for number, topic in enumerate(topics)}
    waiting: list[tuple[int, int, int, Message]] = []
    size, last = 0, 0
    try:
        for number, message in enumerate(read_messages(path, topics)):
            if message.log_ns < last:
                raise InputError(
                    f"{path}: is no recording in the order of time: {message.topic} of "
                    f"{1e-9 * message.log_ns:.2f} s stands behind {1e-9 * last:.2f} s"
                )
            heapq.heappush(waiting, (message.log_ns, rank[message.topic], number, message))
            size += len(message.data)
            while len(waiting) > MOST_WAITING[0] or size > MOST_WAITING[1]:
                first = heapq.heappop(waiting)[-1]
                size -= len(first.data)
                last = first.log_ns
                yield first
    except BrokenLogError:
        yield from (entry[-1] for entry in sorted(waiting))
        raise
    yield from (entry[-1] for entry in sorted(waiting))


def _records(file: BinaryIO, path: Path) -> Iterator[tuple[int, bytes]]:
    """Return operation and content of each record."""
    begin = file.read(len(_MAGIC))
    if begin != _MAGIC:
        if _MAGIC.startswith(begin):
            raise EOFError("there is no end")
        raise ValueError("it does not begin like an MCAP file")
    size = path.stat().st_size
    opcode = 0
    while opcode != Opcode.FOOTER:
        head = file.read(_FRAME.size)
        if len(head) < _FRAME.size:
            raise EOFError("there is no end")
        opcode, length = _FRAME.unpack(head)
        if length > size - file.tell():
            raise EOFError("a record breaks off")
        if length > LARGEST_RECORD:
            raise ValueError(f"a record of {length} bytes, {LARGEST_RECORD} are allowed")
        yield opcode, file.read(length)
    if file.read(len(_MAGIC)) != _MAGIC:
        raise EOFError("there is no end")


def _unpacked(content: bytes) -> bytes:
    """Return the records of a chunk."""
    chunk = Chunk.read(ReadDataStream(BytesIO(content)))
    data: bytes = chunk.data
    if chunk.uncompressed_size > LARGEST_RECORD:
        raise ValueError(f"a chunk of {chunk.uncompressed_size} bytes")
    if chunk.compression == "zstd":
        # What the compressed data says of its size is believed by zstandard: both must agree.
        if zstandard.get_frame_parameters(data).content_size > LARGEST_RECORD:
            raise ValueError("a chunk that unpacks to more than it says")
        data = zstandard.decompress(data, max_output_size=chunk.uncompressed_size)
    elif chunk.compression == "lz4":
        # Asked for one byte more than is said, it cannot make more than that of a few bytes.
        unpacker = lz4.frame.LZ4FrameDecompressor()
        data = unpacker.decompress(data, max_length=chunk.uncompressed_size + 1)
    elif chunk.compression:
        raise ValueError(f"a chunk packed by {chunk.compression[:20]!r}, zstd and lz4 are read")
    if len(data) != chunk.uncompressed_size:
        raise ValueError("a chunk of another size than it says")
    if chunk.uncompressed_crc and zlib.crc32(data) != chunk.uncompressed_crc:
        raise ValueError("a chunk whose checksum is wrong")
    return data


def _allowance(size: int) -> _Allowance:
    """Return what a file of some bytes may unpack to."""
    return _Allowance(MOST_TIMES * size + BESIDES[0], size // LEAST_PACKED + BESIDES[1])


def _messages(
    data: bytes, channels: dict[int, str | None], topics: Sequence[str], allowance: _Allowance
) -> Iterator[Message]:
    for opcode, content in _parts(data, allowance):
        message = _taken(opcode, content, channels, topics)
        if message is not None:
            yield message


def _parts(data: bytes, allowance: _Allowance) -> Iterator[tuple[int, bytes]]:
    """Return operation and content of each record of a chunk."""
    at, end, told = 0, len(data), 0
    allowance.data -= end
    while at < end:
        opcode, length = _FRAME.unpack_from(data, at)
        at += _FRAME.size
        if length > end - at:
            raise EOFError("a record of a chunk breaks off")
        if opcode not in _IN_CHUNKS:
            raise ValueError(f"a chunk with a record of kind {opcode}, which has no place there")
        allowance.records -= 1
        if allowance.data < 0 or allowance.records < 0:
            raise ValueError("it unpacks to more than a file of its size may")
        told += opcode != Opcode.MESSAGE
        if told > 2 * MOST_CHANNELS:
            raise ValueError(f"a chunk that tells more than {MOST_CHANNELS} channels and schemas")
        yield opcode, data[at : at + length]
        at += length


def _taken(
    opcode: int, content: bytes, channels: dict[int, str | None], topics: Sequence[str]
) -> Message | None:
    """Return a message of the topics; learn a channel."""
    if opcode == Opcode.MESSAGE:
        number, _, log_ns, publish_ns = _MESSAGE.unpack_from(content)
        if number not in channels:
            raise ValueError("a message of a channel that was not told before")
        topic = channels[number]
        if topic is not None:
            return Message(topic, log_ns, publish_ns, content[_MESSAGE.size :])
    elif opcode == Opcode.CHANNEL:
        channel = Channel.read(ReadDataStream(BytesIO(content)))
        channels[channel.id] = channel.topic if channel.topic in topics else None
        if len(channels) > MOST_CHANNELS:
            raise ValueError(f"more than {MOST_CHANNELS} channels")
    return None


def _line(error: Exception) -> str:
    return " ".join(str(error).split())[:200] or type(error).__name__
