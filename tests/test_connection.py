"""Where a server listens: socket files, stale ones and those of a live server, and ports."""

import socket
from pathlib import Path

import pytest
from serving_builders import running

from treadwell.errors import InputError
from treadwell.serving.connection import connected, listener_of
from treadwell.serving.served import ServedRobot
from treadwell.serving.server import listening


def test_a_socket_file_is_this_users_alone_and_goes_with_the_server(tmp_path: Path) -> None:
    path = tmp_path / "s"
    with running(ServedRobot("qrio"), path):
        assert path.stat().st_mode & 0o777 == 0o600
        with pytest.raises(InputError, match="a server listens there already"):
            listener_of(path)
    assert not path.exists()


def test_a_stale_socket_is_replaced_and_what_is_none_is_not(tmp_path: Path) -> None:
    path = tmp_path / "s"
    listener_of(path).close()
    assert path.is_socket()
    with pytest.raises(InputError, match="no server answers there: Connection refused"):
        connected(path, 1.0)
    with listening(path) as (listener, _):
        connected(path, 1.0).close()
        listener.accept()[0].close()
    (tmp_path / "file").write_text("mine")
    with pytest.raises(InputError, match="is no socket; name another file"):
        listener_of(tmp_path / "file")
    assert (tmp_path / "file").read_text() == "mine"
    for place in (tmp_path / "none" / "s", tmp_path / ("x" * 200)):
        with pytest.raises(InputError, match=r"--socket: .*: cannot listen there"):
            listener_of(place)
    with pytest.raises(InputError, match="no server answers there"):
        connected(tmp_path / "none", 1.0)


def test_a_full_queue_is_a_server_too(tmp_path: Path) -> None:
    path = tmp_path / "s"
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as busy:
        busy.bind(str(path))
        busy.listen(0)
        waiting = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        with waiting:
            waiting.connect(str(path))
            with pytest.raises(InputError, match="a server listens there already"):
                listener_of(path)


def test_a_port_that_is_taken_is_said() -> None:
    with listening(0) as (_, port), pytest.raises(InputError, match=r"--tcp: 127\.0\.0\.1:\d+: "):
        listener_of(port)
    with pytest.raises(InputError, match="cannot listen there"):
        listener_of(70000)
    with pytest.raises(InputError, match="no server answers there"):
        connected(70000, 1.0)
