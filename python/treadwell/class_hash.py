"""A hash of what a class in Python does, by its source: of another hash, it may do something else.

Comments, the layout and docstrings do not count, nor do functions and other classes of its module
that it does not use; everything that runs when its module is imported does, and so do the modules
of the user's that are imported. The file is never run for it.

What could make two sources with one hash differ is looked for, and then more counts: all of the
file where something reads sources or docstrings, all of the package where something reaches what it
does not name.
"""

import ast
import hashlib
from collections.abc import Iterator
from typing import Final

from treadwell.dependencies import Dependencies, Module, dependencies, names_in

_LENGTH: Final = 16
_READS_TEXT: Final = frozenset(
    {"__doc__", "getdoc", "getsource", "inspect", "__file__", "linecache"}
)
"""Names by which code reads its own text."""
_PURE_DECORATORS: Final = frozenset(
    {
        "dataclass", "dataclasses.dataclass", "final", "typing.final", "override", "property",
        "staticmethod", "classmethod", "abstractmethod", "abc.abstractmethod", "overload",
        "runtime_checkable", "cache", "functools.cache", "cached_property", "functools.wraps",
    }
)  # fmt: skip
_PURE_BASES: Final = frozenset({"object", "Protocol", "typing.Protocol", "ABC", "abc.ABC"})
_PURE_CALLS: Final = frozenset({"field", "dataclasses.field"})
_LIBRARY: Final = frozenset({"dataclasses", "typing", "typing_extensions", "abc", "functools"})
_HARMLESS: Final = frozenset(
    word for one in _PURE_DECORATORS | _PURE_BASES | _PURE_CALLS for word in one.split(".")
)
"""Names that mean what they do in Python's library unless a module gives them another meaning."""
_HOOKS: Final = frozenset({"__init_subclass__", "__set_name__", "__class_getitem__"})

_Definition = ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef


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
            told = _meaning(module.tree, name if _is_alone(found, module.name, home) else None)
        content.update(hashlib.sha256(module.content).digest() if told is None else told.encode())
    return content.hexdigest()[:_LENGTH]


def _meaning(tree: ast.Module, name: str | None) -> str | None:
    """Return what a source says; where a class is named only what that can reach.

    Returns:
        The text; None of a source that is nested too deeply for it.
    """
    try:
        return _dumped(tree.body if name is None else _used(tree.body, name))
    except RecursionError:
        return None


def _names(module: Module) -> Iterator[str]:
    return iter(()) if module.tree is None else names_in(module.tree)


def _is_alone(found: Dependencies, module: str, home: str) -> bool:
    """Say whether a module is the class's, and nothing but the class's name leads into it."""
    others = found.modules.values()
    return module == home and not found.dynamic and all(home not in one.imports for one in others)


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


def _used(body: list[ast.stmt], name: str) -> list[ast.stmt]:
    """Return the statements of a module without what a class of it cannot reach."""
    body = [one for one in body if not _is_main(one) and not _is_listing(one)]
    free = _free(body)
    if name not in {one.name for one in body if isinstance(one, _Definition)}:
        return body
    waiting = [one for one in body if not _is_in(free, one)]
    waiting += [free.pop(name)] if name in free else []
    while waiting:
        for word in set(names_in(waiting.pop())) & free.keys():
            waiting.append(free.pop(word))
    return [one for one in body if not _is_in(free, one)]


def _is_in(free: dict[str, _Definition], statement: ast.stmt) -> bool:
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


def _free(body: list[ast.stmt]) -> dict[str, _Definition]:
    """Return the functions and classes, by name, whose definition does nothing but define them."""
    counts: dict[str, int] = {}
    for statement in body:
        for bound in _bound(statement):
            counts[bound] = counts.get(bound, 0) + 1
    free: dict[str, _Definition] = {}
    if not _HARMLESS.isdisjoint(_rebound(body)):
        return free
    for statement in body:
        if not isinstance(statement, _Definition) or counts[statement.name] > 1:
            continue
        if isinstance(statement, ast.ClassDef):
            quiet = _is_quiet_class(statement, free)
        else:
            quiet = _is_quiet_function(statement)
        if quiet and not statement.name.startswith("__"):
            free[statement.name] = statement
    return free


