"""What a JSON schema says, in words."""

import json
import re
from collections.abc import Mapping
from typing import Any, Final

_KINDS: Final = {
    "object": "table",
    "array": "list",
    "null": "none",
    "integer": "whole number",
    "string": "text",
    "boolean": "true or false",
}
_LIMITS: Final = (
    ("minimum", ">="),
    ("exclusiveMinimum", ">"),
    ("maximum", "<="),
    ("exclusiveMaximum", "<"),
    ("minLength", "letters >="),
    ("maxLength", "letters <="),
)


def escaped(page: str) -> str:
    """Return a page on which the star of A*, D* and their like, outside of code, is no emphasis."""
    parts = re.split(r"(`[^`\n]*`)", page)
    parts[::2] = [re.sub(r"(?<=[A-Z])\*(?!\*)", r"\\*", part) for part in parts[::2]]
    return "".join(parts)


def shown(value: object) -> str:
    """Return a value as TOML would have it."""
    return "" if value is None else json.dumps(value, ensure_ascii=False)


def kind(schema: Mapping[str, Any]) -> str:
    """Return what a value is: a number, a text, a table of some name."""
    if "$ref" in schema:
        return str(schema["$ref"]).rpartition("/")[2]
    if "const" in schema or "enum" in schema:
        return "word"
    options = schema.get("anyOf") or schema.get("oneOf")
    if options:
        found = dict.fromkeys(kind(option) for option in options)
        return " or ".join(word for word in found if word != "none") or "none"
    if schema.get("type") == "array":
        if "prefixItems" in schema:
            return f"list of {len(schema['prefixItems'])}"
        return f"list of {kind(schema.get('items', {}))}"
    word = str(schema.get("type", "anything"))
    return _KINDS.get(word, word)


def allowed(schema: Mapping[str, Any]) -> str:
    """Return what a value may be; nothing where all of its kind are allowed."""
    if "const" in schema:
        return f"`{schema['const']}`"
    if "enum" in schema:
        return ", ".join(f"`{word}`" for word in schema["enum"])
    options = schema.get("anyOf") or schema.get("oneOf")
    if options and not any("$ref" in option for option in options):
        return "; ".join(filter(None, (allowed(option) for option in options)))
    limits = [f"{sign} {schema[key]:g}" for key, sign in _LIMITS if key in schema]
    if "prefixItems" in schema:
        limits = list(dict.fromkeys(filter(None, map(allowed, schema["prefixItems"]))))
    return ", ".join(limits)
