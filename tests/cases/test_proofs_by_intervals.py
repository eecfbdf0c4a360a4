"""Ten proofs checked again by interval arithmetic in mpmath, with other formulas."""

import pytest
from mpmath import mp

import rocking as rk
from oracles import interval_orbits

CHAOS = rk.System(rk.Harmonic(amplitude=10.103037, period=1.721328), restitution=0.8)
BRACED = rk.System(rk.Harmonic(amplitude=15.0, period=2.0), 0.925, rk.Braces(1.0, restitution=0.9))
BY_FREQUENCY = rk.System(rk.Harmonic(amplitude=2.0, frequency=6.25), restitution=0.925)


def figure_2():
    """Return the three orbits of figure 2."""
    cases = [(2.0, 1.0, 0.0, 0.0), (6.5, 0.4, 0.0, 0.0), (5.5, 0.5, 1.8, 0.15)]
    for amplitude, period, phase, velocity in cases:
        system = rk.System(rk.Harmonic(amplitude, period=period, phase=phase), 0.925)
        yield rk.classify(system, rk.State(velocity=velocity)).orbit


def ten():
    """Return ten orbits: stable, unstable, between braces, and one of a system that is given by its frequency."""
    with_events = [orbit for orbit in rk.find_orbits(CHAOS, 3) if orbit.impacts]
    braced = [orbit for orbit in rk.find_orbits(BRACED, 1) if orbit.impacts and orbit.brace_hits]
    return [*figure_2(), rk.classify(BY_FREQUENCY).orbit, *with_events[:4], *braced[:2]]


def as_intervals(orbit, proof):
    """Return an orbit for the other arithmetic: its events by a simulation, its phases by the proof."""
    forcing, braces = orbit.system.periodic, orbit.system.braces
    events = rk.simulate(
        rk.System(
            rk.Harmonic(forcing.amplitude, phase=orbit.phase, **dict([forcing.given])),
            orbit.system.restitution,
            braces,
        ),
        orbit.state,
        cycles=orbit.period,
    ).events[: len(proof.phases)]
    name, value = forcing.given
    return interval_orbits.Orbit(
        amplitude=forcing.amplitude,
        restitution=orbit.system.restitution,
        period=value if name == "period" else None,
        frequency=value if name == "frequency" else None,
        brace=None if braces is None else (braces.angle, braces.restitution),
        kinds=tuple(str(kind) for kind in events["kind"]),
        side=1 if events["after"][0] * (1 if events["kind"][0] == "impact" else -1) > 0 else -1,
        half_turns=orbit.period if orbit.symmetric else 2 * orbit.period,
        mirrored=orbit.symmetric,
        phases=proof.phases,
    )


def test_ten_proofs_hold_in_interval_arithmetic():
    orbits = ten()
    assert len(orbits) == 10
    for orbit in orbits:
        proof = rk.prove(orbit)
        assert proof.proved
        other = as_intervals(orbit, proof)
        assert interval_orbits.verified(other)
        assert interval_orbits.contains_solution(other)
        assert interval_orbits.stays_clear(other)
        trace, determinant = (
            mp.mpf(low + high) / 2 for low, high in interval_orbits.trace_and_determinant(other)
        )
        if orbit.symmetric:  # from half a period to the whole
            trace, determinant = trace**2 - 2 * determinant, determinant**2
        (first, one), (second, two) = proof.multipliers
        size = abs(first) + abs(second)
        assert abs(first + second - complex(trace)) <= one + two + 1e-15 * size
        assert abs(first * second - complex(determinant)) <= (one + two) * size + 1e-15 * size**2
        assert proof.stable is (abs(trace) < 1 + determinant)


@pytest.mark.parametrize("wrong", ["side", "phase"])
def test_wrong_orbit_fails_in_interval_arithmetic(wrong):
    orbit = next(figure_2())
    other = as_intervals(orbit, rk.prove(orbit))
    (middle, radius), *rest = other.phases
    changed = (
        other._replace(side=-other.side)
        if wrong == "side"
        else other._replace(phases=((middle + 1e-9, radius), *rest))
    )
    assert not (interval_orbits.verified(changed) and interval_orbits.stays_clear(changed))
