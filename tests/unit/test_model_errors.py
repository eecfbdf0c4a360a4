"""Checks shared by every room."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.model.errors import WAYS, TooShort, one_of, reals, shown, whole


@pytest.mark.parametrize("value", [5, 5.0, np.int64(5), np.float64(5)])
def test_whole_numbers_become_ints(value):
    assert whole("cycles", value, 1, 10) == 5
    assert type(whole("cycles", value, 1, 10)) is int


@pytest.mark.parametrize("value", [0, 11, -1, 2.5, math.nan, math.inf, -math.inf])
def test_other_numbers_are_value_errors(value):
    with pytest.raises(ValueError, match=r"^cycles must be a whole number in \[1, 10\]; got ") as caught:
        whole("cycles", value, 1, 10)
    assert str(caught.value).endswith(repr(value))


@pytest.mark.parametrize("value", [True, "5", None, 5j, [5], np.array([5])])
def test_what_is_no_number_is_a_type_error(value):
    with pytest.raises(TypeError, match=r"^cycles must be a whole number in \[1, 10\]; got "):
        whole("cycles", value, 1, 10)


def test_reals_takes_numbers_and_arrays_of_them():
    assert reals("times", 3) == 3.0
    assert type(reals("times", 3)) is float
    assert reals("times", [[1, 2], [3, 4]]).dtype == float
    assert reals("times", []).shape == (0,)


@pytest.mark.parametrize(
    "value", ["a", None, True, [True], [1, None], [1, "a"], [[1], [1, 2]], 1j, {}, {1: 2}, object()]
)
def test_reals_refuses_everything_else_in_one_line(value):
    with pytest.raises(
        TypeError, match=r"^times must be a real number or an array of real numbers; got "
    ) as caught:
        reals("times", value)
    assert len(str(caught.value).splitlines()) == 1


def test_one_of_names_the_choices():
    assert one_of("record", "all", ("all", "none")) == "all"
    with pytest.raises(ValueError, match=r"^record must be one of 'all', 'none'; got 'some'$"):
        one_of("record", "some", ("all", "none"))
    with pytest.raises(TypeError, match=r"^record must be one of 'all', 'none'; got 1$"):
        one_of("record", 1, ("all", "none"))


@pytest.mark.parametrize("name", [name for name in WAYS if WAYS[name].startswith("make one: ")])
def test_what_is_told_makes_a_value_of_the_kind(name):
    told = WAYS[name].removeprefix("make one: ").removesuffix(", or by rk.Block")
    assert type(eval(told, {"rk": rk})) is getattr(rk, name)


def test_values_are_shown_in_one_short_line():
    assert shown(np.float64(1.5)) == "1.5"
    assert len(shown(np.ones((50, 50)))) == 60
    assert "\n" not in shown(np.ones((50, 50)))


def test_a_run_too_short_always_carries_its_estimate():
    assert TooShort("too short", 0.5).estimate == 0.5
    with pytest.raises(TypeError, match="estimate"):
        TooShort("too short")  # what supports no estimate at all is a plain ValueError
