"""Registers the environments when Gymnasium is imported: `gymnasium.make("treadwell/...")`."""

import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from types import ModuleType
from typing import Final

ENVIRONMENTS: Final = "treadwell.environment"


class _Waiting(MetaPathFinder):
    """Waits until Gymnasium is imported; that somebody asks whether it is there is not enough."""

    def __init__(self) -> None:
        self._asking = False

    def find_spec(
        self, fullname: str, _path: Sequence[str] | None = None, _target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname != "gymnasium" or self._asking:
            return None
        self._asking = True  # the others
        try:
            spec = find_spec(fullname)
        finally:
            self._asking = False
        if spec is not None and spec.loader is not None:
            load = spec.loader.exec_module

            def load_and_register(module: ModuleType) -> None:
                sys.meta_path.remove(self)
                load(module)
                import_module(ENVIRONMENTS)

            spec.loader.exec_module = load_and_register  # type: ignore[method-assign]
        return spec


def register_with_gymnasium() -> None:
    """Register now where Gymnasium is imported already, else as soon as it is. Never imports it."""
    if "gymnasium" in sys.modules:
        import_module(ENVIRONMENTS)
    else:
        sys.meta_path.insert(0, _Waiting())
