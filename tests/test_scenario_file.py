"""`scenario.toml` runs the same again, and says where it came from."""

from pathlib import Path
from shutil import copy

import pytest

from treadwell.recording.scenario_file import origin_of, write_scenario
from treadwell.scenario.loading import find_scenario, load_scenario, scenario_names
from treadwell.sweeps.content import named_files


@pytest.mark.parametrize("name", scenario_names())
def test_every_scenario_comes_back_as_it_was_drawn(tmp_path: Path, name: str) -> None:
    made = load_scenario(name, seed=5)
    path = tmp_path / "scenario.toml"
    for file in named_files(made):  # of which no copy is made
        copy(file, tmp_path)
    write_scenario(path, made)
    assert load_scenario(path).configuration() == made.configuration()
    assert origin_of(path) == find_scenario(name)


@pytest.mark.parametrize("line", ["", "# no", '# as it was run; from "', "# as it was run; from 7"])
def test_a_file_that_does_not_say_it_has_no_origin(tmp_path: Path, line: str) -> None:
    (tmp_path / "scenario.toml").write_text(f"{line}\nschema = 1\n")
    assert origin_of(tmp_path / "scenario.toml") is None
    assert origin_of(tmp_path / "none.toml") is None
