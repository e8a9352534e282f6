"""What the builder of the site is told beyond the docstrings as they stand: a Griffe extension.

Examples with `>>>` become blocks of code. The compiled core's stub has no docstrings: those of its
classes are the comments in `rust/bindings`, which Python shows as well.
"""

import re
from collections.abc import Iterator
from pathlib import Path

import griffe

BINDINGS = Path(__file__).resolve().parents[2] / "rust" / "bindings" / "src"
CORE = "treadwell._core."

_EXAMPLE = re.compile(r"^>>> .*\n(?:(?:>>>|\.\.\.).*(?:\n|\Z))*", re.MULTILINE)
_DOCUMENTED = re.compile(
    r"(?P<comment>(?:^[ ]*///.*\n)+)"
    r"(?:[ ]*\#\[(?P<class>pyclass\([^)]*name\ =\ \"(?P<name>\w+)\".*)?.*\n)*"
    r"[ ]*(?:pub(?:\([^)]*\))?\ )?(?:(?:struct|enum)\ (?P<type>\w+)|fn\ (?P<method>\w+)"
    r"|(?P<field>\w+):)|^impl\ (?P<impl>\w+)",
    re.MULTILINE | re.VERBOSE,
)


def fenced(text: str) -> str:
    """Return a docstring with its examples as blocks."""
    return _EXAMPLE.sub(lambda found: f"```pycon\n{found[0].rstrip()}\n```\n", text)


def commented(source: str) -> Iterator[tuple[str, str]]:
    """Yield the dotted names of a file's classes and members, and what their comments say."""
    names: dict[str, str] = {}  # what Python calls a type
    inside = ""
    for found in _DOCUMENTED.finditer(source):
        if found["impl"]:
            inside = found["impl"]
            continue
        if found["type"]:
            inside = found["type"]
            names[inside] = found["name"] or inside
        member = found["method"] or found["field"]
        owner = names.get(inside, inside)
        said = [line.strip().removeprefix("///").strip() for line in found["comment"].splitlines()]
        yield f"{owner}.{member}" if member else owner, "\n".join(said).strip()


class Docstrings(griffe.Extension):
    """Completes what docstrings say."""

    def __init__(self) -> None:
        super().__init__()
        files = sorted(BINDINGS.rglob("*.rs"))
        self.core = dict(pair for path in files for pair in commented(path.read_text()))

    def on_package(self, *, pkg: griffe.Module, **_: object) -> None:
        """Complete the package itself, which is no object to `on_object`."""
        if pkg.docstring and "```" not in pkg.docstring.value:
            pkg.docstring.value = fenced(pkg.docstring.value)

    def on_object(self, *, obj: griffe.Object, **_: object) -> None:
        """Complete one module, class, function or attribute."""
        if obj.docstring:
            obj.docstring.value = fenced(obj.docstring.value)
        elif obj.path.startswith(CORE) and (said := self.core.get(obj.path.removeprefix(CORE))):
            obj.docstring = griffe.Docstring(said, parent=obj)
