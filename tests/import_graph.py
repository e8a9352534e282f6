"""What each module of the harness imports of the others, as its source says it."""

import ast
import re
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

NAMED = re.compile(r"treadwell((?:\.\w+)+)(?::\w+)?")
"""A string that names a module, to be imported by it."""
ROOT = "__init__"
"""The package itself. Only where it is named it counts as imported: it comes with every other."""


def modules(package: Path) -> dict[str, Path]:
    """Dotted name within the package -> file; a package's is that of its `__init__.py`."""
    found = {}
    for path in sorted(package.rglob("*.py")):
        *folders, leaf = path.relative_to(package).with_suffix("").parts
        found[".".join(folders if leaf == "__init__" else [*folders, leaf]) or ROOT] = path
    return found


def imports(package: Path) -> dict[str, set[str]]:
    """Module -> the modules that it imports: at the top, in functions, for types, by a string."""
    files = modules(package)
    graph: dict[str, set[str]] = {}
    for name, path in files.items():
        found = {_module(inner, files) for inner in _named(path.read_text())}
        graph[name] = {module for module in found if module is not None and module != name}
    return graph


def between_floors(graph: dict[str, set[str]]) -> dict[str, set[str]]:
    """The same of what stands at the top of the package: modules, and folders as a whole."""
    floors: dict[str, set[str]] = {}
    for name, found in graph.items():
        floor = floor_of(name)
        floors.setdefault(floor, set()).update({floor_of(one) for one in found} - {floor})
    return floors


def floor_of(name: str) -> str:
    """The folder or module at the top of the package that a module belongs to."""
    return name.partition(".")[0]


def circle(graph: dict[str, set[str]]) -> list[str]:
    """A circle in the graph, its first module at both ends; empty where there is none."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def _named(source: str) -> set[str]:
    """Dotted names within the package that a source imports, of modules or of what they hold."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert not node.level, "imports are absolute"
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            match = NAMED.fullmatch(node.value)
            names = [f"treadwell{match[1]}"] if match else []
        else:
            continue
        of_ours = [name for name in names if name.split(".")[0] == "treadwell"]
        found.update(name.removeprefix("treadwell").removeprefix(".") for name in of_ours)
    return found


def _module(name: str, files: dict[str, Path]) -> str | None:
    """The module that a name means or lies in; None for the core, which is none of ours."""
    if name.partition(".")[0] == "_core":
        return None
    while name and name not in files:
        name = name.rpartition(".")[0]
    return name or ROOT
