"""A hash of what a class in Python does, by its source: of another hash, it may do something else.

Comments, the layout and docstrings do not count, nor do functions and other classes of its module
that it does not use, nor those of the user's other modules that none imports by name; everything
that runs when a module is imported does. The files are never run for it.

What could make two sources with one hash differ is looked for, and then more counts: all of the
file where something reads sources or docstrings, all of the package where something reaches what it
does not name.
"""

import ast
import hashlib
from collections.abc import Iterator
from typing import Final

from treadwell.dependencies import Dependencies, Module, dependencies, names_in
from treadwell.quiet_definitions import Definition, meanings, quiet_definitions, rebinds

_LENGTH: Final = 16
_PROTOCOLS: Final = "treadwell.protocols"
"""Whose classes do nothing to those that derive from them."""
_READS_TEXT: Final = frozenset(
    {"__doc__", "getdoc", "getsource", "inspect", "__file__", "linecache"}
)
"""Names by which code reads its own text."""


def class_hash(target: str) -> str:
    """Return the hash of `package.module:Class`; of one that is not there a hash as well.

    Two sources with the same hash make the same class. The other way round it is not so: what is
    only written otherwise, but for its layout, is another source.
    """
    home, _, name = target.partition(":")
    found = dependencies(home)
    text = any(not _READS_TEXT.isdisjoint(_names(one)) for one in found.modules.values())
    content = hashlib.sha256()
    for module in found.modules.values():
        content.update(f"\n{module.name}\n".encode())
        told = None
        if module.tree is not None and not text:
            told = _meaning(module.tree, *_reached(found, module, (home, name)))
        content.update(hashlib.sha256(module.content).digest() if told is None else told.encode())
    return content.hexdigest()[:_LENGTH]


def _meaning(
    tree: ast.Module, names: frozenset[str] | None, bases: frozenset[str] = frozenset()
) -> str | None:
    """Return what a source says; where classes and functions are named only what those can reach.

    Args:
        tree: the source.
        names: of its classes and functions, those that are used from outside; None: it may be all.
        bases: imported names of classes from which to derive does nothing but define a class.

    Returns:
        The text; None of a source that is nested too deeply for it.
    """
    try:
        return _dumped(tree.body if names is None else _used(tree.body, names, bases))
    except RecursionError:
        return None


def _reached(
    found: Dependencies, module: Module, target: tuple[str, str]
) -> tuple[frozenset[str] | None, frozenset[str]]:
    """Return what of a module is used by its names, None where that cannot be told, and its bases.

    Args:
        found: all that the class depends on.
        module: one of them.
        target: the class's module, and its name.
    """
    home, name = target
    users = [one for one in found.modules.values() if module.name in one.imports]
    if found.dynamic:
        return None, frozenset()
    if module.name == home:
        names = None if users else frozenset({name})
    else:
        names = _taken_by(users, module.name)
    return names, _quiet_bases(found, module, (home,))


def _taken_by(users: list[Module], module: str) -> frozenset[str] | None:
    """Return what modules import from another by name; None where one has the module as a whole."""
    package, _, leaf = module.rpartition(".")
    names: set[str] = set()
    for user in users:
        taken = {name for origin, name in user.taken if origin == module}
        if not taken or "*" in taken or (package, leaf) in user.taken or _names_it(user, module):
            return None
        names |= taken
    return frozenset(names)


def _names_it(user: Module, module: str) -> bool:
    """Say whether a module has another, or a package with it, under a name of its own."""
    return user.tree is not None and any(
        f"{alias.name}.".startswith(f"{module}.") or f"{module}.".startswith(f"{alias.name}.")
        for node in ast.walk(user.tree)
        if isinstance(node, ast.Import)
        for alias in node.names
    )


def _quiet_bases(found: Dependencies, module: Module, path: tuple[str, ...]) -> frozenset[str]:
    """Return the names, imported from other modules, of classes that do nothing to subclasses."""
    if module.tree is None or rebinds(module.tree.body):
        return frozenset()
    quiet = set()
    for node in module.tree.body:
        if not isinstance(node, ast.ImportFrom):
            continue
        origin = module.origin(node)
        other = found.modules.get(origin)
        if origin == _PROTOCOLS:
            quiet |= {alias.asname or alias.name for alias in node.names}
        elif other is not None and other.tree is not None and origin not in path:
            bases = _quiet_bases(found, other, (*path, origin))
            free = quiet_definitions(other.tree.body, bases)
            quiet |= {
                alias.asname or alias.name
                for alias in node.names
                if isinstance(free.get(alias.name), ast.ClassDef)
            }
    told = meanings(module.tree.body)
    return frozenset(name for name in quiet if told[name] == 1)


def _names(module: Module) -> Iterator[str]:
    return iter(()) if module.tree is None else names_in(module.tree)


def _dumped(body: list[ast.stmt]) -> str:
    """Return what statements are, without their places and docstrings, which it takes from them."""
    tree = ast.Module(body, [])
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            while node.body and _is_text(node.body[0]):
                del node.body[0]
    return ast.dump(tree)


def _is_text(statement: ast.stmt) -> bool:
    return (
        isinstance(statement, ast.Expr)
        and isinstance(statement.value, ast.Constant)
        and isinstance(statement.value.value, str)
    )


def _used(
    body: list[ast.stmt], names: frozenset[str], bases: frozenset[str] = frozenset()
) -> list[ast.stmt]:
    """Return the statements of a module without what those of these names cannot reach."""
    body = [one for one in body if not _is_main(one) and not _is_listing(one)]
    free = quiet_definitions(body, bases)
    waiting = [one for one in body if not _is_in(free, one)]
    waiting += [free.pop(name) for name in sorted(names) if name in free]
    while waiting:
        for word in set(names_in(waiting.pop())) & free.keys():
            waiting.append(free.pop(word))
    return [one for one in body if not _is_in(free, one)]


def _is_in(free: dict[str, Definition], statement: ast.stmt) -> bool:
    return any(one is statement for one in free.values())


def _is_main(statement: ast.stmt) -> bool:
    """Say whether a statement runs only where its file is run as a program."""
    return (
        isinstance(statement, ast.If)
        and ast.unparse(statement.test).replace('"', "'") == "__name__ == '__main__'"
        and not statement.orelse
    )


def _is_listing(statement: ast.stmt) -> bool:
    """Say whether a statement only lists what `import *` brings."""
    return isinstance(statement, ast.Assign) and "__all__" in map(ast.unparse, statement.targets)
