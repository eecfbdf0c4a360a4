"""Parametric maps: each point has the result of `classify`."""

import math

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
