"""The page on a run: whole in one file, failures first, text as text, and what is missing told."""

import http.server
import json
import re
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from PIL import Image
from run_folders import plain_run, recorded_run
from test_repeat import typed

from treadwell.cli.app import execute
from treadwell.errors import InputError, RecordingError
from treadwell.judging.result import read_result
from treadwell.reporting import images, page, sections, strip
from treadwell.reporting.report import report
from treadwell.reporting.run_data import KNOWN, pose_errors, read_run

pytestmark = pytest.mark.slow

HOSTILE = "</p><script>alert('1')</script><img src=http://evil.example/x.png onerror=alert(2)>"


class Page(HTMLParser):
    """What a browser would make of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        if data.strip():
            self.texts.append(data.strip())

    def addresses(self) -> list[str]:
        names = ("src", "href", "action", "data", "poster", "srcset", "xlink:href")
        return [
            value or "" for _, each in self.tags for name, value in each.items() if name in names
        ]

    def where(self, text: str) -> int:
        return next(i for i, each in enumerate(self.texts) if text in each)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = report([recorded_run()], tmp_path_factory.mktemp("page"))
    assert path.name == "report.html"
    return path.read_text()


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    return Path(shutil.copytree(recorded_run(), tmp_path / "run"))


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out the robot's pictures, of which nothing is claimed: a process and a second each."""
    monkeypatch.setattr(sections, "strip", lambda _: ())


DRAWN_OF = ("physics.npz", "model.mjb")
"""The files of which the robot's pictures are drawn."""


def test_the_page_asks_for_nothing_outside(made: str) -> None:
    found = Page(made)
    assert all(each.startswith(("data:", "#")) for each in found.addresses())
    assert not [tag for tag, _ in found.tags if tag in ("script", "iframe", "object", "embed")]
    assert not [name for _, each in found.tags for name in each if name.startswith("on")]
    styles = re.findall(r"<style>(.*?)</style>", made, re.DOTALL)
    assert "url(" not in "".join(styles)
    assert "@import" not in "".join(styles)
    policy = next(each["content"] for tag, each in found.tags if "http-equiv" in each)
    assert policy is not None
    assert policy.startswith("default-src 'none'")


def test_the_page_is_of_sane_size_and_has_its_pictures(made: str) -> None:
    assert 50_000 < len(made) < 2_000_000
    found = Page(made)
    kinds = [(each["src"] or "").partition(";")[0] for tag, each in found.tags if tag == "img"]
    assert kinds == ["data:image/jpeg"] * 4 + ["data:image/png"]
    assert sum(tag == "svg" for tag, _ in found.tags) == 5


def test_failures_come_first(made: str) -> None:
    found = Page(made)
    failure = found.where("expected goal_reached")
    assert found.where("Expectations not met") < failure < found.where("simulated")
    assert failure < found.where("Run it again") < found.where("Map and way")
    assert failure < found.where("Time (ms)")


def test_the_command_runs_the_same_again(made: str) -> None:
    command = next(text for text in Page(made).texts if text.startswith("treadwell run"))
    result = read_result(recorded_run() / "result.json")
    assert typed(command) == result.configuration
    assert "--set" in command


def test_the_figures_are_the_results(made: str) -> None:
    result = read_result(recorded_run() / "result.json")
    texts = Page(made).texts
    assert result.localization is not None
    assert f"{1e3 * result.localization.translation_error.mean:.2f}" in texts
    assert str(result.timing_ms["map"].count) in texts
    run = read_run(recorded_run())
    _, place, turn = pose_errors(run)
    assert place.mean() == pytest.approx(result.localization.translation_error.mean, abs=1e-8)
    assert turn.max() == pytest.approx(result.localization.heading_error.max, abs=1e-6)


def tampered(folder: Path, **changes: Any) -> None:  # noqa: ANN401
    document = json.loads((folder / "result.json").read_text())
    document["configuration"]["description"] = HOSTILE
    (folder / "result.json").write_text(json.dumps(document | changes))


