"""Claims about the command's beginning: Ctrl-C while the package is loaded is no traceback."""

import signal
import subprocess
import sys
from pathlib import Path

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

MAPPED = """
import numpy as np
from treadwell import mapping

camera = mapping.Camera(width=40, height=30, fx=30.0, fy=30.0, cx=19.5, cy=14.5)
world = mapping.Map("fog", camera)
down = np.diag([1.0, -1.0, -1.0, 1.0])
down[2, 3] = 0.5
assert world.insert(np.full((30, 40), 0.5, np.float32), down).used
world.save_picture("map.png")
world.save_recording("map.rrd")
"""
COMMANDED = """
from treadwell.cli.app import execute

assert execute(["map", "floor.pcd", "--world-model", "elevation", "--out", "map"]) == 0
"""
"""A map of a cloud, with picture and recording, by the command."""


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


@pytest.mark.parametrize(
    "program",
    ["import treadwell", "import treadwell.mapping", MAPPED, COMMANDED],
    ids=["package", "library", "map of pictures", "command map"],
)
def test_maps_without_a_robot_are_made_without_mujoco(program: str, tmp_path: Path) -> None:
    rows = "\n".join(f"{0.05 * x} {0.05 * y} 0.0" for x in range(20) for y in range(20))
    header = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 400\nHEIGHT 1\n"
    (tmp_path / "floor.pcd").write_text(f"{header}POINTS 400\nDATA ascii\n{rows}\n")
    loaded = "print(sorted({'mujoco', 'treadwell.robot.load'} & set(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", f"import sys\n{program}\n{loaded}"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout.splitlines()[-1:]) == (0, ["[]"]), done.stderr
