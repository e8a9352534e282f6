"""Claims about reading MJCF: what could do harm is refused, what is no number, too."""

from pathlib import Path

import pytest

from treadwell.errors import InputError
from treadwell.mjcf import build
from treadwell.mjcf.build import check_builds, compiled, read_spec
from treadwell.mjcf.xml import check_xml

BOX = "<mujoco><worldbody><geom type='box' size='1 1 1'/></worldbody></mujoco>"


def test_entities_are_refused_before_they_grow(tmp_path: Path) -> None:
    path = tmp_path / "room.xml"
    path.write_text('<!DOCTYPE a [<!ENTITY b "c">]><mujoco>&b;</mujoco>')
    with pytest.raises(InputError, match="DOCTYPE"):
        check_xml(path, tmp_path, "room")


def test_a_file_outside_its_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "other.xml").write_text(BOX)
    folder = tmp_path / "room"
    folder.mkdir()
    with pytest.raises(InputError, match="the room: lies outside the folder 'room'"):
        check_xml(tmp_path / "other.xml", folder, "the room")


def test_a_number_that_is_none_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "room.xml"
    path.write_text(BOX)
    spec = read_spec(path, "room")
    assert compiled(spec, "room").ngeom == 1
    spec.option.gravity = [0.0, 0.0, float("nan")]
    with pytest.raises(InputError, match=r"room: a number is not finite \(gravity\)"):
        compiled(spec, "room")


def test_a_file_is_built_in_a_child_once_for_each_content(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    built = []
    monkeypatch.setattr(build, "limited", lambda *call: built.append(call[2]))
    path = tmp_path / "room.xml"
    for text in (BOX, BOX, BOX.replace("size='1 1 1'", "size='1 1 1.5'")):
        if not path.exists() or path.read_text() != text:
            path.write_text(text)
        check_builds(path, "room")
    assert built == ["room", "room"]
