"""The variants of a sweep: every combination of what `--vary KEY=A,B,C` gives."""

from collections.abc import Sequence
from itertools import product
from typing import Final

from treadwell.errors import InputError
from treadwell.scenario.messages import shortened, shown

MOST_VARIANTS: Final = 1000
_OPENING: Final = {"[": "]", "{": "}"}


def variants(given: Sequence[str]) -> list[tuple[str, ...]]:
    """Return the settings `KEY=VALUE` of each variant; one without settings where nothing varies.

    Args:
        given: `KEY=A,B,C` each; a comma within brackets or quotes parts nothing.

    Raises:
        InputError: one is not of this form, a key or value comes twice, or there are too many.
    """
    axes: list[list[str]] = []
    keys: set[str] = set()
    for text in given:
        key, equals, values = text.partition("=")
        key = key.strip()
        if not equals or not key:
            raise InputError(f"--vary: found {shown(text)}; must be KEY=A,B,C")
        listed = [value.strip() for value in split_values(values)]
        if not all(listed):
            raise InputError(f"--vary {shortened(key)}: found {shown(values)}; a value is missing")
        if key in keys or len(set(listed)) < len(listed):
            raise InputError(f"--vary {shortened(key)}: found {shown(values)}; something is twice")
        keys.add(key)
        axes.append([f"{key}={value}" for value in listed])
    count = 1
    for axis in axes:
        count *= len(axis)
    if count > MOST_VARIANTS:
        raise InputError(f"--vary: {count} variants, {MOST_VARIANTS} are the limit")
    return list(product(*axes))


def split_values(text: str) -> list[str]:
    """Return what stands between the commas that are in no brackets and no quotes."""
    values, value, closing, quote = [], "", [], ""
    for character in text:
        if quote:
            quote = "" if character == quote else quote
        elif character in "\"'":
            quote = character
        elif character in _OPENING:
            closing.append(_OPENING[character])
        elif closing and character == closing[-1]:
            closing.pop()
        elif character == "," and not closing:
            values.append(value)
            value = ""
            continue
        value += character
    return [*values, value]
