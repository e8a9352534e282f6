"""Claims about files made to do harm: each is refused in one message, soon, and without a crash."""

import os
import shutil
from pathlib import Path

import hostile_files as files
import pytest
from hostile_files import MESHES, NO_FILE, ROBOTS, SCENARIOS, WORLDS, Make

import treadwell
from treadwell._core import Octree
from treadwell.cli.app import execute
from treadwell.errors import TreadwellError
from treadwell.limited import Limits, limited
from treadwell.mjcf.build import build_files
from treadwell.recording.observation_log import NAME
from treadwell.recording.verification import verify_run

pytestmark = [pytest.mark.timeout(60), pytest.mark.slow]
LONGEST_SECONDS = 5.0
"""Of the processor's time, children included: the clock's depends on what else runs."""


class Watch:
    """The processor's time since the last look."""

    def __init__(self) -> None:
        self._begin = self._now()

    def check(self) -> None:
        spent = self._now() - self._begin
        assert spent < LONGEST_SECONDS
        self._begin += spent

    @staticmethod
    def _now() -> float:
        times = os.times()
        return times.user + times.system + times.children_user + times.children_system


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Return the message of a command that must leave with 2."""
    watch = Watch()
    status = execute(arguments)
    watch.check()
    message = capsys.readouterr().err
    assert status == 2, message or "taken for good"
    assert "Traceback" not in message
    assert len(message) < 20_000
    return message


@pytest.mark.parametrize("name", SCENARIOS)
def test_a_hostile_scenario_is_refused(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    SCENARIOS[name](tmp_path / "x.toml")
    assert refused(capsys, "check", str(tmp_path / "x.toml"))


def course(folder: Path, kind: str, file: str) -> str:
    path = folder / "own.toml"
    path.write_text(f'{files.HEAD}[[course]]\nkind = "{kind}"\nfile = "{file}"\n')
    return str(path)


@pytest.mark.parametrize("name", WORLDS)
def test_a_hostile_world_is_refused(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    WORLDS[name](tmp_path / "room.xml")
    assert "room.xml" in refused(capsys, "check", course(tmp_path, "mjcf", "room.xml"))


@pytest.mark.parametrize("name", MESHES)
def test_a_hostile_mesh_is_refused(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, make = MESHES[name]
    make(tmp_path / file)
    assert file in refused(capsys, "check", course(tmp_path, "mesh", file))


@pytest.mark.parametrize("name", ROBOTS)
def test_a_hostile_robot_is_refused(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ROBOTS[name](tmp_path / "robot")
    message = refused(capsys, "check", "slalom", "--robot", str(tmp_path / "robot"))
    assert str(tmp_path / "robot") in message


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A tenth of a second of a run, recorded."""
    out = tmp_path_factory.mktemp("runs") / "run"
    return treadwell.run("slalom", overrides=("time_limit=0.1",), out=out).folder


FILES = (
    "result.json",
    "trajectory.tum",
    "map.png",
    "model.mjb",
    "physics.npz",
    "recording.rrd",
    NAME,
)


@pytest.mark.parametrize("file", FILES)
@pytest.mark.parametrize("name", NO_FILE)
def test_a_hostile_file_of_a_run_is_named(file: str, name: str, run: Path, tmp_path: Path) -> None:
    copy = Path(shutil.copytree(run, tmp_path / "copy"))
    (copy / file).unlink()
    NO_FILE[name](copy / file)
    watch = Watch()
    found = verify_run(copy)
    watch.check()
    assert any(file in problem for problem in found.problems)


def lying(run: Path, name: str, old: bytes, new: bytes) -> Make:
    """The run's file in which some bytes are others."""
    content = (run / name).read_bytes()
    assert content.count(old), old
    return files.data(content.replace(old, new, 1))


@pytest.mark.parametrize("name", NO_FILE)
def test_a_hostile_log_is_not_replayed(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "run").mkdir()
    NO_FILE[name](tmp_path / "run" / NAME)
    assert NAME in refused(capsys, "replay", str(tmp_path / "run"))
    assert list(tmp_path.iterdir()) == [tmp_path / "run"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b'"seed": 0', b'"seed": 1'),
        (b'"robot_navigation"', b'"robot_navigatiox"'),
        (b'"settings": {', b'"settings": ['),
    ],
)
def test_a_log_whose_attachments_were_changed_is_not_replayed(
    run: Path, old: bytes, new: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "run").mkdir()
    lying(run, NAME, old, new)(tmp_path / "run" / NAME)
    assert "checksum" in refused(capsys, "replay", str(tmp_path / "run"))


