"""The reference as pages in Markdown: components, parameters, and the keys of each file."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Final

from treadwell.components import COMPONENTS, SOURCES, TABLES
from treadwell.reference.parameters import ParameterTable, all_tables
from treadwell.reference.schemas import SCHEMAS
from treadwell.reference.words import allowed, escaped, kind, shown

MADE: Final = "<!-- Made from the code by `python tools/docs/reference.py write`. -->\n"
_FILES: Final = {
    "scenario": (
        "A scenario file",
        "Every key of a scenario. Needed are {needed}; all others may be left out.",
    ),
    "robot": ("robot.toml", "Every key of a robot's `robot.toml`: what its MJCF cannot say."),
    "result": ("result.json", "Every key of a run's `result.json`."),
    "map": ("result.json of a map", "Every key of the `result.json` that `treadwell map` writes."),
}

_SCALE = [
    "The defaults are those of a robot whose legs are as long as `qrio`'s. Of one whose legs are s",
    "times as long (`scale`, under `[robot]` of robot.toml) those of `[gait]` and `[navigation]`",
    "follow by their units: lengths are multiplied by s, times and speeds by the root of s, rates",
    "divided by it; angles and accelerations stay, and forces go with the mass. What is of the",
    "camera, of a sensor, of the world or of the numerics does not follow, and says so beside its",
    "unit; but the camera's noise in `1/m` goes with its focal length times baseline, over",
    "`qrio`'s. With `--robot NAME` the list has a robot's own defaults.",
]


def pages() -> dict[str, str]:
    """Return file name -> text, of the folder docs/reference."""
    made = {"README.md": _index(), "components.md": _components()}
    made |= {f"{name}.md": _file(name) for name in SCHEMAS}
    made |= {f"parameters/{table.name}.md": _parameters(table) for table in all_tables()}
    return {name: escaped(text) for name, text in made.items()}


def _index() -> str:
    lines = [MADE, "# Reference", ""]
    lines += ["- [components](components.md): what each name in `[navigation]` stands for"]
    lines += [f"- [{title}]({name}.md)" for name, (title, _) in _FILES.items()]
    lines += [
        "",
        "Parameters, also by `treadwell list parameters [NAME]`. Where its bounds do not say",
    ]
    lines += ["otherwise, a number is 0 or from 1e-9 to 1e9 in size.", "", *_SCALE, ""]
    for table in all_tables():
        lines.append(f"- [`[{table.key}]`](parameters/{table.name}.md): {_about(table)}")
    return "\n".join(lines) + "\n"


def _components() -> str:
    lines = [MADE, "# Components", "", "Chosen by name in `[navigation]` of a scenario.", ""]
    tables = {table.name for table in all_tables()}
    for slot, names in COMPONENTS.items():
        lines += [f"## `{slot}`", "", *_head("name", "what it is", "paper", "parameters")]
        for name, about in names.items():
            own = sorted(TABLES[slot][name] & tables, key=lambda table: (table != name, table))
            links = ", ".join(f"[`{table}`](parameters/{table}.md)" for table in own)
            source = SOURCES[slot].get(name) or "none: our own"
            lines.append(_row(f"`{name}`", about, source, links))
        lines.append("")
    return "\n".join(lines)


def _parameters(table: ParameterTable) -> str:
    lines = [MADE, f"# `[{table.key}]`", "", _about(table), ""]
    groups: dict[str, list[list[str]]] = {}
    for row in table.parameters:
        group, _, name = row.key.rpartition(".")
        unit = row.unit if row.owner is None else f"{row.unit}, of {row.owner}"
        cells = [f"`{name}`", _default(row.default), unit, row.bounds, row.meaning]
        groups.setdefault(group, []).append([*cells, row.source or ""])
    for group, rows in groups.items():
        if group != table.key:
            lines += [f"## `[{group}]`", ""]
        lines += _head("key", "default", "unit", "allowed", "meaning", "source")
        lines += [_row(*cells) for cells in rows]
        lines.append("")
    return "\n".join(lines)


def _file(name: str) -> str:
    title, about = _FILES[name]
    schema = SCHEMAS[name]()
    *first, last = (f"`{key}`" for key in schema["required"])
    needed = f"{', '.join(first)} and {last}"
    lines = [MADE, f"# {title}", "", about.format(needed=needed), ""]
    lines += _keys(schema)
    for model, described in _models(schema):
        lines += [f"## {model}", "", " ".join(described.get("description", "").split()), ""]
        lines += _keys(described)
    return "\n".join(lines).rstrip() + "\n"


def _models(schema: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    for name, described in schema.get("$defs", {}).items():
        if described.get("type") == "object":
            yield name, described


def _keys(described: Mapping[str, Any]) -> list[str]:
    lines = _head("key", "what", "default", "allowed", "meaning")
    needed = described.get("required", ())
    for key, value in described.get("properties", {}).items():
        default = "needed" if key in needed else _default(value.get("default"))
        meaning = value.get("description", "")
        lines.append(_row(f"`{key}`", kind(value), default, allowed(value), meaning))
    return [*lines, ""]


def _default(value: object) -> str:
    return "none" if value is None else f"`{shown(value)}`"


def _about(table: ParameterTable) -> str:
    return " ".join(table.about.split())


def _head(*cells: str) -> list[str]:
    return [_row(*cells), _row(*("---" for _ in cells))]


def _row(*cells: str) -> str:
    return "| " + " | ".join(_safe(cells)) + " |"


def _safe(cells: Iterable[str]) -> Iterator[str]:
    for cell in cells:
        yield " ".join(cell.split()).replace("|", "\\|")
