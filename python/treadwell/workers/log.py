"""What a worker process writes to its standard output and error: a file without a name."""

import fcntl
import os
import tempfile
from multiprocessing import reduction
from typing import Any, BinaryIO, Final

_TAIL_BYTES: Final = 1 << 16


class WorkerLog:
    """A file that both processes hold open. It is gone with the last of them, kill -9 or not."""

    def __init__(self, file: BinaryIO | None = None) -> None:
        """Make a new one; or take over what another process handed on."""
        self._file = file or tempfile.TemporaryFile()  # noqa: SIM115 - it lives as long as this
        # So that after it was emptied nothing is written far behind its beginning.
        flags = fcntl.fcntl(self._file, fcntl.F_GETFL)
        fcntl.fcntl(self._file, fcntl.F_SETFL, flags | os.O_APPEND)

    def __reduce__(self) -> tuple[Any, ...]:
        """Hand the open file on to a process that is being started."""
        return _taken_over, (reduction.DupFd(self._file.fileno()),)

    def close(self) -> None:
        """Let the file go."""
        self._file.close()

    def take_output(self) -> None:
        """Let this process's standard output and error go to the file."""
        for stream in (1, 2):
            os.dup2(self._file.fileno(), stream)

    def clear(self) -> None:
        """Empty the file."""
        os.ftruncate(self._file.fileno(), 0)

    def tail(self) -> list[str]:
        """Return the last lines, of some ten thousands of bytes at most."""
        size = os.fstat(self._file.fileno()).st_size
        content = os.pread(self._file.fileno(), _TAIL_BYTES, max(0, size - _TAIL_BYTES))
        return content.decode(errors="replace").splitlines()


def _taken_over(handle: Any) -> WorkerLog:  # noqa: ANN401 - multiprocessing's own
    return WorkerLog(os.fdopen(handle.detach(), "r+b", buffering=0))
