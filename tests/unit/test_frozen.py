"""Results are frozen: they are hashable, and their arrays are read-only, also in a copy or from another process."""

import copy
import pickle

import attrs
import numpy as np
import pytest

import rocking as rk

PERIODIC = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
CHAOTIC = rk.System(rk.Harmonic(amplitude=15.0, period=2.0), 0.925, rk.Braces(1.0))


def branch():
    return rk.continue_orbit(rk.classify(PERIODIC).orbit, "amplitude", (10, 30))


MADE = {
    "GroundMotion": lambda: rk.GroundMotion([0.0, 1.0, 0.5], step=0.1, baseline="mean").scaled(2.0),
    "Motion": lambda: rk.simulate(PERIODIC, cycles=20),
    "section": lambda: rk.simulate(PERIODIC, cycles=20, record="section"),
    "LyapunovSpectrum": lambda: rk.lyapunov(CHAOTIC, cycles=2_000),
    "SpectralDensity": lambda: rk.spectral_density(rk.simulate(PERIODIC, cycles=200)),
    "CorrelationDimension": lambda: rk.correlation_dimension(np.random.default_rng(1).uniform(size=(20_000, 2))),
    "Branch": branch,
    "BifurcationCurve": lambda: rk.bifurcation_curve(branch().special[0], "period", "amplitude", ((1, 1.2), (1, 30))),
    "OrbitDiagram": lambda: rk.orbit_diagram(PERIODIC, amplitude=[14.0, 15.0], cycles=5, transient=5),
    "ResponseDiagram": lambda: rk.response_diagram(PERIODIC, amplitude=[0.5, 14.0, 15.0]),
    "SaddleManifolds": lambda: rk.saddle_manifolds(rk.System(rk.Harmonic(amplitude=4.0, period=1.0), restitution=0.8)),
    "FrequencyResponse": lambda: rk.frequency_response(PERIODIC, period=[0.9, 1.0, 1.1], modes=(1,)),
}  # fmt: skip
AGAIN = {
    "itself": lambda value: value,
    "copied": copy.copy,
    "copied deeply": copy.deepcopy,
    "sent": lambda value: pickle.loads(pickle.dumps(value)),
}


@pytest.fixture(scope="module", params=MADE)
def value(request):
    return MADE[request.param]()


PROPERTIES = ("events", "peaks", "history")
INNER = ("_rows",)
"""Private arrays that compiled code reads."""


def arrays(value):
    """All arrays of a value by name, those of the manifolds in it too, and those that its properties give."""
    names = [each.name for each in attrs.fields(type(value)) if each.name not in INNER]
    if getattr(value, "record", "all") == "all":
        names += [name for name in PROPERTIES if hasattr(type(value), name)]
    found = {}
    for name in names:
        part = getattr(value, name)
        for number, each in enumerate(part if isinstance(part, tuple) else [part]):
            if isinstance(each, np.ndarray):
                found[f"{name} {number}"] = each
            elif type(each).__name__ == "Manifold":
                found |= {f"{name} {number} {key}": array for key, array in arrays(each).items()}
    return found


@pytest.mark.parametrize("how", AGAIN)
def test_arrays_refuse_to_be_written_to_in_copies_too(value, how):
    again = AGAIN[how](value)
    before, after = arrays(value), arrays(again)
    assert before
    assert before.keys() == after.keys()
    for name, array in before.items():
        assert not after[name].flags.writeable, name
        assert array.tobytes() == after[name].tobytes(), name
    assert str(again) == str(value)


@pytest.mark.parametrize(
    "make",
    [
        lambda: rk.classify(PERIODIC),
        lambda: rk.classify(PERIODIC).evidence,
        lambda: rk.repeatability(PERIODIC, samples=20),
        lambda: rk.classify(PERIODIC).orbit,
        lambda: PERIODIC,
        rk.example_ground_motion,
    ],
)
def test_frozen_values_have_a_hash_that_equal_ones_share(make):
    one, other = make(), make()
    assert one is other or one == other
    assert hash(one) == hash(other)
    assert {one: "found"}[other] == "found"
