"""Parametric maps: each point has the result of `classify`."""

import math
import re

import numpy as np
import pytest

import rocking as rk
from rocking.kernels import batch
from surveyed import surveyed, system_with

WHERE = {"amplitude": np.linspace(0.5, 12.0, 5), "period": np.linspace(0.3, 2.5, 4)}
KINDS = dict(enumerate(rk.Kind))


def verdict_at(max_cycles, max_period, **at):
    forcing = {name: at[name] for name in ("amplitude", "period", "frequency", "phase") if name in at}
    braces = rk.Braces(at["brace_angle"], at.get("brace_restitution", 1.0)) if "brace_angle" in at else None
    start = rk.State(at.get("angle", 0.0), at.get("velocity", 0.0))
    return rk.classify(
        rk.System(rk.Harmonic(**forcing), at["restitution"], braces), start, max_cycles, max_period
    )


def told(value, otherwise):
    return otherwise if value is None else value


def check_against_classify(found, axes, fixed, max_cycles=200, max_period=64):
    for index in np.ndindex(found.kind.shape):
        values = {name: float(axes[name][i]) for name, i in zip(found.kind.dims, index, strict=True)}
        verdict = verdict_at(max_cycles, max_period, **values, **fixed)
        at = {name: found[name].values[index] for name in found.data_vars}
        assert KINDS[int(at["kind"])] is verdict.kind, values
        assert at["response_period"] == told(verdict.period, 0)
        assert at["impacts_per_period"] == told(verdict.impacts_per_period, -1)
        assert at["brace_hits_per_period"] == told(verdict.brace_hits_per_period, -1)
        assert at["symmetric"] == (2 if verdict.symmetric is None else verdict.symmetric)
        # A map marches blocks that lift off in lanes, which round differently.
        tolerance = 1e-9 if verdict.system.forcing.amplitude > 1.0 else 0.0
        for name in ("exponent", "exponent_error"):
            assert at[name] == pytest.approx(
                told(getattr(verdict, name), math.nan), abs=tolerance, rel=tolerance, nan_ok=True
            )
        # In chaos a rounding soon changes the peak too.
        if tolerance == 0.0 or verdict.kind != "undetermined":
            asked = {**values, **fixed}
            peaks = [
                verdict_at(max_cycles, max_period, **asked | {"amplitude": asked["amplitude"] + change}).peak
                for change in ((-2e-13, -1e-13, 1e-13, 2e-13) if tolerance else ())
            ]
            moved = max((abs(peak - verdict.peak) for peak in peaks), default=0.0)
            assert at["peak"] == pytest.approx(verdict.peak, abs=moved, rel=tolerance)
        assert at["cycles"] == verdict.cycles
        assert at["transient"] == told(verdict.transient, -1)


def test_every_point_is_what_classify_says():
    found = rk.parametric_map(system_with(restitution=0.9), **WHERE, max_cycles=200).dataset
    check_against_classify(found, WHERE, {"restitution": 0.9})


@pytest.mark.parametrize(
    "axes, fixed",
    [
        (
            {"frequency": np.linspace(2.0, 20.0, 4), "amplitude": np.linspace(1.0, 9.0, 4)},
            {"restitution": 1.0},
        ),
        (
            {"restitution": np.linspace(0.5, 1.0, 4), "phase": np.linspace(-9.0, 9.0, 4)},
            {"amplitude": 3.0, "period": 1.0},
        ),
        (
            {"angle": np.linspace(-1.0, 1.0, 4), "velocity": np.linspace(-1.0, 1.0, 4)},
            {"amplitude": 2.0, "period": 1.0, "restitution": 0.9},
        ),
        (
            {"brace_angle": np.linspace(0.5, 2.0, 4), "brace_restitution": np.linspace(0.0, 1.0, 4)},
            {"amplitude": 3.0, "period": 1.5, "restitution": 0.9},
        ),
        (
            {"amplitude": np.linspace(1.0, 16.0, 4), "angle": np.linspace(-0.9, 0.9, 4)},
            {"frequency": 4.0, "restitution": 0.8, "brace_angle": 0.9, "phase": 1.0},
        ),
    ],
)
def test_any_two_quantities_are_axes(axes, fixed):
    found = rk.parametric_map(**surveyed(**axes, **fixed), max_cycles=100).dataset
    assert set(found.kind.dims) == set(axes)
    check_against_classify(found, axes, fixed, max_cycles=100)


def test_block_that_never_moves_has_no_transient():
    """A block at rest, one in contact with a brace, and one that comes to rest."""
    where = {"angle": [0.0, 1.2, 1.5], "velocity": [0.0, 0.5]}
    system = system_with(amplitude=0.2, period=2.0, restitution=0.9, brace_angle=1.5, brace_restitution=0.5)
    found = rk.parametric_map(system, **where).dataset
    assert (found.kind == list(KINDS.values()).index("rest")).all()
    assert found.transient.sel(velocity=0.0, angle=[0.0, 1.5]).values.tolist() == [0, 0]
    assert found.transient.sel(angle=1.2, velocity=0.0) > 0


