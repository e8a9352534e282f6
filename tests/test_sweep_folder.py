"""A sweep's folder: whose it is, what is thrown away, and what its rows say of the recordings."""

import json
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Self

import pytest
from sweep_builders import short

from treadwell.errors import InputError, RecordingError
from treadwell.sweeps.conduct import Care, conduct
from treadwell.sweeps.folder import SweepFolder
from treadwell.sweeps.job import Job
from treadwell.sweeps.journal import Journal
from treadwell.sweeps.request import Request, crossed
from treadwell.sweeps.row import Row
from treadwell.workers.answers import Answer, Died, Done, Raised


class Told:
    """An engine that is told what comes of a job, without a recording and with one."""

    def __init__(self, plain: Callable[[Job], Answer], recorded: Callable[[Job], Answer]) -> None:
        self._how, self._jobs = (plain, recorded), deque[Job]()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def submit(self, item: Any, *_: object, **__: object) -> None:  # noqa: ANN401
        self._jobs.append(item)

    def answers(self) -> Iterator[tuple[Job, Answer]]:
        while self._jobs:
            job = self._jobs.popleft()
            yield job, Done(None) if job.check else self._how[job.folder is not None](job)


def passed(job: Job) -> Done:
    if job.folder is not None:
        job.folder.mkdir()
    key = job.key
    row = Row(key.scenario, key.robot, key.variant, key.seed, "goal_reached", digest="good")
    return Done(replace(row, passed=True, success=True))


def fell(job: Job) -> Done:
    return Done(replace(passed(job).value, outcome="fell", success=False, digest="bad"))


def died(_: Job) -> Died:
    return Died("out of memory?")


def full(_: Job) -> Raised:
    return Raised("no space", RecordingError("no space"))


def asked(tmp_path: Path, seeds: int = 1) -> Request:
    return crossed([short(tmp_path)], seeds=range(seeds))


def first_row(
    tmp_path: Path, plain: Callable[[Job], Answer], recorded: Callable[[Job], Answer]
) -> dict[str, Any]:
    told = conduct(
        asked(tmp_path), tmp_path / "out", lambda: Told(plain, recorded), care=Care(keep=0)
    )
    row: dict[str, Any] = told["episodes"][0]
    return row


@pytest.mark.parametrize(
    ("plain", "recorded", "reproduced"),
    [
        (passed, fell, None),
        (fell, fell, True),
        (fell, passed, False),
        (fell, died, False),
        (died, passed, False),
        (died, died, None),
    ],
)
def test_a_recording_that_went_another_way_is_complained_of(
    tmp_path: Path,
    plain: Callable[[Job], Answer],
    recorded: Callable[[Job], Answer],
    reproduced: bool | None,
) -> None:
    assert first_row(tmp_path, plain, recorded)["reproduced"] is reproduced


def test_a_disk_that_is_full_for_the_recording_stops_the_sweep_and_loses_nothing(
    tmp_path: Path,
) -> None:
    with pytest.raises(RecordingError, match="no space"):
        first_row(tmp_path, fell, full)
    assert first_row(tmp_path, fell, fell)["reproduced"]


TWO = """
class First:
    def plan(self, view, stairs, start, goal):
        return 1


class Second:
    def plan(self, view, stairs, start, goal):
        return 2
"""


class Counted(Told):
    """Does all well, and remembers which variants were asked for."""

    def __init__(self, asked: list[str]) -> None:
        super().__init__(passed, passed)
        self._asked = asked

    def submit(self, item: Any, *_: object, **__: object) -> None:  # noqa: ANN401
        super().submit(item)
        if not item.check:
            self._asked.append(f"{item.key.variant.rpartition(':')[2]} {item.key.seed}")


@pytest.fixture
def edited(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], Any]:
    """What sweeps two classes of one file over two seeds: the text -> asked, told and document."""
    monkeypatch.syspath_prepend(str(tmp_path))
    module = f"two_classes_of_{tmp_path.name}"

    def sweep(text: str, seeds: int = 2) -> tuple[list[str], list[str], dict[str, Any]]:
        (tmp_path / f"{module}.py").write_text(text)
        vary = [f"navigation.planner={module}:First,{module}:Second,a_star"]
        request = crossed([short(tmp_path)], seeds=range(seeds), vary=vary)
        ran: list[str] = []
        told: list[str] = []
        care = Care(keep=1)
        document = conduct(
            request, tmp_path / "out", lambda: Counted(ran), care=care, told=told.append
        )
        return ran, told, document

    return sweep


