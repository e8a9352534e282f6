"""Which files a comparison can be drawn to; apart from the drawing, which takes Matplotlib."""

from pathlib import Path
from typing import Final

from treadwell.errors import InputError

SUFFIXES: Final = (".pdf", ".svg", ".png")


def check_figure(path: Path) -> None:
    """Refuse a figure that could not be drawn, before anything is done for it.

    Raises:
        InputError: its ending is none of `SUFFIXES`, or there is no such folder.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise InputError(f"--figure: found {path}; must end with {', '.join(SUFFIXES)}")
    if not path.parent.is_dir():
        raise InputError(f"--figure: {path}: there is no folder {path.parent}")
