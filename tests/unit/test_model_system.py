"""Normalised values: valid and invalid arguments, messages and printed forms."""

import copy
import inspect
import math
import pickle
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from functools import partial

import attrs
import numpy as np
import pytest

import rocking as rk
from rocking.model.system import FORCINGS, NO_BRACES, check_start, quantities, system_of

SYSTEM = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)

MAKERS = {
    "amplitude": (lambda x: rk.Harmonic(x, period=1.0), 0, 1e3),
    "period": (lambda x: rk.Harmonic(1.0, period=x), 2 * math.pi * 1e-3, 2 * math.pi * 1e3),
    "frequency": (lambda x: rk.Harmonic(1.0, frequency=x), 1e-3, 1e3),
    "phase": (lambda x: rk.Harmonic(1.0, period=1.0, phase=x), -1e3, 1e3),
    "restitution": (lambda x: rk.System(SYSTEM.forcing, x), 0, 1),
    "angle": (rk.State, -1e300, 1e300),
    "velocity": (lambda x: rk.State(velocity=x), -1e300, 1e300),
    "brace angle": (rk.Braces, 1e-3, 1e3),
    "brace restitution": (lambda x: rk.Braces(1.0, x), 0, 1),
}


def refusal(call, kind=(ValueError, TypeError)):
    with pytest.raises(kind) as caught:
        call()
    message = str(caught.value)
    assert len(message.splitlines()) == 1
    return message


def allowed(name, words):
    """Return the start of an error message; a state that a motion reaches has the widest range."""
    if name in ("angle", "velocity"):
        words = "be a finite real number of size up to 1e+300; got "
    return f"{name.split()[-1]} must {words}"


@pytest.mark.parametrize("name", MAKERS)
def test_ends_of_the_range_are_allowed_and_what_lies_beyond_is_not(name):
    make, low, high = MAKERS[name]
    make(low)
    make(high)
    for beyond in (math.nextafter(low, -math.inf), math.nextafter(high, math.inf)):
        message = refusal(partial(make, beyond), ValueError)
        assert message.startswith(allowed(name, "lie in ["))
        assert message.endswith(f"; got {beyond!r}") or name == "amplitude"


@pytest.mark.parametrize("name", ["angle", "velocity"])
def test_start_lies_within_a_thousand_though_a_state_reached_may_not(name):
    rk.simulate(SYSTEM, rk.State(**{name: 1e3}), cycles=1)
    message = refusal(partial(rk.simulate, SYSTEM, rk.State(**{name: 1001}), cycles=1), ValueError)
    assert message == f"{name} must lie in [-1000, 1000]; got 1001.0"


@pytest.mark.parametrize("name", MAKERS)
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, np.float64("nan"), 10**400, -(10**400)])
def test_what_is_not_finite_is_a_value_error(name, value):
    assert refusal(lambda: MAKERS[name][0](value), ValueError).startswith(allowed(name, "lie in ["))


@pytest.mark.parametrize("name", MAKERS)
@pytest.mark.parametrize(
    "value",
    [
        True,
        np.True_,
        "1",
        b"1",
        1j,
        np.complex128(1),
        [1.0],
        (1.0,),
        np.ones(1),
        np.array([1.0]),
        np.ones((99, 99)),
        object,
        {},
    ],
)
def test_what_is_no_real_number_is_a_type_error(name, value):
    message = refusal(lambda: MAKERS[name][0](value), TypeError)
    assert message.startswith(allowed(name, "be a real number in ["))
    assert len(message) < 150


@pytest.mark.parametrize("name", sorted(set(MAKERS) - {"period", "frequency"}))
def test_none_is_a_type_error(name):
    assert allowed(name, "be a real number in [") in refusal(lambda: MAKERS[name][0](None), TypeError)


