"""Counts the numbers of the core that are no settings, and type names that stand for two things.

Counted are float literals outside of tests, of the bindings and of the defaults of settings
(`settings!`, `impl Default`), where they are not 0, 1, 2, 0.5 or a power of ten: in `const` and
`static`, and inline. Code lines are those of `rust/` and `python/` without tests, comments,
docstrings, blank lines and declarations of settings.
"""

import ast
import io
import re
import tokenize
from collections import Counter, defaultdict
from dataclasses import dataclass

from rust_source import ROOT, Source, blank, item_end, sources, without_tests

_FLOAT = re.compile(
    r"(?<![\w.])(\d[\d_]*\.\d[\d_]*(?:[eE][+-]?\d+)?|\d[\d_]*[eE][+-]?\d+|\d[\d_]*(?=_?f(?:32|64)\b))(?:_?f(?:32|64))?\b"
)
_CONST = re.compile(r"\b(?:const|static)\s+(?:mut\s+)?\w+\s*:")
_SETTINGS = re.compile(r"\bsettings!\s*\{|\bimpl(?:<[^>]*>)?\s+Default\s+for\b")
_TYPE = re.compile(r"\b(?:struct|enum|trait|union)\s+([A-Z]\w*)|\btype\s+([A-Z]\w*)[^=;{]*=[^;]*;")


@dataclass(frozen=True)
class Literal:
    """A float literal that is no default of a setting."""

    place: str
    text: str
    constant: bool


def is_unit(text: str) -> bool:
    """Whether a literal is 0, 1, 2, 0.5 or a power of ten: it tunes nothing."""
    value = float(text.replace("_", ""))
    return value in (0.0, 2.0, 0.5) or bool(
        re.fullmatch(r"1e[+-]\d+", f"{value:e}".replace(".000000", ""))
    )


def _declared(text: str) -> list[tuple[int, int]]:
    """Return where settings are declared."""
    return [(found.start(), item_end(text, found.start())) for found in _SETTINGS.finditer(text)]


def literals(source: Source) -> list[Literal]:
    """Return the literals of a file that count."""
    declared = _declared(source.text)
    constants = [
        (found.start(), item_end(source.text, found.end()))
        for found in _CONST.finditer(source.text)
    ]
    found = []
    for match in _FLOAT.finditer(source.text):
        at = match.start()
        if is_unit(match.group(1)) or any(a <= at < b for a, b in declared):
            continue
        constant = any(a <= at < b for a, b in constants)
        place = f"{source.name}:{source.line(at)}"
        found.append(Literal(place, match.group(), constant))
    return found


def type_names() -> dict[str, list[str]]:
    """Return the names that more than one type of the core has, with where each stands."""
    places = defaultdict(list)
    for source in sources():
        inside = _trait_and_impl_bodies(source.text)
        for match in _TYPE.finditer(source.text):
            if any(a < match.start() < b for a, b in inside):
                continue  # an associated type
            name = match.group(1) or match.group(2)
            places[name].append(f"{source.name}:{source.line(match.start())}")
    return {name: found for name, found in sorted(places.items()) if len(found) > 1}


def _trait_and_impl_bodies(text: str) -> list[tuple[int, int]]:
    return [
        (found.start(), item_end(text, found.start()))
        for found in re.finditer(r"^\s*(?:unsafe\s+)?impl\b|\btrait\s+\w+", text, re.MULTILINE)
    ]


def rust_lines() -> int:
    """Return the lines of code in `rust/`."""
    bindings = sorted((ROOT / "rust" / "bindings" / "src").rglob("*.rs"))
    texts = [source.text for source in sources()]
    texts += [without_tests(blank(path.read_text())) for path in bindings]
    count = 0
    for text in texts:
        for begin, end in reversed(_declared(text)):
            text = text[:begin] + re.sub(r"[^\n]", " ", text[begin:end]) + text[end:]
        count += sum(bool(line.strip()) for line in text.splitlines())
    return count


def python_lines() -> int:
    """Return the lines of code in `python/`."""
    count = 0
    for path in sorted((ROOT / "python").rglob("*.py")):
        if "reference" in path.parts:  # makes pages and schemas of what the code says
            continue
        text = path.read_text()
        said: set[int] = set()
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
                said.update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
        skipped = (
            tokenize.COMMENT,
            tokenize.NL,
            tokenize.NEWLINE,
            tokenize.INDENT,
            tokenize.DEDENT,
        )
        lines: set[int] = set()
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            if token.type not in (*skipped, tokenize.ENDMARKER):
                lines.update(range(token.start[0], token.end[0] + 1))
        count += len(lines - said)
    return count


def counts() -> list[str]:
    """Return the counts, a line each."""
    every = [(source, one) for source in sources() for one in literals(source)]
    by_crate = Counter((source.crate, one.constant) for source, one in every)
    lines = [
        f"{crate:16s} const {by_crate[crate, True]:4d}  inline {by_crate[crate, False]:4d}"
        for crate in sorted({crate for crate, _ in by_crate})
    ]
    constants = sum(one.constant for _, one in every)
    inline = len(every) - constants
    lines += [
        f"float literals outside settings: {len(every)} ({constants} const, {inline} inline)",
        f"type names with two meanings: {len(type_names())}",
        f"code lines: rust {rust_lines()}, python {python_lines()}",
    ]
    return lines


def places() -> list[str]:
    """Return where each literal stands that counts."""
    every = [one for source in sources() for one in literals(source)]
    return [f"{one.place}: {one.text}{'  const' if one.constant else ''}" for one in every]
