"""Claims about JSON of strangers: it is read, or refused with its place."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from treadwell.careful_json import DEEPEST, json_of
from treadwell.errors import InputError

PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=20,
)  # fmt: skip


@given(PLAIN)
def test_what_was_written_is_read(value: object) -> None:
    assert json_of(json.dumps(value), "x") == value
    assert json_of(json.dumps(value, ensure_ascii=False).encode(), "x") == value


@pytest.mark.parametrize(
    "text", ["[" * 10_000 + "]" * 10_000, '{"a":' * 10_000 + "1" + "}" * 10_000]
)
@pytest.mark.parametrize("depth", [DEEPEST + 1, 10_000])
def test_what_is_nested_too_deep_is_refused(text: str, depth: int) -> None:
    text = "[" * depth + "]" * depth if depth < 10_000 else text
    with pytest.raises(InputError, match=r"^file: nested too deep$"):
        json_of(text, "file")


def test_what_is_nested_as_deep_as_allowed_is_read() -> None:
    assert json_of("[" * DEEPEST + "]" * DEEPEST, "file")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (b'{"a": 1,\n"b": }', "file: line 2: not JSON: "),
        (b'{"a": 1,\n"\xff": 2}', "file: line 2: not UTF-8"),
        (b"[NaN]", "NaN is no finite number"),
        (b"[1e999]", "1e999 is no finite number"),
        (b'["\\ud800"]', "half a character"),
        (b"1" * 5000, "not JSON: Exceeds the limit"),
        (b"", "file: not JSON: Expecting value"),
    ],
)
def test_what_is_no_json_is_refused_with_its_place(text: bytes, said: str) -> None:
    with pytest.raises(InputError) as error:
        json_of(text, "file")
    assert said in str(error.value)


def test_what_python_reads_beyond_json_is_taken_where_it_does_no_harm() -> None:
    assert str(json_of(b'[NaN, 1e999, "\\ud800"]', "file", strict=False)) == "[nan, inf, '\\ud800']"


def test_nothing_less_than_nothing_is_nothing() -> None:
    assert str(json_of("[-0.0]", "file")) == "[0.0]"
