"""A stranger's MJCF file, looked at before MuJoCo reads it: bounded, and inside one folder."""

from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element, ParseError

from defusedxml import ElementTree
from defusedxml.common import DefusedXmlException

from treadwell.errors import InputError
from treadwell.files import read_text

MOST_ELEMENTS: Final = 20_000
"""Elements of all files together, each as often as `<replicate>` makes it."""
DEEPEST: Final = 200
MOST_BYTES: Final = 5_000_000
MOST_FILES: Final = 20
MOST_REPLICAS: Final = 2_000
MOST_HEIGHTS: Final = 4_000_000
LARGEST_ASSET: Final = 50_000_000
"""Bytes of a mesh, a texture or a height field."""
LARGEST_ASSETS: Final = 200_000_000
"""Bytes of all of them."""
ROOTS: Final = ("mujoco", "mujocoinclude")
URDF_ROOT: Final = "robot"
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


class _Bounds:
    """Counts what the files of one model make of each other."""

    def __init__(self, folder: Path, what: str) -> None:
        self.folder, self.what = folder, what
        self.elements, self.bytes = 0, 0
        self.assets: set[Path] = set()

    def fail(self, message: str) -> None:
        raise InputError(f"{self.what}: {message}")

    def count(self, node: Element, key: str) -> int:
        try:
            return abs(int(node.attrib.get(key, "0")))
        except ValueError:
            raise InputError(f"{self.what}: {key} of <{node.tag}> is not a whole number") from None

    def add_element(self, node: Element, copies: int, depth: int) -> int:
        """Take an element in that stands there so often; return how often its children do."""
        self.elements += copies
        if node.tag in REFUSED:
            self.fail(f"<{node.tag}> is not allowed")
        if node.tag == "replicate":
            copies *= max(1, self.count(node, "count"))
            if copies > MOST_REPLICAS:
                self.fail(f"<replicate> of more than {MOST_REPLICAS} copies")
        if node.tag == "hfield":
            cells = self.count(node, "nrow") * self.count(node, "ncol")
            if cells > MOST_HEIGHTS:
                self.fail(f"<hfield> of more than {MOST_HEIGHTS} heights")
        if self.elements > MOST_ELEMENTS:
            self.fail(f"more than {MOST_ELEMENTS} XML elements")
        if depth > DEEPEST:
            self.fail(f"nested deeper than {DEEPEST}")
        return copies

    def add_file(self, path: Path, name: str) -> None:
        """Take a file in that is named: inside the folder, and not too large."""
        if not path.is_relative_to(self.folder):
            self.fail(f"{name!r} lies outside the folder {self.folder.name!r}")
        if path in self.assets or not path.exists():
            return  # MuJoCo says which one is missing
        if not path.is_file():
            self.fail(f"{name!r} is no file")
        self.assets.add(path)
        size = path.stat().st_size
        self.bytes += size
        if size > LARGEST_ASSET or self.bytes > LARGEST_ASSETS:
            self.fail(f"{name!r} and the others are larger than {LARGEST_ASSETS} bytes")


def check_xml(path: Path, folder: Path, what: str) -> None:
    """Check an MJCF file and all that it includes.

    Args:
        path: the file.
        folder: every file that it names must lie in it, links followed.
        what: begins the message.

    Raises:
        InputError: it is broken, names files outside the folder, or could grow without bounds.
    """
    folder = folder.resolve()
    bounds = _Bounds(folder, what)
    if not path.resolve().is_relative_to(folder):
        bounds.fail(f"lies outside the folder {folder.name!r}")
    todo, seen = [(path.resolve(), 1)], {path.resolve()}
    while todo:
        current, copies = todo.pop()
        for include, times in _check_file(current, copies, bounds):
            if include in seen:
                # What is included twice stands there twice; a circle would have no end.
                bounds.fail(f"{include.name!r} is included more than once")
            seen.add(include)
            todo.append((include, times))
        if len(seen) > MOST_FILES:
            bounds.fail(f"more than {MOST_FILES} files")


def _check_file(path: Path, copies: int, bounds: _Bounds) -> list[tuple[Path, int]]:
    """Check a file alone; return what it includes, and how often."""
    root = _read(path, bounds.what)
    allowed = (URDF_ROOT,) if path.suffix.lower() == ".urdf" else ROOTS
    if root.tag not in allowed:
        bounds.fail(f"begins with <{str(root.tag)[:50]}>, must be <{allowed[0]}>")
    places = [path.parent]
    for node in root.iter():
        places += [path.parent / node.attrib[k] for k in FOLDER_ATTRIBUTES if k in node.attrib]
    includes = []
    todo = [(root, copies, 1)]
    while todo:
        node, times, depth = todo.pop()
        times = bounds.add_element(node, times, depth)
        for key in FILE_ATTRIBUTES:
            if key not in node.attrib or (key == "model" and node.tag != "model"):
                continue
            name = node.attrib[key]
            named = [_resolved(place, name, bounds) for place in places]
            for file in named:
                bounds.add_file(file, name)
            if node.tag in ("include", "model") and key == "file":
                includes.append((next((f for f in named if f.is_file()), named[0]), times))
        todo += [(child, times, depth + 1) for child in node]
    return includes


def _resolved(place: Path, name: str, bounds: _Bounds) -> Path:
    try:
        return (place / name).resolve()
    except (OSError, RuntimeError, ValueError):
        raise InputError(f"{bounds.what}: {name[:100]!r} is no file's name") from None


def _read(path: Path, what: str) -> Element:
    try:
        # As MuJoCo reads it: whatever encoding the file claims to have.
        text = read_text(path, MOST_BYTES)
        root: Element = ElementTree.fromstring(text.removeprefix("\ufeff"), forbid_dtd=True)
    except InputError as error:
        raise InputError(f"{what}: {error}") from None
    except DefusedXmlException:
        raise InputError(f"{what}: has a DOCTYPE or an entity, which is not allowed") from None
    except (OSError, ParseError, ValueError, RecursionError, LookupError) as error:
        raise InputError(f"{what}: {' '.join(str(error).split())[:300]}") from None
    return root
