"""Claims about robot.toml: what does not have its form is refused with the key."""

import re
from pathlib import Path

import pytest

from treadwell.data import data_folder
from treadwell.errors import InputError
from treadwell.robot.reading import read_robot_file

QRIO = data_folder("models") / "qrio" / "robot.toml"

BROKEN = [
    ("[gait]", "[gait]\nextra = nan", "gait: must hold finite numbers"),
    ("[gait]", "[gait]\nextra = 2026-01-01", "gait: must hold finite numbers"),
    ("[head]", "[head", "TOML"),
    ("[head]", "[ranges]\nneck_pan = [1.0, -1.0]\n[head]", "ranges: neck_pan: its least angle"),
    ("period = 0.08", f"period = 0x{'f' * 4000}", r"camera\.period"),
    (
        "kp = 150.0",
        "kp = 0.0",
        r"motors\.hip_and_knee\.kp.*must be greater than or equal to 0.001, got 0",
    ),
    ("kp = 150.0", "kp = nan", r"motors\.hip_and_knee\.kp"),
    ("kp = 150.0", "kb = 150.0", r"motors\.hip_and_knee\.kb: unknown key; allowed are .*kp, kv"),
    (
        "no_load_speed",
        "no_load_sped",
        r"no_load_sped: unknown key; allowed are .*; did you mean 'no_load_speed'\?",
    ),
    ("[gait]", "[giat]", r"giat: unknown key; allowed are .*; did you mean 'gait'\?"),
    ("period = 0.08", "period = 0.085", "multiple of the control tick"),
    ("stall_torque = 1.4", "stall_torque = 0.4", "must not be below peak_torque"),
    ("period = 0.08", "period = 0.08\npool = 3", "pool must divide width and height, got 3"),
    ('sensor = "stereo"', 'sensor = "structured_light"', "needs its own table, and no other"),
    ("[gait]", "[navigation.ground]\nnoise_floor = 2026-01-01\n[gait]", "navigation: must hold"),
    ('model = "qrio.xml"', 'model = "../qrio.xml"', r"robot\.model"),
]


def test_the_file_of_qrio_has_the_form() -> None:
    assert read_robot_file(QRIO).robot.model == "qrio.xml"


@pytest.mark.parametrize(("old", "new", "message"), BROKEN)
def test_a_broken_file_is_refused_with_its_path_and_key(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    text = QRIO.read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "robot.toml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(InputError, match=message) as error:
        read_robot_file(path)
    assert str(path) in str(error.value)


def test_every_wrong_key_is_told_at_once(tmp_path: Path) -> None:
    text = QRIO.read_text(encoding="utf-8")
    path = tmp_path / "robot.toml"
    text = text.replace("radius = 0.14", "radius = 0").replace("width = 88", "width = 8.5")
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"body\.radius.*got 0\n.*camera\.width.*got 8\.5"):
        read_robot_file(path)


@pytest.mark.parametrize("number", ["5e-324", "1e-300", "1e308", "-1e308"])
def test_no_number_without_a_meaning_is_taken(tmp_path: Path, number: str) -> None:
    text = QRIO.read_text(encoding="utf-8")
    path = tmp_path / "robot.toml"
    for key in ("radius", "length", "quantum", "kp", "peak_torque", "no_load_speed", "baseline",
                "period", "horizontal_fov", "leg_offset", "gyro_noise", "force_noise"):  # fmt: skip
        if key in {"leg_offset", "gyro_noise", "force_noise"} and number == "1e-300":
            continue  # nearly none, which is no harm
        path.write_text(
            re.sub(rf"(?m)^{key} = [\d.]+", f"{key} = {number}", text), encoding="utf-8"
        )
        with pytest.raises(InputError, match=rf"\.{key}: .*must be .*, got "):
            read_robot_file(path)


def test_minus_nothing_is_nothing(tmp_path: Path) -> None:
    path = tmp_path / "robot.toml"
    text = QRIO.read_text(encoding="utf-8").replace("yaw_error = 0.01745", "yaw_error = -0.0")
    path.write_text(text, encoding="utf-8")
    assert str(read_robot_file(path).encoders.camera_yaw_error) == "0.0"


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"robot\.toml: cannot be read"):
        read_robot_file(tmp_path / "robot.toml")
