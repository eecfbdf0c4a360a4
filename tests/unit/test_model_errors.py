"""Checks of arguments that all subpackages share."""

import copy
import inspect
import math
import pickle
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import rocking as rk
from rocking.cli.options import InvalidInput
from rocking.explorer.fields import Refused
from rocking.model.files import WriteError
from rocking.model.text import formatted, formatted_path
from rocking.model.validation import (
    REMEDIES,
    NoOrbit,
    Refusal,
    TooManyEvents,
    TooShort,
    exactly_one,
    one_of,
    reals,
    whole,
)
from rocking.survey.store_access import StoreError

ONE = {
    "array": np.array,
    "DataArray": xr.DataArray,
    "masked array": np.ma.array,
    "NumPy": np.float64,
    "Fraction": Fraction,
}
"""Forms of one number."""


@pytest.mark.parametrize("form", ONE.values(), ids=ONE)
def test_a_number_is_taken_in_any_form_without_dimensions(form):
    """Results are arrays and DataArrays, and an element of one is a number."""
    system = rk.System(rk.Harmonic(form(15), period=form(1)), restitution=form(0.5))
    assert system == rk.System(rk.Harmonic(15.0, period=1.0), restitution=0.5)
    assert rk.simulate(system, rk.State(form(0.25)), cycles=form(2)).cycles == 2
    assert rk.Block(form(2), form(0.5)) == rk.Block(2.0, 0.5)
    assert type(rk.Block(2.0, 0.5).seconds(form(1))) is float
    diagram = rk.orbit_diagram(
        system, amplitude=[14.0, 15.0], cycles=form(5), transient=form(0), section_phase=form(0.5)
    )
    assert diagram.section_phase == 0.5
    found = rk.parametric_map(
        system,
        rk.State(form(0.25)),
        amplitude=[2.0, 3.0],
        period=[1.0, 2.0],
        max_cycles=form(10),
    ).dataset
    assert (found.attrs["restitution"], found.attrs["angle"]) == (0.5, 0.25)
    assert rk.theory.free_impact_speed(form(0.5)) == rk.theory.free_impact_speed(0.5)


@pytest.mark.parametrize(
    "value",
    [np.array([5.0]), xr.DataArray([5.0]), np.array(True), np.bool_(True), np.array("5"), np.array(5j), np.timedelta64(5, "s"),
     xr.DataArray(np.timedelta64(5, "ns")), np.array(None), np.ma.masked],
    ids=repr,
)  # fmt: skip
def test_what_holds_no_single_real_number_is_no_number(value):
    with pytest.raises(TypeError, match=r"^height must be a real number in "):
        rk.Block(value, 0.5)
    with pytest.raises(TypeError, match=r"^cycles must be a whole number in "):
        whole("cycles", value, 1, 10)


@pytest.mark.parametrize("value", [math.nan, math.inf, -1.0])
def test_ranges_hold_for_numbers_in_arrays(value):
    for form in (np.array, xr.DataArray):
        with pytest.raises(ValueError, match=r"^height must lie in "):
            rk.Block(form(value), 0.5)


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


MASKED = np.ma.array([1.0, 9e99], mask=[False, True])


@pytest.mark.parametrize(
    "value", [np.ma.masked, MASKED, [MASKED, MASKED], (1.0, np.ma.masked), MASKED[1:], [[MASKED]]]
)
def test_masked_values_are_refused(value):
    with pytest.raises(
        ValueError, match=r"^times must hold no masked values; got .*\(leave them out, or fill them\)$"
    ):
        reals("times", value)
    for call in (
        rk.Block(2.0, 0.5).amplitude,
        rk.simulate(rk.System(rk.Harmonic(2.0, period=1.0), 0.9), cycles=1).at,
        rk.theory.free_impact_speed,
    ):
        with pytest.raises(ValueError, match="must hold no masked values"):
            call(value)


def test_masked_point_of_an_axis_is_refused():
    masked = np.ma.array(np.linspace(1.0, 2.0, 6), mask=[0, 1, 0, 0, 0, 0])
    with pytest.raises(ValueError, match="^amplitude must hold no masked values"):
        rk.parametric_map(
            rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.9),
            amplitude=masked,
            period=np.linspace(1.0, 2.0, 3),
        )


def test_array_whose_mask_hides_nothing_is_taken():
    assert reals("times", np.ma.array([1.0, 2.0])).tolist() == [1.0, 2.0]


