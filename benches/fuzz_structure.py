"""Changes files by their structure: values, keys, types of tables, elements, records of logs."""

import copy
import json
import struct
import tomllib
import zlib
from typing import Any, Final
from xml.etree import ElementTree

import lz4.frame
import numpy as np
import tomli_w
import zstandard

VALUES: Final[tuple[Any, ...]] = (
    0, 1, -1, 2**31, 2**53, 2**63 - 1, -(2**63), 0.0, -0.0, 5e-324, 1e-300, 1e308, -1e308, 0.5, 1e9,
    float("nan"), float("inf"), "", "x", "../x", "\0", "é" * 300, "nan", True, False, [], {}, [[]],
    [0.0, -0.0], [1.0] * 200, {"x": {"x": {}}}, "navigation", "qrio", "box", "stairs", "a.b:C",
)  # fmt: skip
"""What a value becomes."""
WORDS: Final = (
    "",
    "x",
    "nan",
    "-1",
    "0",
    "1e308",
    "1e-308",
    "2147483648",
    "true",
    "0 0 0",
    "1 1 1 1",
)
"""What an attribute becomes."""
FACTORS: Final = (-1.0, 0.0, 0.5, 2.0, 10.0, 1000.0, 1e-6)
DEEP: Final = 30
_MAGIC: Final = b"\x89MCAP0\r\n"
_CHUNK, _MESSAGE = 6, 5


