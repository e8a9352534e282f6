"""The same sweep on a Ray cluster of two nodes; skipped without Ray, but never in CI."""

import os
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from sweep_builders import short

from treadwell.cli.app import execute
from treadwell.sweeps import ray_engine as engines
from treadwell.sweeps.conduct import Care, conduct
from treadwell.sweeps.engine import local_engine
from treadwell.sweeps.request import crossed

ROOT = Path(__file__).resolve().parent.parent
CLOCK = {"wall_seconds", "core_ms", "folder", "reproduced"}


@pytest.fixture
def cluster(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Two nodes of one processor each, on this machine."""
    if not os.environ.get("CI"):
        pytest.importorskip("ray", reason="the extra `ray` is not installed")
    # As `ray_engine` has it; `make test` is `uv run`. Ray reads it when it is imported.
    monkeypatch.setenv("RAY_ENABLE_UV_RUN_RUNTIME_ENV", "0")
    import ray
    from ray.cluster_utils import Cluster

    monkeypatch.setenv("RAY_USAGE_STATS_ENABLED", "0")
    # Ray's workers are the nicest of all: beside other tests they would hardly ever run.
    monkeypatch.setenv("RAY_worker_niceness", "0")
    monkeypatch.setenv("RAY_worker_register_timeout_seconds", "300")
    made = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False})
    made.add_node(num_cpus=1)
    ray.init(address=made.address, log_to_driver=False)
    yield
    ray.shutdown()
    made.shutdown()


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.filterwarnings("ignore")  # Ray leaves files open, and warns of its own changes
@pytest.mark.long
def test_on_two_nodes_episodes_come_out_as_on_one_machine(cluster: None, tmp_path: Path) -> None:  # noqa: ARG001
    request = crossed([short(tmp_path)], seeds=range(4))
    care = Care(keep=1)
    there = conduct(request, tmp_path / "ray", lambda: engines.ray_engine(None), care=care)
    here = conduct(request, tmp_path / "local", lambda: local_engine(1), care=care)
    for a, b in zip(there["episodes"], here["episodes"], strict=True):
        assert {k: a[k] for k in a.keys() - CLOCK} == {k: b[k] for k in b.keys() - CLOCK}
        assert (tmp_path / "ray" / a["folder"] / "recording.rrd").is_file()


def test_without_ray_the_command_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "ray", None)
    asked = ["sweep", short(tmp_path), "--episodes", "1", "--engine", "ray"]
    assert execute([*asked, "--out", str(tmp_path / "out")]) == 2
    assert "Ray is not installed: pip install 'ray>=" in capsys.readouterr().err


def test_what_extras_bring_is_there_for_the_tests_all_but_the_window() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    extras = project["project"]["optional-dependencies"]
    del extras["view"]
    asked = {package(one) for wanted in extras.values() for one in wanted}
    assert asked - set(map(package, project["dependency-groups"]["dev"])) == set()


def package(requirement: str) -> str:
    found = re.match(r"[\w.-]+", requirement)
    assert found is not None
    return found[0]
