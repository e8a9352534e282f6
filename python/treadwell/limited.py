"""Work on a stranger's file in a child process with limits of memory and time.

MuJoCo reads meshes, worlds and models in C++: a file made to do harm can let it run for hours, take
all memory, or crash. In a child that is one clear error.
"""

import importlib
import json
import os
import resource
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from treadwell.errors import InputError, ShellLimitError
from treadwell.shell_limits import tightness, within

PACKAGE_FOLDER: Final = Path(__file__).resolve().parent.parent


@dataclass(frozen=True, slots=True)
class Limits:
    """What a child may take.

    Attributes:
        cpu_seconds: of computing.
        deadline_seconds: by the clock; more than computing, for the machine may be busy.
        memory_bytes: of address space.
    """

    cpu_seconds: int = 4
    deadline_seconds: float = 60.0
    memory_bytes: int = 4 << 30


def limited(
    task: Callable[..., object],
    arguments: Sequence[str],
    what: str,
    limits: Limits = Limits(),
) -> Any:  # noqa: ANN401
    """Return what a function returns, called in a child process.

    Args:
        task: a module's function of strings, which returns plain data.
        arguments: for it.
        what: begins the message of an error.
        limits: what it may take.

    Raises:
        InputError: the task raised one, crashed, or reached a limit.
        ShellLimitError: it may be the shell's limit that it reached.
    """
    command = [sys.executable, "-P", "-m", "treadwell.limited", place_of(task)]
    command += [str(limits.cpu_seconds), str(limits.memory_bytes), *arguments]
    inherited = os.environ.get("PYTHONPATH")
    paths = [str(PACKAGE_FOLDER), *([inherited] if inherited else [])]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(paths), "OMP_NUM_THREADS": "1"}
    try:
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=limits.deadline_seconds,
            env=environment,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise InputError(f"{what}: takes too long") from None
    try:
        answer = json.loads(done.stdout.decode().rpartition("\n")[2])
    except ValueError:
        answer = {}
    if "value" in answer:
        return answer["value"]
    if "fault" in answer:
        raise InputError(f"{answer['fault']}")
    tight = tightness(limits.memory_bytes)
    if tight:
        raise ShellLimitError(f"{what}: could not be looked at: {tight}")
    raise InputError(
        f"{what}: cannot be read within {limits.cpu_seconds} s and {limits.memory_bytes >> 30} GB, "
        "or makes MuJoCo crash"
    )


def place_of(task: Callable[..., object]) -> str:
    """Return where a child process finds a function, as `package.module:function`."""
    return f"{task.__module__}:{task.__qualname__}"


def _main(arguments: Sequence[str]) -> None:
    """Do a task, and write what came of it as the last line of standard output."""
    task, cpu_seconds, memory_bytes, *rest = arguments
    # What the imports take does not count.
    module, _, name = task.partition(":")
    function = getattr(importlib.import_module(module), name)
    used = resource.getrusage(resource.RUSAGE_SELF)
    cpu = int(cpu_seconds) + int(used.ru_utime + used.ru_stime) + 1
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    for limit, wanted in ((resource.RLIMIT_CPU, cpu), (resource.RLIMIT_AS, int(memory_bytes))):
        most = within(limit, wanted)  # nobody may raise what the shell allows
        resource.setrlimit(limit, (most, most))
    try:
        answer = {"value": function(*rest)}
    except InputError as error:
        answer = {"fault": str(error)}
    sys.stdout.write("\n" + json.dumps(answer))


if __name__ == "__main__":
    _main(sys.argv[1:])