@pytest.mark.parametrize("one", [1, np.int64(1), np.float32(1), np.float64(1), Fraction(1)])
@pytest.mark.parametrize("name", MAKERS)
def test_every_real_number_becomes_a_float(name, one):
    value = MAKERS[name][0](one)
    assert value == MAKERS[name][0](1.0)
    assert all(
        type(part) in (float, type(None))
        for part in attrs.astuple(value, recurse=True)
        if not isinstance(part, tuple)
    )


def test_negative_amplitude_is_refused_with_the_way_out():
    expected = "amplitude must lie in [0, 1000]; got -2.0 (for the opposite direction add π to phase)"
    assert refusal(lambda: rk.Harmonic(-2.0, period=1.0), ValueError) == expected


@pytest.mark.parametrize(
    ("given", "got"),
    [({}, "none"), ({"period": 1.0, "frequency": np.float64(6)}, "period=1.0 and frequency=6.0")],
)
def test_exactly_one_of_period_and_frequency(given, got):
    assert refusal(lambda: rk.Harmonic(2.0, **given)) == f"give exactly one of period, frequency; got {got}"


def test_period_and_frequency_follow_from_each_other():
    assert rk.Harmonic(2.0, period=0.4).frequency == pytest.approx(5 * math.pi, rel=1e-15, abs=0)
    assert rk.Harmonic(2.0, frequency=math.pi / 2).period == pytest.approx(4.0, rel=1e-15, abs=0)


def test_reprs_show_what_was_given_and_evaluate_to_the_value():
    for value in (
        rk.Harmonic(2.0, period=0.4, phase=1.8),
        rk.Harmonic(2.0, frequency=3.0),
        rk.System(rk.Harmonic(2, period=1), 0.9, rk.Braces(1, 0.5)),
        rk.State(0.1, -0.2),
    ):
        assert (
            eval(
                repr(value),
                vars(rk) | {name: getattr(rk, name) for name in ("Harmonic", "System", "Braces", "State")},
            )
            == value
        )
    assert repr(rk.Harmonic(2.0, frequency=3.0)) == "Harmonic(amplitude=2.0, frequency=3.0, phase=0.0)"


def test_values_are_frozen_hashable_and_survive_copies_and_pickles():
    with pytest.raises(AttributeError):
        SYSTEM.restitution = 0.5
    assert copy.deepcopy(SYSTEM) == SYSTEM == pickle.loads(pickle.dumps(SYSTEM))
    assert hash(copy.deepcopy(SYSTEM)) == hash(SYSTEM)
    assert attrs.evolve(SYSTEM.forcing, amplitude=3.0) == rk.Harmonic(3.0, period=1.0)


def test_acceleration_of_the_base_is_equation_3():
    forcing = rk.Harmonic(2.0, period=4.0, phase=math.pi / 2)
    np.testing.assert_allclose(forcing.acceleration([0.0, 1.0, 2.0, 3.0]), [0.0, -2.0, 0.0, 2.0], atol=1e-15)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: rk.System(2.0, 0.9),
            f"forcing must be a base motion; got 2.0 ({FORCINGS})",
        ),
        (
            lambda: rk.System(SYSTEM.forcing, 0.9, braces=1.0),
            "braces must be a Braces; got 1.0 (make one: rk.Braces(angle=1.0))",
        ),
        (
            lambda: check_start(SYSTEM.forcing, rk.State()),
            (
                "system must be a System; got Harmonic(amplitude=2.0, period=1.0, phase=0.0) "
                "(make one: rk.System(forcing, restitution=0.925))"
            ),
        ),
        (
            lambda: check_start(SYSTEM, 0.5),
            "start must be a State; got 0.5 (make one: rk.State(angle=0.1, velocity=0.0))",
        ),
    ],
)
def test_values_of_another_kind_are_type_errors(call, message):
    assert refusal(call, TypeError) == message


def test_start_beyond_a_brace_is_refused_and_one_at_the_brace_is_not():
    braced = attrs.evolve(SYSTEM, braces=rk.Braces(0.5))
    for side in (-1, 1):
        check_start(braced, rk.State(side * 0.5, side * 2.0))
        check_start(SYSTEM, rk.State(side * 0.6))
        message = refusal(partial(check_start, braced, rk.State(side * 0.6)), ValueError)
        assert message == f"angle must lie between the braces, in [-0.5, 0.5]; got {side * 0.6}"


