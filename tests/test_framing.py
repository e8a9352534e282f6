"""The framing: whatever is sent arrives, and whatever else arrives is refused by one error."""

import io
import json
import struct
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays_of

from treadwell.serving import framing
from treadwell.serving.framing import (
    DTYPES,
    LONGEST_HEADER,
    MOST_ARRAYS,
    MOST_BYTES,
    Message,
    ProtocolError,
    pack,
    read_message,
)

TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=12)
FINITE = st.floats(allow_nan=False, allow_infinity=False)
NUMBER = st.one_of(st.integers(-(2**70), 2**70), FINITE)
VALUE = st.recursive(
    st.one_of(st.none(), st.booleans(), NUMBER, TEXT),
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(TEXT, inner, max_size=4)),
    max_leaves=12,
)
HEADER = st.dictionaries(TEXT.filter(lambda key: key != "arrays"), VALUE, max_size=6)
ARRAY = st.sampled_from(DTYPES).flatmap(
    lambda dtype: arrays_of.arrays(
        np.dtype(dtype), arrays_of.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=4)
    )
)
ARRAYS = st.dictionaries(TEXT, ARRAY, max_size=4)


def read(data: bytes) -> Message | None:
    return read_message(io.BytesIO(data).read)


def outcome(data: bytes) -> Message | str | None:
    """What is read, or the message of the one error that may be."""
    try:
        return read(data)
    except ProtocolError as error:
        return str(error)


def is_one_message(found: Message | str | None) -> bool:
    return isinstance(found, Message) or (isinstance(found, str) and found.isprintable())


def raw(header: Any, rest: bytes = b"") -> bytes:  # noqa: ANN401
    text = header if isinstance(header, bytes) else json.dumps(header).encode()
    return struct.pack("<Q", len(text)) + text + rest


@settings(deadline=None)
@given(HEADER, ARRAYS)
def test_what_is_sent_arrives(header: dict[str, Any], arrays: dict[str, np.ndarray]) -> None:
    stream = io.BytesIO(pack(header, arrays) + pack({}, {}))
    told = read_message(stream.read)
    assert told is not None
    assert told.header == header
    assert list(told.arrays) == list(arrays)
    for name, array in arrays.items():
        found = told.arrays[name]
        assert (found.dtype, found.shape) == (array.dtype, array.shape)
        assert found.tobytes() == array.tobytes()
        assert found.flags.writeable
    following = read_message(stream.read)
    assert following is not None
    assert (following.header, following.arrays) == ({}, {})
    assert read_message(stream.read) is None


@settings(deadline=None)
@given(HEADER, ARRAYS, st.data())
def test_what_breaks_off_is_the_named_error(
    header: dict[str, Any], arrays: dict[str, np.ndarray], data: st.DataObject
) -> None:
    whole = pack(header, arrays)
    end = data.draw(st.integers(1, len(whole) - 1))
    with pytest.raises(ProtocolError, match="the connection ended within"):
        read(whole[:end])


@settings(deadline=None, max_examples=300)
@given(HEADER, ARRAYS, st.data())
def test_altered_bytes_are_another_message_or_the_named_error(
    header: dict[str, Any], arrays: dict[str, np.ndarray], data: st.DataObject
) -> None:
    altered = bytearray(pack(header, arrays))
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, len(altered) - 1))
        altered[place] = data.draw(st.integers(0, 255))
    assert is_one_message(outcome(bytes(altered)))


@settings(deadline=None, max_examples=300)
@given(st.one_of(st.binary(max_size=200), VALUE.map(raw), st.binary(max_size=50).map(raw)))
def test_any_bytes_are_a_message_or_the_named_error(data: bytes) -> None:
    found = outcome(data)
    assert is_one_message(found) or (found is None and data == b"")


LISTED = st.fixed_dictionaries(
    {
        "name": st.one_of(TEXT, VALUE),
        "dtype": st.one_of(st.sampled_from(DTYPES), VALUE),
        "shape": st.one_of(st.lists(st.integers(-2, 2**70), max_size=10), VALUE),
    }
)


@settings(deadline=None, max_examples=300)
@given(st.one_of(VALUE, st.lists(st.one_of(LISTED, VALUE), max_size=4)), st.binary(max_size=64))
def test_any_list_of_arrays_is_read_or_refused(listed: object, rest: bytes) -> None:
    found = outcome(raw({"arrays": listed}, rest))
    assert is_one_message(found)
    if isinstance(found, Message):
        assert sum(array.nbytes for array in found.arrays.values()) <= len(rest)