@pytest.mark.parametrize("value", [10**400, -(10**400), 10**5000, Fraction(10**400)], ids=lambda _: "huge")
def test_number_beyond_all_floats_is_refused(value):
    with pytest.raises(
        ValueError, match=r"^times must be a real number of size up to 1e\+300; got "
    ) as caught:
        reals("times", value)
    assert len(str(caught.value).splitlines()) == 1
    with pytest.raises(ValueError, match="^acceleration must be a real number of size up to"):
        rk.Block(2.0, 0.5).amplitude(value)


BLOCK = rk.Block(2.0, 0.5)
# One value that is allowed for each argument of the closed forms.
ALLOWED = {
    "amplitude": 2.0, "angle": 0.5, "base_acceleration": 1.0, "block": BLOCK, "impacts": 2, "n": 1, "orbit": "upper", "period": 1.0,
    "phase": 0.5, "radians": 0.1, "radians_per_second": 0.1, "restitution": 0.8, "seconds": 0.5, "time": 0.5, "velocity": 0.5,
    "width": 1e-3, "height": 2e-3, "mass_ratio": 1.0, "critical_angle": 0.2, "fraction": 0.5, "duration": 1.0, "frequency": 2.0,
    "other": rk.Block(4.0, 1.0), "friction": 0.3, "acceleration": 0.5, "inertia_ratio": 1.3,
    "start": 0.5, "ground": rk.GroundMotion([0.0, 1.0, 0.0], step=0.1), "rule": "fema-356", "kind": "one-sine",
}  # fmt: skip
THEORY = [
    (function, name)
    for function in (getattr(rk.theory, name) for name in rk.theory.__all__)
    if inspect.isfunction(function)
    for name in inspect.signature(function).parameters
    if name not in ("block", "other", "orbit", "ground", "rule", "kind")
]


@pytest.mark.parametrize("value", [np.ma.masked, MASKED, 10**400], ids=["masked", "partly masked", "huge"])
@pytest.mark.parametrize("function, name", THEORY, ids=lambda each: getattr(each, "__name__", each))
def test_no_closed_form_takes_masked_values_or_numbers_beyond_all_floats(function, name, value):
    given = {each: ALLOWED[each] for each in inspect.signature(function).parameters}
    function(**given)
    with pytest.raises((TypeError, ValueError), match=rf"^{name} must ") as caught:
        function(**given | {name: value})
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize(
    "call",
    [
        lambda value: rk.simulate(rk.System(rk.Harmonic(2.0, period=1.0), 0.9), cycles=1).at(value),
        lambda value: rk.Harmonic(2.0, period=1.0).acceleration(value),
        BLOCK.frequency,
        lambda value: rk.plot.melnikov(value, 1.0, 0.9),
        lambda value: rk.chaos_share(
            rk.System(rk.Harmonic(1.0, period=1.0), restitution=1.0), restitution=value, samples=5
        ),
    ],
    ids=["at", "acceleration", "frequency", "melnikov", "chaos_share"],
)
def test_no_number_beyond_all_floats_is_taken(call):
    with pytest.raises((TypeError, ValueError)) as caught:
        call(10**400)
    assert len(str(caught.value).splitlines()) == 1


def test_one_of_names_the_choices():
    assert one_of("record", "all", ("all", "none")) == "all"
    with pytest.raises(ValueError, match=r"^record must be one of 'all', 'none'; got 'some'$"):
        one_of("record", "some", ("all", "none"))
    with pytest.raises(TypeError, match=r"^record must be one of 'all', 'none'; got 1$"):
        one_of("record", 1, ("all", "none"))


GIVEN = {
    "forcing": rk.Harmonic(2.0, period=1.0),
    "pulse": rk.Pulse("one-sine", amplitude=2.0, duration=1.0),
    "ground_motion": rk.GroundMotion([0.0, 1.0, 0.0], step=0.1),
    "block": BLOCK,
}


@pytest.mark.parametrize("name", [name for name in REMEDIES if REMEDIES[name].startswith("make one: ")])
def test_what_is_told_makes_a_value_of_the_kind(name):
    told = REMEDIES[name].removeprefix("make one: ").partition(", or ")[0]
    assert type(eval(told, {"rk": rk} | GIVEN)) is getattr(rk, name.rpartition(" ")[-1])


@pytest.mark.parametrize("value", GIVEN.values(), ids=GIVEN)
def test_what_is_given_for_a_system_says_how_it_becomes_one(value):
    with pytest.raises(TypeError, match=r"^system must be a System; got .*\(make one: .*\)$") as caught:
        rk.simulate(value)
    assert REMEDIES[f"{type(value).__name__} for System"] in str(caught.value)


class NoText:
    """Object without a text."""

    def __repr__(self):
        raise RuntimeError("no text")


ROUND = [1.0]
ROUND.append(ROUND)