def _rebound(body: list[ast.stmt]) -> Iterator[str]:
    """Yield what may mean something else in a module than it does in Python's library."""
    for statement in body:
        if isinstance(statement, ast.ImportFrom) and statement.names[0].name == "*":
            yield from _HARMLESS
        if isinstance(statement, ast.Import | ast.ImportFrom):
            froms = [statement.module] if isinstance(statement, ast.ImportFrom) else []
            known = all(one in _LIBRARY for one in froms or [n.name for n in statement.names])
            if known and all(one.asname in (None, one.name) for one in statement.names):
                continue
        yield from _bound(statement)


def _bound(statement: ast.stmt) -> set[str]:
    """Return the names that a statement may give a meaning in its module, and perhaps more."""
    found: set[str] = set()
    for node in ast.walk(statement):
        if isinstance(node, ast.Global):
            found.update(node.names)
        elif isinstance(node, _Definition) and (
            node is statement or not isinstance(statement, _Definition)
        ):
            found.add(node.name)
        elif isinstance(statement, _Definition):
            continue  # what it binds within itself is its own
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            found.add(node.id)
        elif isinstance(node, ast.alias):
            found.add((node.asname or node.name).partition(".")[0])
        elif isinstance(node, ast.ExceptHandler | ast.MatchAs | ast.MatchStar) and node.name:
            found.add(node.name)
    return found


def _is_quiet_function(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    arguments = function.args
    evaluated = [*arguments.defaults, *filter(None, arguments.kw_defaults)]
    every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
    every += [one for one in (arguments.vararg, arguments.kwarg) if one is not None]
    evaluated += [one.annotation for one in every if one.annotation is not None]
    evaluated += [function.returns] if function.returns is not None else []
    return _are_pure(function.decorator_list) and all(map(_is_quiet, evaluated))


def _is_quiet_class(kind: ast.ClassDef, known: dict[str, _Definition]) -> bool:
    if kind.keywords or not _are_pure(kind.decorator_list):
        return False
    for base in kind.bases:
        named = ast.unparse(base.value if isinstance(base, ast.Subscript) else base)
        if named not in _PURE_BASES and not isinstance(known.get(named), ast.ClassDef):
            return False
    return all(map(_is_quiet_statement, kind.body))


def _is_quiet_statement(statement: ast.stmt) -> bool:
    """Say whether a statement of a class's body does nothing but give it something."""
    if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef):
        return statement.name not in _HOOKS and _is_quiet_function(statement)
    if isinstance(statement, ast.AnnAssign):
        value = statement.value
        return _is_quiet(statement.annotation) and (value is None or _is_quiet(value))
    if isinstance(statement, ast.Assign):
        plain = all(isinstance(to, ast.Name) and to.id not in _HOOKS for to in statement.targets)
        return plain and _is_quiet(statement.value)
    return isinstance(statement, ast.Pass) or (
        isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
    )


def _are_pure(decorators: list[ast.expr]) -> bool:
    for one in decorators:
        called = isinstance(one, ast.Call)
        named = ast.unparse(one.func if isinstance(one, ast.Call) else one)
        setter = named.endswith((".setter", ".getter", ".deleter")) and not called
        if not setter and named not in _PURE_DECORATORS:
            return False
        if isinstance(one, ast.Call):
            given = [*one.args, *(keyword.value for keyword in one.keywords)]
            if not all(map(_is_quiet, given)):
                return False
    return True


def _is_quiet(value: ast.expr) -> bool:
    """Say whether evaluating an expression does nothing but give a value."""
    for node in ast.walk(value):
        if isinstance(node, ast.NamedExpr | ast.Await | ast.Yield | ast.YieldFrom):
            return False
        if isinstance(node, ast.Call) and ast.unparse(node.func) not in _PURE_CALLS:
            return False
    return True