def places(value: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:  # noqa: ANN401
    """Return where there is a value in plain data, tables and lists among them."""
    found = [path] if path else []
    if isinstance(value, dict):
        for key, item in value.items():
            found += places(item, (*path, key))
    elif isinstance(value, list):
        for index, item in enumerate(value[:20]):
            found += places(item, (*path, index))
    return found


def changed_table(table: dict[str, Any], random: np.random.Generator) -> dict[str, Any]:
    """Return plain data with one to four values, keys or types changed."""
    made: dict[str, Any] = json.loads(json.dumps(table))
    for _ in range(int(random.integers(1, 5))):
        there = places(made)
        if not there:
            return made
        path = there[int(random.integers(len(there)))]
        place: Any = made
        for key in path[:-1]:
            place = place[key]
        _change(made, place, path, random)
    return made


def _change(made: dict[str, Any], place: Any, path: tuple[Any, ...], random: Any) -> None:  # noqa: ANN401
    """Change what stands at a place of a table or list."""
    key, kind = path[-1], int(random.integers(0, 10))
    old = place[key]
    if kind == 0:
        del place[key]
    elif kind == 1 and isinstance(place, dict):
        place[f"{key}x"] = place.pop(key)
    elif kind == 2 and isinstance(place, list):
        place[key:key] = [old] * int(random.integers(1, 30))
    elif kind == 3:
        there = places(made)
        other: Any = made
        for word in there[int(random.integers(len(there)))]:
            other = other[word]
        place[key] = json.loads(json.dumps(other))
    elif kind == 4:
        for _ in range(int(random.integers(1, DEEP))):
            old = [old] if random.random() < 0.5 else {"x": old}
        place[key] = old
    elif kind == 5 and isinstance(old, int | float) and not isinstance(old, bool):
        place[key] = type(old)(old * float(random.choice([-1.0, 0.5, 2.0, 10.0, 1000.0])))
    else:
        place[key] = copy.deepcopy(VALUES[int(random.integers(len(VALUES)))])


def toml_of(content: bytes, random: np.random.Generator) -> bytes:
    """Return a TOML file with its tables changed."""
    return tomli_w.dumps(changed_table(tomllib.loads(content.decode()), random)).encode()


def json_of(content: bytes, random: np.random.Generator) -> bytes:
    """Return a JSON file with its tables changed; of several lines, each by itself."""
    text = content.decode()
    lines = text.splitlines() if text.startswith("{") and "\n{" in text else [text]
    at = int(random.integers(len(lines)))
    lines[at] = json.dumps(changed_table(json.loads(lines[at]), random))
    return "".join(f"{line}\n" for line in lines).encode()


def xml_of(content: bytes, random: np.random.Generator) -> bytes:
    """Return an MJCF with one to four of its elements or their attributes changed."""
    root = ElementTree.fromstring(content.decode())
    for _ in range(int(random.integers(1, 5))):
        below = [(parent, child) for parent in root.iter() for child in parent]
        if not below:
            break
        parent, child = below[int(random.integers(len(below)))]
        kind = int(random.integers(0, 9))
        other = below[int(random.integers(len(below)))][0]
        if kind == 0:
            parent.remove(child)
        elif kind == 1:
            parent.append(copy.deepcopy(child))
        elif kind == 2 and other not in set(child.iter()):
            parent.remove(child)
            other.append(child)
        elif child.attrib:
            _change_attribute(child, kind, random)
    return ElementTree.tostring(root)


def _change_attribute(element: ElementTree.Element, kind: int, random: np.random.Generator) -> None:
    key = list(element.attrib)[int(random.integers(len(element.attrib)))]
    words = element.attrib[key].split()
    if kind == 3:
        del element.attrib[key]
    elif kind == 4 or not words:
        element.attrib[key] = WORDS[int(random.integers(len(WORDS)))]
    else:
        at = int(random.integers(len(words)))
        try:
            words[at] = repr(float(words[at]) * FACTORS[int(random.integers(len(FACTORS)))])
        except ValueError:
            words[at] += "x"
        element.attrib[key] = " ".join(words)


def hello_of(content: bytes, random: np.random.Generator) -> bytes:
    """Return a message whose header's table is changed."""
    header = json.dumps(changed_table(json.loads(content[8:]), random)).encode()
    return struct.pack("<Q", len(header)) + header


Records = list[tuple[int, bytes]]


def _records(content: bytes) -> Records:
    """Return operation and content of each record."""
    found, at = [], 0
    while at + 9 <= len(content):
        opcode, length = struct.unpack_from("<BQ", content, at)
        found.append((opcode, content[at + 9 : at + 9 + length]))
        at += 9 + length
    return found


def _bytes(records: Records) -> bytes:
    return b"".join(struct.pack("<BQ", code, len(content)) + content for code, content in records)


def _unpacked(content: bytes) -> tuple[bytes, Records]:
    """Return a chunk's times, and the records in it."""
    (size, length) = struct.unpack_from("<QxxxxI", content, 16)
    kind, data = content[32 : 32 + length], content[40 + length :]
    plain = zstandard.decompress(data, max_output_size=size) if kind == b"zstd" else data
    return content[:16], _records(plain)


def _packed(times: bytes, records: Records, random: np.random.Generator) -> bytes:
    """Return a chunk, packed in one of the ways."""
    plain = _bytes(records)
    kind = int(random.integers(3))
    name = (b"", b"zstd", b"lz4")[kind]
    data = (plain, zstandard.compress(plain), lz4.frame.compress(plain))[kind]
    size = len(plain) + int(random.choice([0, 0, 0, 0, 1, -1, 2**40]))
    check = zlib.crc32(plain) if random.random() < 0.9 else int(random.integers(2**32))
    head = struct.pack("<QII", max(0, size), check, len(name))
    return times + head + name + struct.pack("<Q", len(data)) + data


def _shuffled(records: Records, random: np.random.Generator) -> Records:
    """Return records with one dropped, doubled, moved or changed within."""
    made, at = list(records), int(random.integers(len(records)))
    code, content = made[at]
    kind = int(random.integers(0, 6))
    if kind == 0:
        del made[at]
    elif kind == 1:
        made[at:at] = [made[at]] * int(random.integers(1, 4))
    elif kind == 2:
        made.insert(int(random.integers(len(made))), made.pop(at))
    elif kind == 3:
        made[at] = (int(random.integers(0, 18)), content)
    elif kind == 4 and code == _MESSAGE:
        head = [int(random.choice([0, 1, 2**16 - 1])), 0, *map(int, random.integers(0, 2**62, 2))]
        made[at] = (code, struct.pack("<HIQQ", *head) + content[22:])
    else:
        body = bytearray(content)
        for _ in range(int(random.integers(1, 4))):
            if body:
                body[int(random.integers(len(body)))] = int(random.integers(256))
        cut = int(random.integers(len(body) + 1)) if random.random() < 0.3 else len(body)
        made[at] = (code, bytes(body[:cut]))
    return made


def log_of(content: bytes, random: np.random.Generator) -> bytes:
    """Return an MCAP file with its records changed, outside and inside of chunks."""
    records = _records(content[len(_MAGIC) : -len(_MAGIC)])
    made: Records = []
    for code, body in records:
        if code != _CHUNK:
            made.append((code, body))
            continue
        times, inner = _unpacked(body)
        if inner and random.random() < 0.7:
            inner = _shuffled(inner, random)
        made.append((code, _packed(times, inner, random)))
    if random.random() < 0.3:
        made = _shuffled(made, random)
    return _MAGIC + _bytes(made) + _MAGIC
