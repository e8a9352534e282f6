"""Settings as Python has them are the same as on the command line, and so are variants."""

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from user_parts import Straight

from treadwell.errors import InputError
from treadwell.scenario.overrides import parse_setting
from treadwell.sweeps.settings import class_name, setting_texts, vary_texts
from treadwell.sweeps.variants import variants

PLAIN = st.text(st.characters(codec="utf-8") | st.sampled_from("\"',[]{}\\ =#"), max_size=20)
NUMBERS = st.booleans() | st.integers(-(2**53), 2**53) | st.floats(allow_nan=False)
VALUES = NUMBERS | PLAIN | st.lists(NUMBERS | PLAIN, max_size=4)


@given(VALUES)
def test_a_value_is_read_as_it_was_given(value: Any) -> None:  # noqa: ANN401
    (setting,) = setting_texts({"a.b": value}, {})
    assert parse_setting(setting) == ("a.b", value)


@given(st.lists(VALUES, min_size=1, max_size=4, unique_by=lambda value: json.dumps(value)))
def test_values_that_vary_are_read_as_they_were_given(values: list[Any]) -> None:
    (text,) = vary_texts({"a.b": values})
    made = [parse_setting(setting) for (setting,) in variants([text])]
    assert made == [("a.b", value) for value in values]


def test_names_stay_as_one_would_type_them() -> None:
    assert setting_texts({"navigation": {"planner": "a_star", "fog": {"cell": 0.05}}}, {}) == (
        "navigation.planner=a_star",
        "navigation.fog.cell=0.05",
    )
    assert setting_texts(["a=1", "b=x"], {"planner": Straight}) == (
        "a=1",
        "b=x",
        "navigation.planner=user_parts:Straight",
    )
    assert setting_texts({"a": np.float64(0.5), "b": (1, 2)}, {}) == ("a=0.5", "b=[1, 2]")
    assert vary_texts({"navigation.planner": [Straight, "a_star"], "x": [True, 2]}) == (
        "navigation.planner=user_parts:Straight,a_star",
        "x=true,2",
    )
    assert vary_texts(["x=1,2"]) == ("x=1,2",)


def test_what_cannot_be_a_setting_is_refused_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    class Local(Straight):
        pass

    of_main = type("Mine", (Straight,), {"__module__": "__main__"})
    for call, told in (
        (lambda: setting_texts("a=b", {}), "overrides: found"),
        (lambda: setting_texts({"a": None}, {}), "a: found None"),
        (lambda: setting_texts({"a": Straight()}, {}), "object of Straight; each episode makes"),
        (lambda: setting_texts({}, {"planer": "x"}), "did you mean 'planner'"),
        (lambda: vary_texts("a=b"), "vary: found"),
        (lambda: vary_texts({"a": "b"}), "vary: a: found"),
        (lambda: class_name(Local, "k"), "k: .*Local is defined within a function"),
        (lambda: class_name(of_main, "k"), "move it into a file, my_parts.py say"),
    ):
        with pytest.raises(InputError, match=told) as error:
            call()
        assert "\n" not in str(error.value)
    import __main__

    monkeypatch.delattr(__main__, "__file__", raising=False)
    with pytest.raises(InputError, match="defined in a notebook or a prompt"):
        class_name(of_main, "k")
