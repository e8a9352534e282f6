"""A core of the user's own in the place of `treadwell._core`: `TREADWELL_CORE` names its file."""

import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ExtensionFileLoader, ModuleSpec
from importlib.util import spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Final

from treadwell.errors import InputError
from treadwell.version import __version__

VARIABLE: Final = "TREADWELL_CORE"
MODULE: Final = "treadwell._core"


class OwnCore(MetaPathFinder):
    """Finds `treadwell._core` in a file."""

    def __init__(self, path: str) -> None:
        """Take the file's path; it is looked at when the core is imported first."""
        self.path = path

    def find_spec(
        self, fullname: str, _path: Sequence[str] | None = None, _target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return where the core is, None for any other module.

        Raises:
            InputError: there is no such file.
        """
        if fullname != MODULE:
            return None
        if not Path(self.path).is_file():
            raise InputError(f"{VARIABLE}: {self.path}: no such file")
        file = str(Path(self.path).resolve())
        return spec_from_file_location(fullname, file, loader=_Loader(fullname, file))


class _Loader(ExtensionFileLoader):
    def create_module(self, spec: ModuleSpec) -> ModuleType:
        try:
            return super().create_module(spec)
        except ImportError as error:
            raise InputError(f"{VARIABLE}: {self.path}: is no core: {error}") from error

    def exec_module(self, module: ModuleType) -> None:
        super().exec_module(module)
        version = module.version() if hasattr(module, "version") else "of no version"
        if version != __version__:
            raise InputError(
                f"{VARIABLE}: {self.path}: is made with treadwell {version}; this is {__version__}"
            )


def use(path: str) -> None:
    """Import the core from `path` from now on."""
    sys.meta_path.insert(0, OwnCore(path))