@pytest.mark.usefixtures("undrawn")
def test_what_others_wrote_stays_text(copy: Path, tmp_path: Path) -> None:
    tampered(
        copy,
        scenario=HOSTILE,
        robot=HOSTILE + "\x00",
        version=HOSTILE,
        reason=HOSTILE,
        failures=[HOSTILE],
        collisions=[{"time": 1, "robot_part": HOSTILE, "element": HOSTILE, "impulse": 1}],
        surfaces=[{"element": HOSTILE, "part": HOSTILE, "truth": 0, "estimate": 0, "cells": 1}],
        behaviour=[{"time": 0, "state": HOSTILE}, {"time": 2.5, "state": HOSTILE + "2"}],
        timing_ms={HOSTILE: {"median": 1, "p99": 1, "max": 1, "count": 1}},
    )
    odd = copy.rename(tmp_path / "<b>run&amp;'\"")
    found = Page(report([odd]).read_text(encoding="utf-8"))
    assert all(each.startswith(("data:", "#")) for each in found.addresses())
    assert not [tag for tag, _ in found.tags if tag in ("script", "b")]
    assert not [name for _, each in found.tags for name in each if name.startswith("on")]
    assert sum(HOSTILE in text for text in found.texts) > 5


@pytest.mark.parametrize("name", sorted({*KNOWN} - {*DRAWN_OF}))
@pytest.mark.usefixtures("undrawn")
def test_what_is_missing_is_told(copy: Path, name: str) -> None:
    check_missing(copy, name)


@pytest.mark.parametrize("name", DRAWN_OF)
def test_what_is_missing_for_the_pictures_is_told(copy: Path, name: str) -> None:
    check_missing(copy, name)


def check_missing(copy: Path, name: str) -> None:
    """Remove a file of a run, and fail where its page does not say so."""
    (copy / name).unlink()
    found = Page(report([copy]).read_text())
    told = "cut off" if name == "result.json" else f"{name} is missing"
    assert found.where(told) < found.where("Run it again")


HARMS = ("empty", "noise", "half")


@pytest.mark.parametrize("name", ["map.png", "trajectory.tum", "trajectory_truth.tum"])
@pytest.mark.parametrize("harm", HARMS)
@pytest.mark.usefixtures("undrawn")
def test_a_broken_file_beside_the_result_is_told(copy: Path, name: str, harm: str) -> None:
    check_broken(copy, name, harm)


@pytest.mark.parametrize("name", DRAWN_OF)
@pytest.mark.parametrize("harm", HARMS)
def test_a_broken_file_for_the_pictures_is_told(copy: Path, name: str, harm: str) -> None:
    check_broken(copy, name, harm)


