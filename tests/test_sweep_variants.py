"""Variants: every combination, commas within brackets or quotes aside."""

import pytest

from treadwell.errors import InputError
from treadwell.sweeps.variants import split_values, variants


def test_variants_are_every_combination() -> None:
    assert variants([]) == [()]
    assert variants(["a=1,2", "b=x"]) == [("a=1", "b=x"), ("a=2", "b=x")]
    assert len(variants(["a=1,2,3", "b=1,2", "c=1,2"])) == 12


def test_a_comma_in_brackets_or_quotes_parts_nothing() -> None:
    assert split_values("[1, 2],{a = 1, b = 2},'x,y'") == ["[1, 2]", "{a = 1, b = 2}", "'x,y'"]
    assert variants(["goal.position=[1, 0], [2, 0]"])[1] == ("goal.position=[2, 0]",)


@pytest.mark.parametrize(
    ("given", "what"),
    [
        (["a"], "must be KEY=A,B,C"),
        (["=1"], "must be KEY=A,B,C"),
        (["a=1,,2"], "a value is missing"),
        (["a="], "a value is missing"),
        (["a=1,1"], "something is twice"),
        (["a=1", "a=2"], "something is twice"),
        ([f"{key}=1,2,3,4,5,6,7,8,9,10" for key in "abcd"], "10000 variants"),
    ],
)
def test_what_is_no_variant_is_bad_input(given: list[str], what: str) -> None:
    with pytest.raises(InputError, match=what):
        variants(given)
