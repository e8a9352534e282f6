"""What processor the physics runs on: MuJoCo's last bits follow what it can do."""

import os
import platform
import re
from functools import cache
from pathlib import Path
from typing import Final

CPUINFO: Final = Path("/proc/cpuinfo")
"""Linux's table of the processors; other systems have none."""
DECISIVE: Final = ("avx", "avx2", "fma", "avx512f")
"""Instructions by which the C library chooses its `sin` and `exp`, whose last bits differ."""


@cache
def processor() -> str:
    """Return this machine's processor and which of the decisive instructions there are.

    As in `x86_64, Intel(R) Xeon(R) Processor, avx avx2 fma`. What `GLIBC_TUNABLES` hides from the
    C library is left out. Where the system does not say it, model or instructions are missing.
    """
    try:
        cpuinfo = CPUINFO.read_text(encoding="utf-8", errors="replace")
    except OSError:
        cpuinfo = ""
    return described(cpuinfo, os.environ.get("GLIBC_TUNABLES", ""))


def described(cpuinfo: str, tunables: str = "") -> str:
    """Return what a table of processors says of the first one, as `processor` has it."""
    model = _line(cpuinfo, "model name") or platform.processor()
    hidden = set(re.findall(r"-(\w+)", tunables.lower()))
    there = set(_line(cpuinfo, "flags").split()) - hidden
    instructions = " ".join(name for name in DECISIVE if name in there)
    parts = dict.fromkeys((platform.machine(), " ".join(model.split()), instructions))
    return ", ".join(part for part in parts if part) or "unknown"


def _line(cpuinfo: str, key: str) -> str:
    found = re.search(rf"^{key}[ \t]*:(.*)$", cpuinfo, re.MULTILINE)
    return found[1].strip() if found else ""


def likely_reason(recorded: str | None, here: str | None = None) -> str:
    """Return why the same physics may come to other last bits here, empty where that is no reason.

    Args:
        recorded: what the physics ran on, None for a run of before it was told.
        here: what it is compared with; None: this machine.
    """
    here = processor() if here is None else here
    if recorded is None or recorded == here:
        return ""
    return f"likely because it ran on another processor: {recorded}; here: {here}"