def check_broken(copy: Path, name: str, harm: str) -> None:
    """Break a file of a run, and fail where its page does not say so."""
    content = (copy / name).read_bytes()
    half = content[: len(content) // 2]
    (copy / name).write_bytes({"empty": b"", "noise": b"\xff\x00" * 500, "half": half}[harm])
    text = report([copy]).read_text()
    if not (name.endswith(".tum") and harm == "empty"):
        assert Page(text).where(name.partition(".")[0]) >= 0
        assert "What this run" in text


def test_a_run_that_was_cut_off_is_shown_as_far_as_it_went(tmp_path: Path) -> None:
    content = (recorded_run() / "observations.mcap").read_bytes()
    folder = tmp_path / "cut"
    folder.mkdir()
    (folder / "observations.mcap").write_bytes(content[: len(content) * 3 // 4])
    (folder / "recording.rrd").write_bytes((recorded_run() / "recording.rrd").read_bytes()[:5000])
    found = Page(report([folder]).read_text())
    assert "stairs_up · qrio · seed 4" in found.texts[0]
    assert found.where("the run was cut off at ") >= 0
    seconds = float(found.texts[found.where("recorded until") + 1].split()[0])
    assert 1.0 < seconds < 3.0
    assert execute(["report", str(folder)]) == 0


@pytest.mark.parametrize("content", [b"", b"{}", b"\xff\x00", b'{"schema": "x"}', b"[" * 100_000])
def test_a_result_that_is_garbage_is_bad_input(copy: Path, content: bytes) -> None:
    (copy / "result.json").write_bytes(content)
    with pytest.raises(InputError, match=r"result\.json"):
        report([copy])
    assert not (copy / "report.html").exists()
    assert execute(["report", str(copy)]) == 2


def test_a_folder_that_is_no_runs_is_bad_input(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("")
    for folder in (tmp_path, tmp_path / "none", tmp_path / "notes.txt"):
        assert execute(["report", str(folder)]) == 2


@pytest.mark.usefixtures("undrawn")
def test_several_runs_have_an_index_with_the_failed_ones_first(copy: Path, tmp_path: Path) -> None:
    good = Path(shutil.copytree(plain_run(), tmp_path / "good"))
    document = json.loads((good / "result.json").read_text())
    changes = {"passed": True, "failures": [], "outcome": "goal_reached", "reason": None}
    (good / "result.json").write_text(json.dumps(document | changes))
    text = report([good, copy], tmp_path / "both.html").read_text()
    found = Page(text)
    assert "1 of 2 runs passed" in found.texts
    links = [each for each in found.addresses() if each.startswith("#")]
    assert links == ["#run-2", "#run-1"]
    ids = [each["id"] for tag, each in found.tags if tag == "article"]
    assert ids == ["run-2", "run-1"]


def test_for_several_a_place_is_needed(copy: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="--out"):
        report([copy, copy])
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="--out"):
        report([copy], tmp_path / "file" / "x.html")


@pytest.mark.usefixtures("undrawn")
def test_json_says_where_the_page_is(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["report", str(copy), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["report"] == str(copy / "report.html")


@pytest.mark.usefixtures("undrawn")
def test_a_page_that_cannot_be_written_leaves_none(
    copy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(page, "write_text", full)
    with pytest.raises(RecordingError, match="No space left"):
        report([copy])


def test_a_large_picture_becomes_smaller(tmp_path: Path) -> None:
    path = tmp_path / "map.png"
    Image.effect_noise((3000, 900), 90).convert("RGB").save(path)
    assert path.stat().st_size > 1_000_000
    uri = images.picture_uri(path)
    assert uri.startswith("data:image/jpeg;base64,")
    assert len(uri) < 1_000_000


def test_a_model_that_kills_the_drawing_does_not_kill_the_page(
    copy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    code = "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"
    monkeypatch.setattr(images.sys, "executable", shutil.which("false") or "false")
    assert "cannot be drawn" in report([copy]).read_text()
    run = subprocess.run

    def dies(_words: list[str], **options: Any) -> Any:  # noqa: ANN401
        return run([sys.executable, "-c", code], **options)

    monkeypatch.undo()
    monkeypatch.setattr(images.subprocess, "run", dies)
    assert "cannot be drawn" in report([copy]).read_text()


def test_the_strip_goes_from_the_beginning_to_the_end() -> None:
    captions = [caption for _, caption in strip.shots(recorded_run())]
    assert [caption.split()[0] for caption in captions] == ["0.0", "1.0", "2.0", "3.0"]


def test_long_tables_are_cut_and_counted(copy: Path) -> None:
    hit = {"time": 1.0, "robot_part": "left_hand", "element": "box", "impulse": 0.5}
    tampered(copy, collisions=[hit] * 100)
    section = sections.run_section(read_run(copy), "run-1", pictures=False)
    assert len(section.first_tables[0].rows) == 60
    assert section.first_tables[0].note == "and 40 more"


CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
ITS_OWN = ("google.com", "googleapis.com", "gvt1.com", "gstatic.com")
"""Where the browser looks by itself."""


@pytest.fixture
def proxy() -> Iterator[tuple[int, list[str]]]:
    """A proxy that refuses everything and keeps what it was asked for."""
    asked: list[str] = []

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            asked.append(self.path)
            self.send_error(502)

        do_CONNECT = do_POST = do_HEAD = do_GET  # noqa: N815 - their names

        def log_message(self, *_: object) -> None:
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield server.server_address[1], asked
    server.shutdown()
    thread.join()
    server.server_close()


def browse(path: Path, port: int, profile: Path) -> tuple[str, str]:
    """Return the page as the browser built it, and what it wrote to its console."""
    assert CHROMIUM is not None
    words = [
        CHROMIUM, "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run",
        "--disable-background-networking", "--disable-component-update", "--disable-sync",
        f"--user-data-dir={profile}", f"--proxy-server=127.0.0.1:{port}",
        "--enable-logging=stderr", "--timeout=10000", "--dump-dom", path.as_uri(),
    ]  # fmt: skip
    done = subprocess.run(words, capture_output=True, text=True, timeout=120, check=False)
    console = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    return done.stdout, "\n".join(console)


def outside(asked: list[str]) -> list[str]:
    return [each for each in asked if not any(name in each for name in ITS_OWN)]


@pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here to open the page in")
def test_a_browser_opens_it_without_an_error_or_a_request(
    made: str, proxy: tuple[int, list[str]], tmp_path: Path
) -> None:
    port, asked = proxy
    path, control = tmp_path / "report.html", tmp_path / "control.html"
    path.write_text(made)
    dom, console = browse(path, port, tmp_path / "profile")
    assert console == ""
    assert outside(asked) == []
    assert "stairs_up · qrio · seed 4" in dom
    assert dom.count("<polyline") >= 4
    # The same way of looking does see a page that asks for something and has an error.
    control.write_text("<img src=http://canary.example/x.png><script>throw 'no'</script>")
    _, console = browse(control, port, tmp_path / "profile")
    assert "no" in console
    assert any("canary.example" in each for each in asked)