def test_a_model_that_crashes_mujoco_is_a_problem_and_no_crash(run: Path, tmp_path: Path) -> None:
    content = (run / "model.mjb").read_bytes()
    copy = Path(shutil.copytree(run, tmp_path / "copy"))
    passed = []
    for start in (100, len(content) // 3, len(content) // 2, 2 * len(content) // 3):
        changed = bytearray(content)
        changed[start : start + 4000] = b"\x7f" * 4000
        (copy / "model.mjb").write_bytes(changed)
        passed.append(verify_run(copy).passed)
    assert not all(passed)


TREES: dict[str, bytes] = {
    "no header": b"\x00" * 100,
    "a header alone": b"# Octomap OcTree file\nid OcTree\nsize 5\nres 0.1\ndata\n",
    "trillions": b"# Octomap OcTree file\nid OcTree\nsize 999999999999\nres 0.1\ndata\n\xff",
    "negative": b"# Octomap OcTree file\nid OcTree\nsize -1\nres 0.1\ndata\n",
    "NaN": b"# Octomap OcTree file\nid OcTree\nsize 1\nres nan\ndata\n" + bytes(8),
    "no size of a voxel": b"# Octomap OcTree file\nid OcTree\nsize 1\nres 0\ndata\n" + bytes(8),
    "deep": b"# Octomap OcTree file\nid OcTree\nsize 99\nres 0.1\ndata\n" + b"\xff" * 100_000,
    "another tree": b"# Octomap OcTree file\nid OcTreeStamped\nsize 1\nres 0.1\ndata\n" + bytes(8),
    "no end of the header": b"# Octomap OcTree file\n" + b"x" * 1_000_000,
    "a number too long": b"# Octomap OcTree file\nid OcTree\nsize " + b"9" * 10_000 + b"\ndata\n",
}


@pytest.mark.parametrize("suffix", [".bt", ".ot"])
@pytest.mark.parametrize("name", TREES)
def test_a_hostile_octree_is_refused(name: str, suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"x{suffix}"
    path.write_bytes(TREES[name].replace(b"OcTree file", b"OcTree binary file", suffix == ".bt"))
    watch = Watch()
    with pytest.raises(TreadwellError):
        Octree.read(str(path))
    watch.check()


@pytest.mark.parametrize("name", NO_FILE)
def test_what_is_no_octree_is_refused(name: str, tmp_path: Path) -> None:
    path = tmp_path / "x.bt"
    NO_FILE[name](path)
    watch = Watch()
    with pytest.raises(TreadwellError, match=r"x\.bt"):
        Octree.read(str(path))
    watch.check()


def test_a_child_that_goes_on_and_on_is_ended(tmp_path: Path) -> None:
    path = tmp_path / "x.xml"
    inside = (
        "<replicate count='3000'><replicate count='3000'><geom size='1'/></replicate></replicate>"
    )
    files.world(inside)(path)
    watch = Watch()
    with pytest.raises(TreadwellError, match="this: cannot be read within 1 s"):
        limited(build_files, [str(path), "this"], "this", Limits(cpu_seconds=1))
    watch.check()
    with pytest.raises(TreadwellError, match="takes too long"):
        limited(build_files, [str(path), "this"], "this", Limits(deadline_seconds=0.2))


def test_a_child_that_takes_all_memory_is_ended(tmp_path: Path) -> None:
    path = tmp_path / "x.xml"
    files.model("<size memory='3G'/><worldbody><geom size='1'/></worldbody>")(path)
    limits = Limits(memory_bytes=2 << 30)
    with pytest.raises(TreadwellError, match=r"x\.xml"):
        limited(build_files, [str(path), str(path)], str(path), limits)


def test_two_hundred_files_are_made_by_hand() -> None:
    counts = [len(kind) for kind in (SCENARIOS, WORLDS, MESHES, ROBOTS, TREES)]
    assert sum(counts) + len(FILES) * len(NO_FILE) >= 200
