"""Writing an MCAP file, byte for byte as the `mcap` package does, in a quarter of its time.

That package makes an object of each message and writes its head number by number. Here messages
are packed as they come; what is rare is left to the package's own records.
"""

import struct
import zlib
from collections import defaultdict
from collections.abc import Iterable, Mapping
from typing import BinaryIO, Final

import zstandard
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)

Entry = tuple[int, int, int, bytes]
"""A message: its channel, log time and publish time, ns, and what it says."""
_MAGIC: Final = b"\x89MCAP0\r\n"
_MESSAGE: Final = struct.Struct("<BQHIQQ")
_MESSAGE_BYTES: Final = 22
"""Of a message's record, beside what it says."""
_MESSAGE_KIND: Final = int(Opcode.MESSAGE)


class LogWriter:
    """Writes a file whose chunks are packed by zstd."""

    def __init__(self, file: BinaryIO, chunk_bytes: int, profile: str, library: str) -> None:
        """Begin the file.

        Args:
            file: to write into, from where it stands.
            chunk_bytes: a chunk ends behind the message with which it has more.
            profile: what the file says of its messages.
            library: what it says of its writer.

        Raises:
            OSError: the file cannot be written.
        """
        self._file, self._chunk_bytes = file, chunk_bytes
        self._schemas: list[Schema] = []
        self._channels: list[Channel] = []
        self._attachments: list[AttachmentIndex] = []
        self._metadata: list[MetadataIndex] = []
        self._chunks: list[bytes] = []
        """Their records in the summary: an object of each would take eight times as much."""
        self._counts: dict[int, int] = {}
        self._first_ns, self._last_ns = 0, 0
        self._begin_chunk()
        file.write(_MAGIC + _record(Header(profile=profile, library=library)))

    def add_channel(self, topic: str, schema: str, definition: str) -> int:
        """Add a channel of CDR messages, and return its number.

        Args:
            topic: its name.
            schema: name of the ROS 2 message.
            definition: of the same.
        """
        number = len(self._channels) + 1
        told = Schema(id=number, name=schema, encoding="ros2msg", data=definition.encode())
        channel = Channel(
            id=number, topic=topic, message_encoding="cdr", metadata={}, schema_id=number
        )
        self._schemas.append(told)
        self._channels.append(channel)
        self._parts += (_record(told), _record(channel))
        self._size += len(self._parts[-2]) + len(self._parts[-1])
        return number

    def add_metadata(self, name: str, words: Mapping[str, str]) -> None:
        """Write metadata.

        Raises:
            OSError: the file cannot be written.
        """
        offset, record = self._file.tell(), _record(Metadata(name=name, metadata=dict(words)))
        self._metadata.append(MetadataIndex(length=len(record), name=name, offset=offset))
        self._file.write(record)

    def add_attachment(self, name: str, media_type: str, content: bytes) -> None:
        """Write an attachment.

        Raises:
            OSError: the file cannot be written.
        """
        offset = self._file.tell()
        told = Attachment(create_time=0, log_time=0, name=name, media_type=media_type, data=content)
        record = _record(told)
        self._attachments.append(
            AttachmentIndex(
                offset=offset,
                length=len(record),
                log_time=0,
                create_time=0,
                data_size=len(content),
                name=name,
                media_type=media_type,
            )
        )
        self._file.write(record)

    def add_messages(self, entries: Iterable[Entry]) -> None:
        """Add messages, each after the one before.

        Raises:
            OSError: the file cannot be written.
        """
        pack, head_bytes = _MESSAGE.pack, _MESSAGE.size
        for channel, log_ns, publish_ns, data in entries:
            content = len(data)
            self._indexes[channel] += (log_ns, self._size)
            self._parts += (
                pack(_MESSAGE_KIND, _MESSAGE_BYTES + content, channel, 0, log_ns, publish_ns),
                data,
            )
            self._size += head_bytes + content
            if self._size > self._chunk_bytes:
                self._end_chunk()

    def flush(self) -> None:
        """End the chunk, so that what was added is in the file.

        Raises:
            OSError: the file cannot be written.
        """
        self._end_chunk()
        self._file.flush()

    def finish(self) -> None:
        """Write what is left and the summary.

        Raises:
            OSError: the file cannot be written.
        """
        self._end_chunk()
        self._file.write(_record(DataEnd(data_section_crc=0)))
        begin, summary, offsets = self._file.tell(), b"", b""
        groups: list[tuple[int, Iterable[bytes]]] = [
            (Opcode.SCHEMA, map(_record, self._schemas)),
            (Opcode.CHANNEL, map(_record, self._channels)),
            (Opcode.STATISTICS, [_record(self._statistics())]),
            (Opcode.CHUNK_INDEX, self._chunks),
            (Opcode.ATTACHMENT_INDEX, map(_record, self._attachments)),
            (Opcode.METADATA_INDEX, map(_record, self._metadata)),
        ]
        for opcode, records in groups:
            group = b"".join(records)
            offsets += _record(
                SummaryOffset(
                    group_opcode=opcode,
                    group_start=begin + len(summary),
                    group_length=len(group),
                )
            )
            summary += group
        there = begin + len(summary)
        foot = struct.pack("<BQQQ", Opcode.FOOTER, 20, begin, there)
        crc = zlib.crc32(summary + offsets + foot)
        end = Footer(summary_start=begin, summary_offset_start=there, summary_crc=crc)
        self._file.write(summary + offsets + _record(end) + _MAGIC)

    def _begin_chunk(self) -> None:
        self._parts: list[bytes] = []
        self._size = 0
        self._indexes: defaultdict[int, list[int]] = defaultdict(list)
        """Of each channel log time and place of its messages, one after the other."""

    def _end_chunk(self) -> None:
        if not self._indexes:
            return
        content = b"".join(self._parts)
        packed = zstandard.compress(content)
        first = min(min(index[::2]) for index in self._indexes.values())
        last = max(max(index[::2]) for index in self._indexes.values())
        self._first_ns = first if not self._chunks else min(self._first_ns, first)
        self._last_ns = max(self._last_ns, last)
        chunk = _record(
            Chunk(
                compression="zstd",
                data=packed,
                message_end_time=last,
                message_start_time=first,
                uncompressed_crc=zlib.crc32(content),
                uncompressed_size=len(content),
            )
        )
        begin = self._file.tell()
        offsets, indexes = {}, b""
        for channel, index in self._indexes.items():
            self._counts[channel] = self._counts.get(channel, 0) + len(index) // 2
            offsets[channel] = begin + len(chunk) + len(indexes)
            entries = struct.pack(f"<{len(index)}Q", *index)
            head = struct.pack(
                "<BQHI", Opcode.MESSAGE_INDEX, 6 + len(entries), channel, len(entries)
            )
            indexes += head + entries
        indexed = ChunkIndex(
            chunk_length=len(chunk),
            chunk_start_offset=begin,
            compression="zstd",
            compressed_size=len(packed),
            message_end_time=last,
            message_index_length=len(indexes),
            message_index_offsets=offsets,
            message_start_time=first,
            uncompressed_size=len(content),
        )
        self._chunks.append(_record(indexed))
        self._begin_chunk()
        self._file.write(chunk + indexes)

    def _statistics(self) -> Statistics:
        return Statistics(
            attachment_count=len(self._attachments),
            channel_count=len(self._channels),
            channel_message_counts=self._counts,
            chunk_count=len(self._chunks),
            message_count=sum(self._counts.values()),
            message_end_time=self._last_ns,
            message_start_time=self._first_ns,
            metadata_count=len(self._metadata),
            schema_count=len(self._schemas),
        )


def _record(record: McapRecord) -> bytes:
    builder = RecordBuilder()
    record.write(builder)
    content: bytes = builder.end()  # type: ignore[no-untyped-call]
    return content
