"""A stranger's MJCF file, looked at before MuJoCo reads it: bounded, and inside one folder."""

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Final

from treadwell.errors import InputError

MOST_ELEMENTS: Final = 20_000
MOST_BYTES: Final = 5_000_000
MOST_FILES: Final = 20
MOST_REPLICAS: Final = 2_000
MOST_HEIGHTS: Final = 4_000_000
REFUSED: Final = {"extension", "plugin", "composite", "flexcomp", "flex", "skin"}
FILE_ATTRIBUTES: Final = (
    "file",
    "fileright",
    "fileleft",
    "fileup",
    "filedown",
    "filefront",
    "fileback",
    "model",
)
FOLDER_ATTRIBUTES: Final = ("meshdir", "texturedir", "assetdir")


def check_xml(path: Path, folder: Path, what: str) -> None:
    """Check an MJCF file and all that it includes.

    Args:
        path: the file.
        folder: every file that it names must lie in it, links followed.
        what: begins the message.

    Raises:
        InputError: it is broken, names files outside the folder, or could grow without bounds.
    """
    todo, seen = [path], {path}
    while todo:
        current = todo.pop()
        tree = list(_read(current, what).iter())
        if len(tree) > MOST_ELEMENTS:
            raise InputError(f"{what}: more than {MOST_ELEMENTS} XML elements")
        _check_sizes(tree, what)
        for include in _check_files(tree, current, folder, what):
            if include not in seen:
                seen.add(include)
                todo.append(include)
        if len(seen) > MOST_FILES:
            raise InputError(f"{what}: more than {MOST_FILES} files")


def _read(path: Path, what: str) -> ET.Element:
    try:
        if path.stat().st_size > MOST_BYTES:
            raise InputError(f"{what}: larger than {MOST_BYTES} bytes")
        content = path.read_bytes()
        # Entities are how a small file grows large; MJCF has no use for them.
        if b"<!DOCTYPE" in content or b"<!ENTITY" in content:
            raise InputError(f"{what}: has a DOCTYPE or an entity, which is not allowed")
        return ET.fromstring(content)
    except (OSError, ET.ParseError, ValueError) as error:
        raise InputError(f"{what}: {' '.join(str(error).split())[:300]}") from None


def _check_sizes(tree: list[ET.Element], what: str) -> None:
    """Refuse what multiplies, and what can run code."""
    replicas = 1
    for node in tree:
        if node.tag in REFUSED:
            raise InputError(f"{what}: <{node.tag}> is not allowed in a course")
        if node.tag == "replicate":
            replicas *= max(1, _count(node, "count", what))
        if node.tag == "hfield":
            cells = _count(node, "nrow", what) * _count(node, "ncol", what)
            if cells > MOST_HEIGHTS:
                raise InputError(f"{what}: <hfield> of more than {MOST_HEIGHTS} heights")
    if replicas > MOST_REPLICAS:
        raise InputError(f"{what}: <replicate> of more than {MOST_REPLICAS} copies")


def _check_files(tree: list[ET.Element], path: Path, folder: Path, what: str) -> list[Path]:
    """Refuse files outside the folder; return the ones that are included."""
    places = [path.parent]
    for node in tree:
        places += [path.parent / node.attrib[k] for k in FOLDER_ATTRIBUTES if k in node.attrib]
    includes = []
    for node in tree:
        for key in FILE_ATTRIBUTES:
            if key not in node.attrib or (key == "model" and node.tag != "model"):
                continue
            named = [(place / node.attrib[key]).resolve() for place in places]
            if not all(file.is_relative_to(folder) for file in named):
                raise InputError(f"{what}: {node.attrib[key]!r} lies outside the scenario's folder")
            if node.tag == "include":
                includes.append(named[0])
    return includes


def _count(node: ET.Element, key: str, what: str) -> int:
    try:
        return abs(int(node.attrib.get(key, "0")))
    except ValueError:
        raise InputError(f"{what}: {key} of <{node.tag}> is not a whole number") from None
