"""Finds doc comments of the core that are no sentence of their own.

    python tools/doc_comments.py     # each with its place

A doc comment says what the thing is: it begins with a capital, a digit or code, not with `The same`
or a word that goes on from the comment above, and ends with a full stop, a colon or code.
"""

import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
_BEGINS = re.compile(r"""[A-Z0-9`"'(\[<]|\d""")
_GOES_ON = re.compile(r"(The same|And|Or|But|Likewise|Ditto|As above|Also)\b")


def comments(text: str) -> Iterator[tuple[int, str]]:
    """Yield the line and the text of each doc comment of a Rust file."""
    lines = text.splitlines()
    at = 0
    while at < len(lines):
        found = re.match(r"\s*//[/!](?!/)", lines[at])
        if found is None:
            at += 1
            continue
        begin, mark = at, found.group().strip()
        words = []
        while at < len(lines) and lines[at].strip().startswith(mark):
            words.append(lines[at].strip()[3:].strip())
            at += 1
        yield begin + 1, " ".join(words).strip()


def faults() -> list[str]:
    """Return place and beginning of each comment that is no sentence of its own."""
    found = []
    for path in sorted((ROOT / "rust").rglob("*.rs")):
        if "target" in path.parts:
            continue
        for line, text in comments(path.read_text()):
            if not _BEGINS.match(text) or _GOES_ON.match(text):
                found.append(f"{path.relative_to(ROOT)}:{line}: {text[:80]}")
    return found


def main() -> None:
    """Print them."""
    found = faults()
    print("\n".join(found))
    print(f"doc comments that are no sentence of their own: {len(found)}")


if __name__ == "__main__":
    main()
