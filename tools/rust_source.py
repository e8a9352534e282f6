"""The core's sources as text without comments, strings and tests, each with crate and module."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# What converts for Python, and what is for tests only, decides nothing.
APART = {"bindings", "testkit"}
_TEXT = re.compile(
    r"""//[^\n]* | /\*.*?\*/ | b?r(\#*)".*?"\1 | b?"(?:\\.|[^"\\])*" | '(?:\\[^']+|[^'\\])'""",
    re.VERBOSE | re.DOTALL,
)
_TESTED_ITEM = re.compile(r"#\[cfg\(test\)\]\s*(?:#\[[^\]]*\]\s*)*")
_MODULE = re.compile(r"(?:pub(?:\([^)]*\))?\s+)?mod\s+(\w+)\s*;")


@dataclass(frozen=True)
class Source:
    """One file: `text` is its code; what was taken out is blank, so that lines keep their place."""

    path: Path
    crate: str
    module: tuple[str, ...]
    text: str

    def line(self, at: int) -> int:
        """Return the line of a place in the text."""
        return self.text.count("\n", 0, at) + 1

    @property
    def name(self) -> str:
        """The path as people write it."""
        return str(self.path.relative_to(ROOT))


def sources(crates: set[str] | None = None) -> Iterator[Source]:
    """Yield every file of the core that is no test."""
    for manifest in sorted((ROOT / "rust").glob("*/Cargo.toml")):
        crate = manifest.parent.name
        if crate in APART or (crates is not None and crate not in crates):
            continue
        yield from _modules(manifest.parent / "src" / "lib.rs", crate, ())


def _modules(path: Path, crate: str, module: tuple[str, ...]) -> Iterator[Source]:
    text = without_tests(blank(path.read_text()))
    yield Source(path, crate, module, text)
    inside = path.parent if path.stem in ("lib", "mod") else path.with_suffix("")
    for name in _MODULE.findall(text):
        for below in (inside / f"{name}.rs", inside / name / "mod.rs"):
            if below.exists():
                yield from _modules(below, crate, (*module, name))


def blank(text: str) -> str:
    """Take comments and what stands in quotes out of a text, line by line as long as before."""
    return _TEXT.sub(lambda found: re.sub(r"[^\n]", " ", found.group()), text)


def without_tests(text: str) -> str:
    """Take the items out that are compiled for tests only."""
    while (found := _TESTED_ITEM.search(text)) is not None:
        end = item_end(text, found.end())
        text = text[: found.start()] + re.sub(r"[^\n]", " ", text[found.start() : end]) + text[end:]
    return text


def item_end(text: str, begin: int) -> int:
    """Return where an item ends that begins there: behind its `;` or its last brace."""
    depth = 0
    for at in range(begin, len(text)):
        letter = text[at]
        if letter in "([{":
            depth += 1
        elif letter in ")]}":
            depth -= 1
            if depth == 0 and letter == "}":
                return at + 1
        elif letter == ";" and depth == 0:
            return at + 1
    return len(text)
