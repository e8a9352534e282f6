"""JSON that a stranger may have written: read, or refused with its place and line."""

import json
from typing import Any, Final

from treadwell.errors import InputError

DEEPEST: Final = 100
"""Lists and tables within each other; what works through a value may recurse into it."""


def json_of(text: str | bytes, place: str, *, strict: bool = True) -> Any:  # noqa: ANN401 - any JSON
    """Return what a JSON text says.

    Args:
        text: UTF-8 where it is bytes.
        place: what the message begins with: the file, and which part of it; the line is added
            where the text has several.
        strict: refuse what Python reads beyond JSON, too: numbers that are not finite, and halves
            of characters, which cannot be written again.

    Raises:
        InputError: it is no JSON, not UTF-8, or nested too deep.
    """
    try:
        decoded = text if isinstance(text, str) else text.decode()
        constant = _no_number if strict else float
        value = json.loads(
            decoded, parse_constant=constant, parse_float=_finite if strict else float
        )
        if strict and "\\ud" in decoded.lower():
            json.dumps(value, ensure_ascii=False).encode()
    except json.JSONDecodeError as error:
        at = f": line {error.lineno}" if "\n" in error.doc else ""
        raise InputError(f"{place}{at}: not JSON: {error.msg}") from None
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        raise InputError(f"{place}: line {line}: not UTF-8") from None
    except UnicodeEncodeError:
        raise InputError(f"{place}: not JSON: half a character") from None
    except RecursionError:
        raise InputError(f"{place}: nested too deep") from None
    except ValueError as error:
        raise InputError(f"{place}: not JSON: {str(error)[:200]}") from None
    if _is_deep(value):
        raise InputError(f"{place}: nested too deep")
    return value


def _is_deep(value: object) -> bool:
    level = [value]
    for _ in range(DEEPEST):
        tables = [item.values() for item in level if isinstance(item, dict)]
        lists = [item for item in level if isinstance(item, list)]
        level = [inner for items in (*tables, *lists) for inner in items]
        if not level:
            return False
    return True


def _finite(text: str) -> float:
    number = float(text)
    return number + 0.0 if abs(number) != float("inf") else _no_number(text)


def _no_number(text: str) -> float:
    raise ValueError(f"{text[:60]} is no finite number")