def test_outcomes_are_plain_strings():
    assert [str(outcome) for outcome in rk.Outcome] == ["bounded", "at-rest", "overturned"]
    assert rk.Outcome.AT_REST == "at-rest"


BRACED = rk.System(rk.Harmonic(2.0, period=1.3, phase=0.7), restitution=0.9, braces=rk.Braces(1.5, 0.8))


@pytest.mark.parametrize("system", [SYSTEM, BRACED])
def test_a_system_is_made_again_of_its_quantities(system):
    assert system_of(NO_BRACES | quantities(system)) == system


def test_quantities_have_the_names_of_kernel_parameters():
    from rocking.kernels.system import harmonic_parameters

    assert sorted(quantities(BRACED)) == sorted(inspect.signature(harmonic_parameters).parameters)
    assert quantities(BRACED) == dict(
        amplitude=2.0,
        period=1.3,
        frequency=math.tau / 1.3,
        phase=0.7,
        restitution=0.9,
        brace_angle=1.5,
        brace_restitution=0.8,
    )


def test_a_system_without_braces_has_no_quantities_of_theirs():
    assert not quantities(SYSTEM).keys() & NO_BRACES.keys()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: rk.State(angle=3),
            r"angle 3 is 3 times the critical angle, .*: block.angle\(degrees=3\) converts degrees$",
        ),
        (lambda: rk.State(-2.5, 1.0), r"angle -2.5 is 2.5 times the critical angle"),
        (lambda: rk.Braces(angle=3), r"angle 3 is 3 times the critical angle"),
        (lambda: rk.Block(height=200, width=50), r"height 200 m is unusual: sizes are in metres$"),
        (
            lambda: rk.Block(height=1.0, width=120.0, restitution=0.5),
            r"width 120 m is unusual: sizes are in metres$",
        ),
        (lambda: rk.Block(height=0.002, width=0.001), r"height 0.002 m is unusual: sizes are in metres$"),
        (
            lambda: rk.GroundMotion([0.0, 312.0], step=0.01),
            r"a PGA of 312 m/s² is unusual: check the unit of the samples$",
        ),
        (lambda: rk.GroundMotion([0.0, 0.003], step=0.01), r"a PGA of 0.003 m/s² is unusual"),
    ],
)
def test_value_out_of_all_reason_is_a_warning_at_the_line_of_the_user(make, message):
    with pytest.warns(rk.InputWarning, match=f"^{message}") as caught:
        make()
    assert [each.filename for each in caught] == [__file__]


def test_warning_of_an_angle_is_ignored_at_the_lines_of_tests_alone():
    rk.State(3.0)
    with ThreadPoolExecutor(1) as pool, pytest.raises(rk.InputWarning, match="angle 3 is"):
        pool.submit(rk.State, 3.0).result()  # at a line of the pool


@pytest.mark.filterwarnings("error")
def test_values_that_the_package_makes_or_that_are_usual_give_no_warning():
    far = {"brace_angle": 5.0, "brace_restitution": 0.5}
    assert (
        system_of({"amplitude": 2.0, "period": 1.0, "phase": 0.0, "restitution": 0.9} | far).braces.angle
        == 5.0
    )
    rk.State(2.0), rk.State(velocity=50.0), rk.Braces(2.0), rk.Block(100.0, 20.0), rk.Block(0.01, 0.002)
    overturning = rk.System(rk.Harmonic(amplitude=60.0, period=6.0), restitution=0.9)
    assert rk.simulate(overturning).final.angle < -2.0
    assert rk.classify(overturning).kind == "overturned"
    ground = rk.GroundMotion([0.0, 50.0, -0.01], step=0.01)
    assert ground.scaled(100.0).pga == 5_000.0
    assert rk.GroundMotion([0.0, 0.0], step=0.01).pga == 0.0