def test_only_what_ran_with_an_edited_class_runs_again(
    edited: Callable[..., Any], tmp_path: Path
) -> None:
    ran, told, before = edited(TWO)
    assert (len(ran), told) == (6, [])
    out = tmp_path / "out"
    assert edited(TWO.replace("return 2", "return 2  # two")) == ([], [], before)
    ran, told, after = edited(TWO.replace("return 2", "return 3"))
    assert ran == ["Second 0", "Second 1"]
    (sentence,) = told
    assert sentence.startswith(f"two_classes_of_{tmp_path.name}:Second was edited: 2 episodes")
    assert "4 are kept" in sentence
    assert sentence.endswith(str(out / "replaced" / "1"))
    assert len(after["episodes"]) == 6
    assert after["lines"] != before["lines"]
    kept = (out / "replaced" / "1" / "journal.jsonl").read_text().splitlines()
    assert [json.loads(line)["seed"] for line in kept] == [0, 1]
    recordings = [path.name for path in (out / "replaced" / "1" / "episodes").iterdir()]
    assert recordings == ["short-qrio-v2-0"]
    assert (out / "episodes" / "short-qrio-v2-0").is_dir()
    assert len((out / "journal.jsonl").read_text().splitlines()) == 6
    ran, told, _ = edited(TWO.replace("return 2", "return 4"), seeds=3)
    again, new = ["Second 0", "Second 1"], ["First 2", "Second 2", "navigation.planner=a_star 2"]
    assert ran == again + new
    assert (out / "replaced" / "2").is_dir()


def test_of_two_classes_that_were_edited_each_is_named(edited: Callable[..., Any]) -> None:
    edited(TWO)
    ran, told, _ = edited("STEP = 1\n" + TWO)
    assert len(ran) == 4
    assert [sentence.partition(" was")[0].rpartition(":")[2] for sentence in told] == [
        "First",
        "Second",
    ]
    assert all("2 episodes with it are run again, 2 are kept" in sentence for sentence in told)


def test_a_kill_before_the_rows_are_replaced_loses_none_and_one_after_runs_them_again(
    edited: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    edited(TWO)
    journal = tmp_path / "out" / "journal.jsonl"
    before = journal.read_bytes()

    def killed(*_: object) -> None:
        raise KeyboardInterrupt

    new = TWO.replace("return 2", "return 3")
    for method, rows in (("replace", 6), ("close", 4)):
        with monkeypatch.context() as patch:
            target = Journal if method == "replace" else SweepFolder
            patch.setattr(target, method if method == "replace" else "_note_asked", killed)
            with pytest.raises(KeyboardInterrupt):
                edited(new)
        assert len(journal.read_text().splitlines()) == rows
        assert rows < 6 or journal.read_bytes() == before
    ran, _, document = edited(new)
    assert ran == ["Second 0", "Second 1"]
    assert len(document["episodes"]) == 6


def test_a_sweep_of_another_build_is_refused_in_one_line(
    edited: Callable[..., Any], tmp_path: Path
) -> None:
    """One of the version before has no hashes of classes, but it has another build anyway."""
    edited(TWO)
    file = tmp_path / "out" / "sweep.json"
    document = json.loads(file.read_text())
    for line in document["lines"]:
        del line["classes"]
    file.write_text(json.dumps(document | {"build": "0123456789abcdef"}))
    with pytest.raises(InputError, match=r"treadwell's build was 0123456789abcdef, now") as error:
        edited(TWO)
    assert "\n" not in str(error.value)


def test_what_is_not_the_sweeps_stays_when_it_goes_on(tmp_path: Path) -> None:
    out, engine = tmp_path / "out", lambda: Told(passed, passed)
    conduct(asked(tmp_path), out, engine, care=Care(keep=1))
    mine = out / "episodes" / "short-qrio-0-replay"
    mine.mkdir()
    half_done = out / "episodes" / "short-qrio-1"
    half_done.mkdir()
    (half_done / "half").write_text("")
    conduct(asked(tmp_path, seeds=2), out, engine, care=Care(keep=1))
    assert mine.is_dir()
    assert (out / "episodes" / "short-qrio-0").is_dir()
    assert not half_done.exists()
