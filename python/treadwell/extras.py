"""What the package's extras bring, and the command that installs it."""

import re
from importlib.metadata import PackageNotFoundError, requires


def install_hint(extra: str) -> str:
    """Return the command that installs what an extra brings.

    It names the packages themselves: the wheel may have come from anywhere, and need not lie in a
    package index under its name.

    Args:
        extra: name of one in `pyproject.toml`.
    """
    try:
        needed = requires("treadwell") or []
    except PackageNotFoundError:
        needed = []  # run from its sources
    asked = re.compile(rf"\bextra\s*==\s*[\"']{re.escape(extra)}[\"']")
    found = [one.partition(";")[0].strip() for one in needed if asked.search(one)]
    return " ".join(["pip install", *(f"'{one}'" for one in found or [f"treadwell[{extra}]"])])
