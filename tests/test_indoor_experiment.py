"""Claims about the experiment `indoor`: the chapter's figures are drawn anew, or it is said why."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from treadwell._core import Embedding, split_and_merge
from treadwell.components import COMPONENTS
from treadwell.errors import InputError
from treadwell.experiments.catalogue import find_experiment
from treadwell.experiments.experiment import Table
from treadwell.experiments.indoor import labels
from treadwell.experiments.indoor.corridor import draw_corridor, draw_sonar
from treadwell.experiments.indoor.experiment import INDOOR, SCENES
from treadwell.experiments.indoor.figure import FigureToDraw, drawn
from treadwell.experiments.indoor.figures import BESIDE, FIGURES
from treadwell.experiments.indoor.looks import draw_looks
from treadwell.experiments.indoor.people import draw_people
from treadwell.experiments.indoor.walls import draw_split_and_merge

NOWHERE = Path()


def test_a_corridor_by_eighteen_scans_of_sonars_is_right_in_nine_of_ten_cells(
    tmp_path: Path,
) -> None:
    told = draw_corridor(tmp_path / "corridor.png", NOWHERE)
    assert int(told.partition("%")[0]) >= 90
    with Image.open(tmp_path / "corridor.png") as picture:
        assert picture.width > 2 * picture.height > 300


def test_an_echo_says_most_where_it_came_from_and_less_from_further_off(tmp_path: Path) -> None:
    told = draw_sonar(tmp_path / "sonar.png", NOWHERE)
    near, far = (words.split(" at ") for words in told.partition(": ")[2].split(", "))
    assert (float(near[1].split()[0]), float(far[1].split()[0])) == pytest.approx(
        (2.0, 2.5), abs=0.02
    )
    assert float(near[0]) > float(far[0]) > 0.5


def test_a_scan_is_split_as_far_as_asked(tmp_path: Path) -> None:
    told = draw_split_and_merge(tmp_path / "split.png", NOWHERE)
    coarse, middle, fine = (int(count) for count in told.split(" lines")[0].split(" / "))
    assert coarse < middle < fine == 9


def test_a_room_is_shown_as_planes_and_components_with_their_labels(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(labels, "_SCORED", range(1))
    told = labels.draw_groups(tmp_path / "groups.png", NOWHERE)
    true, found = (int(words.split()[0]) for words in told[3:].split(" surfaces "))
    assert 0.8 * true <= found <= true
    with Image.open(tmp_path / "groups.png") as picture:
        assert picture.width > 2 * picture.height > 300


def test_looks_of_a_kind_lie_together_in_three_dimensions(tmp_path: Path) -> None:
    told = draw_looks(tmp_path / "looks.png", NOWHERE)
    share = told.partition("the kind of ")[2].partition("%")[0]
    assert int(share) >= 90
    with pytest.raises(InputError, match=r"landmarks\.embedding\.dimensions must be"):
        Embedding(np.zeros((20, 4)), '{"dimensions": 0}')
    with pytest.raises(InputError, match="there are 3 looks, and more than 8 are needed"):
        Embedding(np.zeros((3, 4)))
    with pytest.raises(ValueError, match="as many finite numbers"):
        Embedding(np.eye(20)).place(np.zeros((1, 4)))


@pytest.mark.long
def test_some_of_what_a_robot_sees_among_people_is_left_out(tmp_path: Path) -> None:
    share = draw_people(tmp_path / "people.png", NOWHERE).partition("%")[0]
    assert 5.0 < float(share) < 30.0


def test_two_walls_are_two_lines_and_a_bad_setting_is_named() -> None:
    along = np.linspace(0.0, 1.0, 20)
    points = np.concatenate([np.stack([along, 0 * along], 1), np.stack([1 + 0 * along, along], 1)])
    found = split_and_merge(points, '{"threshold": 0.02}')
    assert [(first, last) for first, last, _, _ in found] == [(0, 19), (19, 39)] or len(found) == 2
    assert sorted(round(distance, 6) for *_, distance in found) == [0.0, 1.0]
    with pytest.raises(InputError, match=r"plan_view\.split_and_merge\.threshold must be"):
        split_and_merge(points, '{"threshold": -1.0}')


def test_a_figure_of_data_that_are_not_there_is_not_drawn_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (lines,) = (figure for figure in FIGURES if figure.number == "36.5")
    item = FigureToDraw(lines, tmp_path / "lines.png")
    monkeypatch.delenv("TREADWELL_DATA", raising=False)
    assert drawn(item).path is None
    assert "TREADWELL_DATA" in drawn(item).ours
    monkeypatch.setenv("TREADWELL_DATA", str(tmp_path))
    (table,) = BESIDE.tables([drawn(item)])
    assert "has no laser2d/intel-lab.log.gz" in table.rows[0][-1]
    assert list(BESIDE.pictures([drawn(item)])) == []


def test_each_part_runs_on_scenes_that_it_can_represent_and_there_is_a_figure_for_each_map() -> (
    None
):
    assert find_experiment("indoor") is INDOOR
    for part in SCENES:
        key, _, name = part.partition("=")
        assert name in COMPONENTS[key.removeprefix("navigation.")]
    assert len(INDOOR.cases) == sum(len(scenes) for scenes in SCENES.values())
    assert list(INDOOR.tables({})) == []
    assert isinstance(BESIDE.tables([])[0], Table)
    items = BESIDE.items(NOWHERE)
    assert len({item.path for item in items}) == len(FIGURES)
