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
