"""Rerun without what it would tell the user of a choice that is ours."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

_VARIABLE: Final = "RUST_LOG"
_SILENT: Final = "re_log_encoding::rrd::file_sink=error"
"""The part of rerun that warns of a file without a table of contents."""


@contextmanager
def first_import() -> Iterator[None]:
    """Let rerun, if it is imported here first, be silent of files without a table of contents.

    It reads the environment while it is imported; afterwards that is as it was.
    """
    if "rerun" in sys.modules:
        yield
        return
    before = os.environ.get(_VARIABLE)
    os.environ[_VARIABLE] = f"{before or 'warn'},{_SILENT}"
    try:
        yield
    finally:
        if before is None:
            del os.environ[_VARIABLE]
        else:
            os.environ[_VARIABLE] = before
