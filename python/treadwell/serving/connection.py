"""A connection over which messages go, each within a time; sockets of both kinds."""

import socket
import stat
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from time import monotonic
from types import TracebackType
from typing import Any, Final, Self

from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.serving.framing import Message, ProtocolError, pack, read_message

LOOPBACK: Final = "127.0.0.1"
"""The only interface that TCP is spoken on: the protocol knows no passwords."""
Address = Path | int
"""A socket file, or a port of the loopback interface."""
_BLOCK: Final = 1 << 20
_LINGER_S: Final = 1.0
"""How long what the other side still sends is read after an error, so that it can be read there."""


class Connection:
    """One side of a connection."""

    def __init__(self, opened: socket.socket, timeout_s: float) -> None:
        """Take a socket.

        Args:
            opened: connected.
            timeout_s: within which the next message must have come, or one that is sent be taken.
        """
        self._socket, self._timeout_s = opened, timeout_s
        self._deadline_s = 0.0
        if opened.family == socket.AF_INET:
            opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def __enter__(self) -> Self:
        """Begin."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close it."""
        self.close()

    def close(self) -> None:
        """End it without a word."""
        self._socket.close()

    def receive(self) -> Message | None:
        """Return the next message; None where the other side has gone between two messages.

        Raises:
            ProtocolError: none came in time, or what came is none.
        """
        self._deadline_s = monotonic() + self._timeout_s
        return read_message(self._read)

    def send(
        self, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]] | None = None
    ) -> None:
        """Send a message.

        Raises:
            ProtocolError: no message holds this, or the other side does not take it.
        """
        data = pack(header, arrays)
        self._socket.settimeout(self._timeout_s)
        try:
            self._socket.sendall(data)
        except TimeoutError:
            raise ProtocolError(
                f"the other side took no message for {self._timeout_s:g} s, the time-out"
            ) from None
        except OSError as error:
            raise ProtocolError(f"the connection broke: {error.strerror or error}") from None

    def send_error(self, message: str) -> None:
        """Tell the other side what was wrong, if it still listens, and send nothing more."""
        lines = ("".join(c if c.isprintable() else "?" for c in line) for line in _lines(message))
        with suppress(OSError, ProtocolError):
            self.send({"type": "error", "message": "\n".join(lines)})
            self._socket.shutdown(socket.SHUT_WR)
            # Unread bytes would make the system drop the message on the other side.
            until = monotonic() + _LINGER_S
            while (left := until - monotonic()) > 0.0:
                self._socket.settimeout(left)
                if not self._socket.recv(_BLOCK):
                    break

    def _read(self, count: int) -> bytes:
        """Return as many bytes, or those that came before the other side ended.

        Raises:
            ProtocolError: they did not come in time, or the connection broke.
        """
        found = bytearray()
        try:
            while len(found) < count:
                left = self._deadline_s - monotonic()
                if left <= 0.0:
                    raise TimeoutError  # noqa: TRY301 - the same as what the socket raises
                self._socket.settimeout(left)
                block = self._socket.recv(min(count - len(found), _BLOCK))
                if not block:
                    break
                found += block
        except TimeoutError:
            raise ProtocolError(
                f"no whole message came for {self._timeout_s:g} s, the time-out"
            ) from None
        except ConnectionResetError:
            return bytes(found)  # as if it had ended there
        except OSError as error:
            raise ProtocolError(f"the connection broke: {error.strerror or error}") from None
        return bytes(found)


def _lines(message: str) -> list[str]:
    return [line[:1000] for line in message.splitlines()[:20]]


def connected(address: Address, timeout_s: float) -> Connection:
    """Return a connection to a server.

    Args:
        address: where it listens.
        timeout_s: as of `Connection`.

    Raises:
        InputError: none does.
    """
    family = socket.AF_INET if isinstance(address, int) else socket.AF_UNIX
    opened = socket.socket(family, socket.SOCK_STREAM)
    opened.settimeout(timeout_s)
    try:
        opened.connect((LOOPBACK, address) if isinstance(address, int) else str(address))
    except (OSError, OverflowError) as error:
        opened.close()
        what = getattr(error, "strerror", None) or error
        raise InputError(f"{shown_address(address)}: no server answers there: {what}") from None
    return Connection(opened, timeout_s)


def shown_address(address: Address) -> str:
    """Return an address for a message."""
    return f"{LOOPBACK}:{address}" if isinstance(address, int) else str(address)


def listener_of(address: Address) -> socket.socket:
    """Return a listening socket; only this user can open a socket file.

    Args:
        address: where. Port 0: any that is free.

    Raises:
        InputError: it cannot listen there: another server does, or something else is there.
    """
    if isinstance(address, int):
        return _bound(socket.AF_INET, (LOOPBACK, address), f"--tcp: {shown_address(address)}")
    where = f"--socket: {address}"
    _make_way(address, where)
    return _bound(socket.AF_UNIX, str(address), where)


def _bound(family: int, place: Any, where: str) -> socket.socket:  # noqa: ANN401 - the system's
    listener = socket.socket(family, socket.SOCK_STREAM)
    try:
        if family == socket.AF_INET:
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(place)
        if family == socket.AF_UNIX:
            Path(place).chmod(stat.S_IRUSR | stat.S_IWUSR)
        listener.listen()  # nobody could connect before
    except (OSError, OverflowError, ValueError) as error:
        listener.close()
        what = getattr(error, "strerror", None) or error
        raise InputError(f"{where}: cannot listen there: {what}") from None
    return listener


def _make_way(path: Path, where: str) -> None:
    """Remove the socket file of a server that is no more.

    Raises:
        InputError: a server listens there, or it is something else.
    """
    try:
        mode = path.lstat().st_mode
    except FileNotFoundError:
        return
    except (OSError, ValueError) as error:
        raise InputError(f"{where}: cannot listen there: {error}") from None
    if not stat.S_ISSOCK(mode):
        raise InputError(f"{where}: is there, and is no socket; name another file")
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
        probe.settimeout(_LINGER_S)
        try:
            probe.connect(str(path))
        except ConnectionRefusedError:
            path.unlink(missing_ok=True)
            return
        except FileNotFoundError:
            return
        except PermissionError:
            raise InputError(f"{where}: is another user's; name another file") from None
        except OSError:
            pass  # the queue of who listens there is full
    raise InputError(f"{where}: a server listens there already; end it, or name another file")