def test_dataset_names_its_axes_flags_parameters_and_maker():
    found = rk.parametric_map(
        system_with(restitution=0.9, phase=0.5), **WHERE, max_cycles=50, max_period=8
    ).dataset
    assert found.kind.dims == ("amplitude", "period")
    assert all(np.array_equal(found[name], values) for name, values in WHERE.items())
    assert found.kind.dtype == np.uint8
    assert found.kind.attrs["flag_meanings"].split() == [str(kind) for kind in rk.Kind]
    assert list(found.kind.attrs["flag_values"]) == list(range(6))
    assert found.attrs["source"] == f"rocking {rk.__version__}"
    named = {"restitution": 0.9, "phase": 0.5, "max_cycles": 50, "max_period": 8, "method": batch.METHOD}
    assert named.items() <= found.attrs.items()


BASE = {"system": system_with(restitution=0.9), "amplitude": [1.0, 2.0], "period": [1.0, 2.0]}
REFUSED = {
    "empty axis": (
        {"amplitude": []},
        "amplitude must hold two numbers or more in [0, 1000], ascending; got an empty array",
    ),
    "one point": (
        {"amplitude": [1.0]},
        (
            "amplitude must hold two numbers or more in [0, 1000], ascending; got an array of shape (1,) "
            "(a quantity that does not vary is no axis)"
        ),
    ),
    "descending": (
        {"period": [2.0, 1.0]},
        "period must hold two numbers or more in [0.00628319, 6283.19], ascending; got 2.0 before 1.0 at index 1",
    ),
    "twice the same": (
        {"period": [1.0, 2.0, 2.0]},
        "period must hold two numbers or more in [0.00628319, 6283.19], ascending; got 2.0 before 2.0 at index 2",
    ),
    "not a number": (
        {"amplitude": [1.0, math.nan]},
        "amplitude must hold two numbers or more in [0, 1000], ascending; got nan at index 1",
    ),
    "out of range": (
        {"amplitude": [-1.0, 2.0]},
        "amplitude must hold two numbers or more in [0, 1000], ascending; got -1.0 at index 0",
    ),
    "a table": (
        {"amplitude": [[1.0, 2.0]]},
        "amplitude must hold two numbers or more in [0, 1000], ascending; got an array of shape (1, 2)",
    ),
    "a ragged table": (
        {"amplitude": [1.0, [2.0, 3.0]]},
        "amplitude must hold two numbers or more in [0, 1000], ascending; got [1.0, [2.0, 3.0]]",
    ),
    "words": (
        {"amplitude": ["a", "b"]},
        "amplitude must hold two numbers or more in [0, 1000], ascending; got ['a', 'b']",
    ),
    "a text": (
        {"amplitude": "1:2"},
        (
            "amplitude must be an axis, an ascending array in [0, 1000]; got '1:2' "
            "(such as np.linspace(start, stop, count))"
        ),
    ),
    "nothing to write to": ({"store": ""}, "store must be the path of a folder; got ''"),
    "a number": (
        {"restitution": 0.5},
        "restitution must be an axis, an ascending array in [0, 1]; got 0.5 (a number is that of the system)",
    ),
    "a number of the start": (
        {"angle": 0.5},
        "angle must be an axis, an ascending array in [-1000, 1000]; got 0.5 (a number is that of the initial state)",
    ),
    "a set": (
        {"restitution": {0.5, 0.9}},
        "restitution must be an axis, an ascending array in [0, 1]; got {0.5, 0.9} (such as np.linspace(start, stop, count))",
    ),
    "three axes": (
        {"restitution": [0.8, 0.9]},
        (
            "a parametric map needs two quantities as arrays; got amplitude and restitution and period "
            "(the others are those of the system)"
        ),
    ),
    "one axis": (
        {"amplitude": None},
        "a parametric map needs two quantities as arrays; got period",
    ),
    "no axis": (
        {"amplitude": None, "period": None},
        "a parametric map needs two quantities as arrays; got none",
    ),
    "start out of range": (
        {"start": rk.State(velocity=2e3)},
        "velocity must lie in [-1000, 1000]; got 2000.0",
    ),
    "no system": ({"system": 3}, "system must be a System; got 3 ("),
    "no start": ({"start": 0.1}, "start must be a State; got 0.1 ("),
    "period and frequency": (
        {"amplitude": None, "frequency": [1.0, 2.0]},
        "give exactly one of period, frequency; got period=[1.0, 2.0] and frequency=[1.0, 2.0]",
    ),
    "no brace to vary": (
        {"amplitude": None, "brace_restitution": [0.5, 1.0]},
        "brace_restitution must be used with brace_angle or a braced system; got [0.5, 1.0]",
    ),
    "start beyond a brace": (
        {"system": system_with(brace_angle=0.6), "start": rk.State(-0.7)},
        "angle must lie between the braces, in [-0.6, 0.6]; got -0.7",
    ),
    "cycles": ({"max_cycles": 0}, "max_cycles must be a whole number in [1, 100000000]; got 0"),
    "store": ({"store": 5}, "store must be the path of a folder; got 5"),
    "executor": ({"executor": 2}, "executor must be an Executor; got 2"),
    "periods": ({"max_period": 2.5}, "max_period must be a whole number in [1, 10000]; got 2.5"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_mapped_is_refused_in_one_line(what):
    changed, message = REFUSED[what]
    with pytest.raises(
        (TypeError, ValueError), match=f"^{re.escape(message)}{'' if message.endswith('(') else '$'}"
    ):
        rk.parametric_map(**(BASE | changed))
