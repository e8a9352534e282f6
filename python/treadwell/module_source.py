"""Where a module is and what its source says, without running it or the packages it is in."""

import ast
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from pathlib import Path
from pkgutil import get_importer
from typing import Final

from treadwell.errors import InputError
from treadwell.files import read_content

LARGEST_SOURCE: Final = 10_000_000
"""Bytes of a module's source."""


@dataclass(frozen=True, slots=True)
class Located:
    """Where a module is.

    Attributes:
        name: the module's.
        folders: in which its submodules lie; None: it is no package.
        file: its source; None: it has none that could be read.
        source: its content.
        compiled: its file where that is no source.
    """

    name: str
    folders: tuple[str, ...] | None
    file: Path | None = None
    source: bytes | None = None
    compiled: Path | None = None


def locate(module: str) -> Located:
    """Return where a module is; nothing of it is run, nor of the packages that it is in.

    Raises:
        InputError: there is none, or its source cannot be read.
    """
    located: Located | None = None
    words = module.split(".")
    for depth in range(1, len(words) + 1):
        name = ".".join(words[:depth])
        loaded = sys.modules.get(name)
        if loaded is None:
            spec = _spec(name, None if located is None else located.folders or ())
        else:
            spec = getattr(loaded, "__spec__", None) or ModuleSpec(name, None)
        if spec is None:
            here = depth == 1 and (Path(f"{name}.py").is_file() or Path(name).is_dir())
            hint = f"; {name} is here: with PYTHONPATH=. it is found" if here else ""
            raise InputError(f"there is no module {name} on Python's path{hint}")
        located = _located(name, spec)
    assert located is not None
    return located


def _spec(name: str, folders: Sequence[str] | None) -> ModuleSpec | None:
    """Return a module's spec; `folders` are those of its package, None for one in no package."""
    try:
        if folders is None:
            return find_spec(name)  # asks the finders; there is no package that it would run
        portions: list[str] = []
        for folder in folders:
            finder = get_importer(folder)
            spec = None if finder is None else finder.find_spec(name, None)
            if spec is not None and spec.loader is not None:
                return spec
            portions += [] if spec is None else spec.submodule_search_locations or []
    except Exception as error:  # finders of others: what they raise is theirs
        raise InputError(f"{name} cannot be looked for: {error!r}") from None
    if not portions:
        return None
    spec = ModuleSpec(name, None, is_package=True)
    spec.submodule_search_locations = portions
    return spec


def _located(name: str, spec: ModuleSpec) -> Located:
    places = spec.submodule_search_locations
    folders = None if places is None else tuple(places)
    origin = Path(spec.origin) if spec.has_location and spec.origin else None
    if origin is None or origin.suffix not in {".py", ".pyw"}:
        return Located(name, folders, compiled=origin)
    if origin.exists():
        return Located(name, folders, origin, read_content(origin, LARGEST_SOURCE))
    get_source = getattr(spec.loader, "get_source", None)  # of an archive
    try:
        text = None if get_source is None else get_source(name)
    except (ImportError, OSError, SyntaxError, UnicodeDecodeError):
        text = None
    return Located(name, folders, origin, None if text is None else text.encode())


def parsed(located: Located) -> list[ast.stmt]:
    """Return the statements of a module's source.

    Raises:
        InputError: it has none that could be read, or it is no Python.
    """
    if located.source is None:
        if located.file is None and located.folders is not None:
            return []  # a folder without an __init__.py
        raise InputError(
            f"{located.name} has no source that could be read: what is compiled is not run to see "
            "what it has; name a class in Python around it, with the methods written out"
        )
    try:
        return ast.parse(located.source).body
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise InputError(f"{located.file or located.name}: is no Python: {error}") from None


def flat(statements: Sequence[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield statements, and those within `if`, `try` and `with`."""
    for statement in statements:
        yield statement
        if isinstance(statement, ast.If | ast.Try | ast.With):
            yield from flat(statement.body)
        if isinstance(statement, ast.If | ast.Try):
            yield from flat(statement.orelse)
        if isinstance(statement, ast.Try):
            for handler in statement.handlers:
                yield from flat(handler.body)
            yield from flat(statement.finalbody)
