"""Claims about the command's beginning: Ctrl-C while the package is loaded is no traceback."""

import signal
import subprocess
import sys

import pytest

from treadwell.version import __version__

INTERRUPTED = """
import os, signal, sys
from treadwell.cli import start

class Finder:
    def find_spec(self, name, path, target=None):
        if name == "treadwell.cli.app":
            os.kill(os.getpid(), signal.SIGINT)

signal.signal(signal.SIGINT, HANDLER)
sys.meta_path.insert(0, Finder())
sys.argv = ["treadwell", "--version"]
start.main()
"""
"""A signal that comes when the command line is about to be loaded."""


def started(code: list[str]) -> tuple[int, str, str]:
    done = subprocess.run([sys.executable, *code], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


@pytest.mark.parametrize("module", ["treadwell", "treadwell.cli.start"])
def test_it_is_the_command_line(module: str) -> None:
    told = f"treadwell {__version__}\n"
    assert started(["-m", module, "--version"]) == (0, told, "")


@pytest.mark.parametrize(
    ("handler", "status"),
    [("signal.default_int_handler", -signal.SIGINT), ("signal.SIG_IGN", 0)],
)
def test_ctrl_c_amid_the_loading_is_no_traceback(handler: str, status: int) -> None:
    found, _, messages = started(["-c", INTERRUPTED.replace("HANDLER", handler)])
    assert found == status
    assert messages == ""
