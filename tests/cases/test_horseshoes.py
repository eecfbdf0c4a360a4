"""Proofs of horseshoes by the crossing of the saddles' manifolds."""

import math

import pytest

import rocking as rk


def system_of(amplitude, period, restitution):
    return rk.System(rk.Harmonic(amplitude=amplitude, period=period), restitution)


@pytest.mark.parametrize(
    "case", [(3.7, 1.0, 0.8), (3.6878131, 1.0, 0.8), (0.43, 2.0, 0.925), (2.0, 1.0, 0.925), (6.2, 1.0, 0.925)]
)
def test_horseshoe_above_the_tangency(case):
    found = rk.horseshoe(system_of(*case))
    assert found.proved
    assert "cross transversally" in found.claim
    # The crossing satisfies e V_u = V_s at Θ = 0.
    amplitude, period, restitution = case
    frequency = math.tau / period
    beta = amplitude / (1 + frequency**2)
    arrives = 1 - beta * (math.cos(found.phase) + frequency * math.sin(found.phase))
    leaves = 1 + beta * (math.cos(found.phase) - frequency * math.sin(found.phase))
    assert restitution * arrives == pytest.approx(leaves, abs=1e-13)
    assert arrives > 0
    assert leaves > 0


@pytest.mark.parametrize(
    "case",
    [
        (3.687813, 1.0, 0.8),
        (1.0, 1.0, 0.8),
        (10.103037, 1.721328, 0.8),
        (13.556042, 1.531471, 0.8),
        (50.0, 1.0, 0.8),
    ],
)
def test_no_horseshoe_below_the_tangency_nor_where_an_arc_reaches_the_base(case):
    found = rk.horseshoe(system_of(*case))
    assert not found.proved
    assert math.isnan(found.phase)
    assert str(found).startswith("not proved: ")


@pytest.mark.parametrize(("period", "restitution"), [(1.0, 0.8), (2.0, 0.925), (0.4, 0.5), (3.0, 0.99)])
def test_every_amplitude_between_the_tangency_and_the_root_of_1_and_the_frequency_squared(
    period, restitution
):
    least = rk.tangency_amplitude(system_of(1.0, period, restitution))
    most = math.hypot(1.0, math.tau / period)
    assert least < most
    for part in (1e-9, 0.01, 0.3, 0.7, 0.99):
        assert rk.horseshoe(system_of(least + part * (most - least), period, restitution)).proved
    assert not rk.horseshoe(system_of(least * (1.0 - 1e-9), period, restitution)).proved


def test_wrong_systems_are_refused():
    forcing = rk.Harmonic(2.0, period=1.0)
    with pytest.raises(ValueError, match="system must have no braces"):
        rk.horseshoe(rk.System(forcing, 0.9, rk.Braces(1.0)))
    with pytest.raises(TypeError, match="periodic"):
        rk.horseshoe(rk.System(rk.Pulse("one-sine", amplitude=2.0, duration=1.0), 0.9))
    assert not rk.horseshoe(rk.System(forcing, 0.0)).proved
