"""Large and strange scenario files: reading one takes time by its length."""

import time
from pathlib import Path

import pytest
from test_scenario import HEAD, message, write

from treadwell.scenario.loading import load_scenario

WORDS = ".".join("a" * 150)


@pytest.mark.parametrize(
    "text",
    [
        f"{WORDS} = 1",
        f"[{WORDS}]",
        WORDS.replace(".", " . ") + " = 1",
        WORDS.replace("a", '"a.b"') + " = 1",
        f'x = """\n""", {{ z = 1 }}\ny = {{ z = """\n""", "k".{WORDS} = 1, q = "" }}',
    ],
)
def test_a_key_of_more_words_than_the_parser_is_quick_with_is_refused(
    tmp_path: Path, text: str
) -> None:
    assert "a key of more than 100 words" in message(write(tmp_path, text))


def test_dots_in_comments_and_texts_are_no_key(tmp_path: Path) -> None:
    dots = "." * 150
    text = f'# {dots}\ndescription = "{dots}" # \'{dots}\n{HEAD}'
    path = write(tmp_path, text)
    assert load_scenario(path).description == dots


@pytest.mark.parametrize(
    "content",
    [
        ".".join("a" * 99) + " = 1\n",
        "#" + ("a" * 100 + ".") * 9000,
        '"\\' * 200_000,
        "'''" + '"""' * 100_000,
        "".join(f"k{i}=1\n" for i in range(90_000)),
        f"seed = 0x{'f' * 900_000}\n{HEAD}[vary]\n'goal.radius' = {{ uniform = [0.1, 0.2] }}",
    ],
    ids=["long_key", "dots", "quotes", "triple_quotes", "unknown_keys", "seed"],
)
def test_a_large_file_is_refused_quickly(tmp_path: Path, content: str) -> None:
    path = write(tmp_path, content)
    begin = time.process_time()
    assert message(path)
    assert time.process_time() - begin < 4.0


def test_a_robots_folder_is_looked_for_from_the_file_that_names_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for folder in ("robots/mine", "here/mine", "scenarios/qrio"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "robot.toml").write_text("")
    monkeypatch.chdir(tmp_path / "here")
    path = write(tmp_path / "scenarios", f'robot = "../robots/mine"\n{HEAD}')
    near, far = str(tmp_path / "here" / "mine"), str(tmp_path / "robots" / "mine")
    assert load_scenario(path).robot == far
    assert load_scenario(Path("../scenarios") / path.name).robot == far
    # What comes of the shell or of Python is looked for from the working folder.
    assert load_scenario(path, robot="mine").robot == near
    assert load_scenario(path, robot=Path("mine")).robot == near
    assert load_scenario(path, overrides=["robot=mine"]).robot == near
    assert load_scenario(path, overrides={"robot": "./mine"}).robot == near
    # One that ships with the package comes first; draws are the file's.
    assert load_scenario(write(path.parent, f'robot = "qrio"\n{HEAD}')).robot == "qrio"
    drawn = '[vary]\nrobot = { choice = ["../robots/mine"] }\n'
    assert load_scenario(write(path.parent, HEAD + drawn)).robot == far


def test_a_robot_that_is_nowhere_is_one_message_with_file_key_and_place(tmp_path: Path) -> None:
    path = write(tmp_path, f'robot = "../qiro"\n{HEAD}')
    said = message(path)
    assert said.startswith(f'{path}: robot: found "../qiro"; must be one of h130, nao, qrio, ')
    assert f"there is no {tmp_path / '../qiro/robot.toml'}" in said
    assert "did you mean 'qrio'" in message(write(tmp_path, f'robot = "qiro"\n{HEAD}'))
    assert said.count("\n") == 0
    assert load_scenario(path, robot="nao").robot == "nao"