@pytest.mark.parametrize(
    "value", ["a" * 5_000, [1] * 10**6, NoText(), [NoText()], ROUND, 10**5_000, {"a\nb": ROUND}], ids=range(7)
)
def test_any_value_is_shown_in_one_short_line(value):
    assert len(formatted(value)) <= 60
    with pytest.raises(TypeError, match="^angle must be ") as caught:
        rk.State(angle=[value])
    assert len(str(caught.value).splitlines()) == 1
    with pytest.raises((TypeError, ValueError), match="^times must be "):
        reals("times", value if type(value) is not list else [value, ROUND])


def test_a_long_path_is_shown_with_both_ends():
    assert formatted_path(Path("folder/map.png")) == "'folder/map.png'"
    text = formatted_path(Path("start" + "/a" * 5_000 + "/map.png"))
    assert text.startswith("'start/a/a/")
    assert text.endswith("/a/a/map.png'")
    assert len(text) <= 121


def test_values_are_shown_in_one_short_line():
    assert formatted(np.float64(1.5)) == "1.5"
    assert len(formatted(np.ones((50, 50)))) == 60
    assert "\n" not in formatted(np.ones((50, 50)))


def test_a_run_too_short_always_carries_its_estimate():
    assert TooShort("too short", 0.5).estimate == 0.5
    with pytest.raises(TypeError, match="estimate"):
        TooShort("too short")  # what supports no estimate at all is a plain ValueError


RAISED = [
    (TooShort("too short", rk.State(angle=0.5)), {"estimate": rk.State(angle=0.5)}),
    (NoOrbit("none", 1.0, rk.State(angle=0.5), 0.1), {"phase": 1.0, "state": rk.State(angle=0.5), "residual": 0.1}),
    (TooManyEvents("too many"), {}),
    (rk.RecordError("no step", "step"), {"argument": "step"}),
    (StoreError("damaged"), {"argument": ""}),
    (StoreError("store must be new", "store"), {"argument": "store"}),
    (WriteError("full"), {}),
    (InvalidInput("mistyped"), {"message": "mistyped"}),
    (Refused({"angle": "too large"}), {"fields": {"angle": "too large"}}),
]  # fmt: skip


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda error: pickle.loads(pickle.dumps(error))])
@pytest.mark.parametrize("error, carried", RAISED, ids=[type(error).__name__ for error, _ in RAISED])
def test_copy_of_an_error_says_and_carries_the_same(error, carried, again):
    error.add_note("in the second run")
    found = again(error)
    assert type(found) is type(error)
    assert (str(found), found.__notes__) == (str(error), error.__notes__)
    assert {name: getattr(found, name) for name in carried} == carried


@pytest.mark.long
def test_more_events_in_one_cycle_than_can_be_followed_are_refused():
    """Ten million impacts on two near braces without losses, which take five seconds."""
    system = rk.System(rk.Harmonic(amplitude=0.0, period=6000.0), restitution=1.0, braces=rk.Braces(0.001))
    with pytest.raises(TooManyEvents, match="^more than 10,000,000 events without an end: "):
        rk.simulate(system, rk.State(velocity=1000.0), cycles=1, record="none")


def test_more_events_than_can_be_recorded_are_refused(monkeypatch):
    monkeypatch.setattr("rocking.motion.march_loop.MAX_RECORDED", 50)
    system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    with pytest.raises(
        TooManyEvents, match=r"^more than 50 events to record \(run fewer cycles, or use record="
    ):
        rk.simulate(system, cycles=100)
    assert rk.simulate(system, cycles=100, record="none").impacts > 50


def test_a_refusal_has_fields_and_takes_the_names_that_a_user_typed():
    typed = {"period": "--period", "frequency": "--frequency"}
    with pytest.raises(Refusal) as raised:
        exactly_one(period=1.0, frequency=2.0)
    assert (
        str(raised.value.of(typed))
        == "give exactly one of --period, --frequency; got --period=1.0 and --frequency=2.0"
    )
    error = Refusal("period", "be at most the {frequency}", "{period}", "reduce {period}")
    assert (
        str(error.of(typed)) == "--period must be at most the --frequency; got '{period}' (reduce --period)"
    )
    assert (error.argument, error.value) == ("period", "{period}")


def test_a_pickled_refusal_keeps_its_text_and_not_its_value():
    error = Refusal("executor", "be an Executor", lambda: None).of({"executor": "--executor"})
    error.add_note("a note")
    copied = pickle.loads(pickle.dumps(error))
    assert type(copied) is Refusal
    assert str(copied) == str(error)
    assert copied.__notes__ == ["a note"]
    assert isinstance(copied.value, str)
