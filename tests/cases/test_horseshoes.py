"""Proofs of horseshoes by the crossing of the saddles' manifolds."""

import math

import pytest
from flint import arb, ctx

import rocking as rk
from rocking.proof import horseshoe
from rocking.proof.arc import Refused, balls_of


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


@pytest.mark.parametrize("amplitude", [0.5, 1.0, 3.687813])
def test_below_the_tangency_the_manifolds_do_not_cross(amplitude):
    found = rk.horseshoe(system_of(amplitude, 1.0, 0.8))
    assert not found.proved
    assert found.claim.startswith("the manifolds do not cross")


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
    with pytest.raises(ValueError, match="system must have no braces without search=True"):
        rk.horseshoe(rk.System(forcing, 0.9, rk.Braces(1.0)))
    with pytest.raises(TypeError, match="periodic"):
        rk.horseshoe(rk.System(rk.Pulse("one-sine", amplitude=2.0, duration=1.0), 0.9))
    assert not rk.horseshoe(rk.System(forcing, 0.0)).proved


BRACED = rk.System(rk.Harmonic(15.0, period=2.0), 0.925, rk.Braces(1.0))


def test_two_words_between_braces_and_their_entropy():
    found = rk.horseshoe(BRACED, search=True, max_period=2)
    assert found.proved
    assert found.cycles == (2, 6)
    assert found.entropy >= 0.1911
    first, second = (math.exp(-found.entropy * n) for n in found.cycles)
    assert first + second == pytest.approx(1.0, abs=1e-11)
    assert first + second >= 1.0


@pytest.mark.long
def test_two_words_of_a_chaotic_attractor_whose_manifolds_prove_nothing():
    system = system_of(10.103037, 1.721328, 0.8)
    assert not rk.horseshoe(system).proved
    found = rk.horseshoe(system, search=True)
    assert found.proved
    assert found.entropy >= 0.08


def test_no_two_words_where_all_orbits_are_simple():
    found = rk.horseshoe(system_of(0.3, 2.0, 0.925), search=True, max_period=2)
    assert not found.proved
    assert found.cycles == ()
    assert math.isnan(found.entropy)


def chains_and_parameters():
    p = balls_of(BRACED, {})
    orbits = [orbit for orbit in rk.find_orbits(BRACED, 1) if orbit.impacts]
    return list(horseshoe.whole_chains(p, orbits)), p


def test_an_orbit_twice_is_not_a_second_word():
    with ctx.workprec(128):
        chains, p = chains_and_parameters()
        for chain in chains:
            a, twice = horseshoe.word_of(p, chain), horseshoe.joined(chain, chain)
            b = horseshoe.Word(twice, a.phases + [psi + 2 * a.cycles * arb.pi() for psi in a.phases])
            b = b._replace(phases=[psi.mid() for psi in b.phases])
            assert not horseshoe.are_distinct(a, b, 1e-6)
            with pytest.raises(Refused, match="not distinct"):
                horseshoe.check_shift(p, a, b, 1e-6)


def mirror_images(chain):
    """Yield the mirror image of a chain, from each of its events on."""
    mirrored = chain._replace(side=-chain.side, phases=tuple(psi + math.pi for psi in chain.phases))
    for first in range(len(chain.phases)):
        yield horseshoe.rotated(mirrored, first)


def test_a_mirror_image_is_not_a_second_word():
    with ctx.workprec(128):
        chains, p = chains_and_parameters()
        for chain in chains:
            a = horseshoe.word_of(p, chain)
            for image in mirror_images(chain):
                with pytest.raises(Refused, match="not distinct"):
                    horseshoe.check_shift(p, a, horseshoe.word_of(p, image), 1e-6)


def test_a_mirror_image_does_not_continue_an_orbit():
    """Krawczyk's operator refuses the events of an orbit between those of its mirror image."""
    with ctx.workprec(128):
        chains, p = chains_and_parameters()
        refused = 0
        for chain in chains:
            a = horseshoe.word_of(p, chain)
            for image in mirror_images(chain):
                b = horseshoe.word_of(p, image)
                before, after = (one + arb(0, 1e-6) for one in (b.phases[-1], b.phases[0]))
                before -= 2 * a.cycles * arb.pi()
                after += 2 * a.cycles * arb.pi()
                if before < a.phases[0] and a.phases[-1] < after and not b.phases[0].overlaps(a.phases[0]):
                    refused += 1
                    with pytest.raises(Refused, match="not taken into itself"):
                        horseshoe.check_block(p, a, 1e-6, before, after)
        assert refused > 0