def entry(**changes: object) -> dict[str, object]:
    return {"name": "a", "dtype": "uint8", "shape": [2], **changes}


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (struct.pack("<Q", 10**10), "a header of 10000000000 bytes; at most 1000000"),
        (b"GET / HTTP/1.1\r\n\r\n", "a message begins with the length of its header"),
        (raw(b""), "not JSON"),
        (raw(b"{"), "not JSON"),
        (raw(b"\xff\xfe"), "not UTF-8"),
        (raw(b'{"a": NaN}'), "NaN is no finite number"),
        (raw(b"[" * 5000), "nested too deep"),
        (raw([1]), "must be a JSON object"),
        (raw({"arrays": 1}), "must be a list"),
        (raw({"arrays": [entry()] * (MOST_ARRAYS + 1)}), "a list of up to 32"),
        (raw({"arrays": [{}]}), "arrays.0: must be a table of name, dtype and shape"),
        (raw({"arrays": [entry(dtype="float6")]}), "did you mean 'float64'?"),
        (raw({"arrays": [entry(dtype="object")]}), "must be one of float64"),
        (raw({"arrays": [entry(shape=[-1])]}), "whole numbers"),
        (raw({"arrays": [entry(shape=[1.0])]}), "whole numbers"),
        (raw({"arrays": [entry(shape=[True])]}), "whole numbers"),
        (raw({"arrays": [entry(shape=[1] * 9)]}), "up to 8"),
        (raw({"arrays": [entry(shape=[MOST_BYTES + 1])]}), "more than 67108864 bytes"),
        (raw({"arrays": [entry(shape=[0, 10**30])]}), "more than 67108864 bytes"),
        (raw({"arrays": [entry(shape=[MOST_BYTES]), entry(name="b")]}), "arrays of 67108866 bytes"),
        (raw({"arrays": [entry(), entry()]}, b"1234"), "two of them have one name"),
        (raw({"arrays": [entry()]}, b"1"), "within the array 'a': 1 of 2 bytes came"),
    ],
)
def test_each_fault_is_named(data: bytes, message: str) -> None:
    with pytest.raises(ProtocolError) as caught:
        read(data)
    assert message in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


def test_nothing_is_asked_for_that_will_be_refused() -> None:
    asked: list[int] = []

    def receive(count: int) -> bytes:
        asked.append(count)
        return struct.pack("<Q", 10**10)[:count]

    with pytest.raises(ProtocolError):
        read_message(receive)
    assert asked == [8]


@pytest.mark.parametrize(
    ("header", "arrays", "message"),
    [
        ({"arrays": []}, {}, "is made here"),
        ({"a": float("nan")}, {}, "not JSON"),
        ({"a": object()}, {}, "not JSON"),
        ({"a": "\ud800"}, {}, "not JSON"),
        ({}, {"a": np.array([None])}, 'dtype: found "object"'),
        ({"a": "x" * LONGEST_HEADER}, {}, "a header of"),
        ({}, {"a": np.zeros(2, np.complex128)}, 'dtype: found "complex128"'),
        ({}, {"a": np.zeros(2, bool)}, 'dtype: found "bool"'),
        ({}, {"a": np.array(["x"])}, 'dtype: found "str32"'),
        ({}, {str(i): np.zeros(1) for i in range(MOST_ARRAYS + 1)}, "a list of up to"),
    ],
)
def test_what_no_message_holds_is_not_packed(
    header: dict[str, Any], arrays: dict[str, np.ndarray], message: str
) -> None:
    with pytest.raises(ProtocolError, match=message):
        pack(header, arrays)


def test_the_bytes_are_little_endian_whatever_the_arrays_order() -> None:
    numbers = np.array([[1.0, 2.0], [3.0, 4.0]], ">f8")
    data = pack({"type": "x"}, {"a": numbers.T})
    (length,) = framing.PREFIX.unpack(data[:8])
    listed = [{"name": "a", "dtype": "float64", "shape": [2, 2]}]
    assert json.loads(data[8 : 8 + length]) == {"type": "x", "arrays": listed}
    assert data[8 + length :] == struct.pack("<4d", 1.0, 3.0, 2.0, 4.0)
