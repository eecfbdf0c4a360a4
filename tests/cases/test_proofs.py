"""Proofs of periodic orbits: known cases, random responses, and everything that must never be proved."""

import math
from itertools import islice, product

import numpy as np
import pytest
from attrs import evolve
from flint import arb, arb_mat, ctx

import rocking as rk
from rocking.kernels.event_kinds import BRACE, IMPACT
from rocking.proof import cases, krawczyk, periodic, trajectory
from rocking.proof.arc import Refused, Search, arc_from, balls_of
from rocking.proof.chain import Chain
from rocking.proof.periodic import chain_of
from rocking.proof.sets import States, renewed, sets_on_sections, states_on_sections

FEW, MANY = 40, 300
STARTS, MANY_STARTS = 15, 150
RESETS, MANY_RESETS = 15, 100
BITS = 128


def system_of(amplitude, period, restitution, **more):
    braces = more.pop("braces", None)
    return rk.System(rk.Harmonic(amplitude=amplitude, period=period, **more), restitution, braces)


def orbit_of(amplitude, period, restitution, start=None, **more):
    return rk.classify(system_of(amplitude, period, restitution, **more), start).orbit


ONE = (2.0, 1.0, 0.925)
THREE = (6.5, 0.4, 0.925)
CHAOS = (10.103037, 1.721328, 0.8)


@pytest.mark.parametrize(
    ("case", "more", "start", "size", "unique"),
    [
        (ONE, {}, None, 0.925**2, 0.1),
        (THREE, {}, None, 0.925**2, 0.1),
        ((5.5, 0.5, 0.925), {"phase": 1.8}, rk.State(0.0, 0.15), 0.925**4, 4e-3),
    ],
)
def test_orbits_of_figure_2_are_proved_with_the_size_of_their_multipliers(case, more, start, size, unique):
    orbit = orbit_of(*case, start, **more)
    proof = rk.prove(orbit)
    assert proof.proved
    assert proof.stable is True
    assert (proof.period, proof.symmetric, proof.impacts) == (orbit.period, orbit.symmetric, orbit.impacts)
    assert proof.bits == BITS
    assert proof.existence < 1e-14
    assert proof.uniqueness > unique
    for (middle, radius), known in zip(proof.multipliers, orbit.multipliers, strict=True):
        assert abs(abs(middle) - size) <= radius + 1e-15
        assert abs(middle - known) < 1e-11


def random_verdicts(seed, count, amplitude=lambda rng: rng.uniform(0, 16), superstable=None):
    """Yield periodic verdicts from rest of random systems."""
    rng = np.random.default_rng(seed)
    while count:
        system = system_of(
            float(amplitude(rng)), float(rng.uniform(0.2, 3)), float(rng.choice([0.5, 0.8, 0.925]))
        )
        verdict = rk.classify(system)
        if verdict.kind is rk.Kind.PERIODIC and superstable in (None, verdict.superstable):
            count -= 1
            yield verdict


def check_orbits(verdicts):
    for verdict in verdicts:
        proof = rk.prove(verdict.orbit)
        assert proof.proved, (verdict.system, proof.claim)
        assert (proof.stable, proof.period, proof.symmetric) == (True, verdict.period, verdict.symmetric)


def check_starts(verdicts):
    """Return the number of starts that are not proved to reach their orbit."""
    missed = 0
    for verdict in verdicts:
        proof = rk.prove(verdict)
        assert proof.proved
        missed += not proof.starts
    return missed


def weak(rng):
    """An amplitude little above that of lift-off."""
    return 1.0 + rng.exponential(0.3)


def test_random_orbits_are_proved():
    check_orbits(random_verdicts(0, FEW))


def test_random_starts_are_proved_to_reach_their_orbits():
    assert check_starts(random_verdicts(1, STARTS)) == 0


def test_random_orbits_that_rest_are_proved():
    check_orbits(random_verdicts(2, RESETS, weak, superstable=True))


@pytest.mark.long
def test_300_random_orbits_are_proved():
    check_orbits(random_verdicts(10, MANY))


@pytest.mark.long
def test_148_of_150_random_starts_are_proved_to_reach_their_orbits():
    assert check_starts(random_verdicts(11, MANY_STARTS)) <= 2


@pytest.mark.long
def test_100_random_orbits_that_rest_are_proved():
    check_orbits(random_verdicts(12, MANY_RESETS, weak, superstable=True))


def test_every_orbit_found_at_a_chaotic_system_is_proved():
    found = rk.find_orbits(system_of(*CHAOS), 3, prove=True)
    assert len(found) >= 8
    for orbit in found:
        assert orbit.proof.proved, orbit.proof.claim
        assert orbit.proof.stable is orbit.stable
    assert f"{len(found)} of them proved" in str(found)


@pytest.mark.long
def test_every_orbit_found_between_braces_is_proved():
    system = system_of(15.0, 2.0, 0.925, braces=rk.Braces(1.0))
    found = rk.find_orbits(system, 3, prove=True)
    with_events = [orbit for orbit in found if orbit.impacts or orbit.brace_hits]
    assert len(with_events) >= 60
    assert all(orbit.proof.proved and orbit.proof.stable is False for orbit in with_events)


def test_motion_without_events_is_proved_unstable():
    found = [orbit for orbit in rk.find_orbits(system_of(*ONE), 1) if not orbit.impacts]
    assert len(found) == 2
    for orbit in found:
        proof = rk.prove(orbit)
        beta = 2.0 / (1.0 + (2.0 * math.pi) ** 2)
        assert "Θ = ±1 + β cos ψ" in proof.claim
        assert orbit.at(0.0).angle == pytest.approx(math.copysign(1.0, orbit.at(0.0).angle) + beta, abs=1e-9)
        assert proof.proved
        assert proof.stable is False
        assert abs(proof.multipliers[0][0] - math.e) < 1e-15


def test_without_losses_the_orbit_is_proved_and_its_stability_is_not():
    proof = rk.prove(rk.find_orbits(system_of(4.0, 0.4, 1.0), 3)[0])
    assert proof.proved
    assert proof.stable is not True


# Never proved


def enclosed(chain, system):
    with ctx.workprec(BITS):
        return periodic.enclosed(balls_of(system, {}), chain)


def test_box_without_the_orbit_is_never_proved():
    """Krawczyk's image of a box around a perturbed orbit that does not contain the orbit never lies inside the box."""
    rng, chain = np.random.default_rng(3), chain_of(orbit_of(5.5, 0.5, 0.925, rk.State(0.0, 0.15), phase=1.8))
    system = system_of(5.5, 0.5, 0.925, phase=1.8)
    exact = [float(psi.mid()) for psi in enclosed(chain, system).found.box]
    with ctx.workprec(BITS):
        equations = periodic.equations(balls_of(system, {}), chain)
        for _ in range(1000):
            size = 10.0 ** rng.uniform(-9, -2)
            moved = [
                psi + size * x for psi, x in zip(exact, rng.choice([-1.0, 1.0], len(exact)), strict=True)
            ]
            box = krawczyk.operator(equations, [arb(psi) for psi in moved])
            assert box.image(0.9 * size) is None


@pytest.mark.parametrize("change", ["side", "kinds", "order", "missing", "mirrored"])
def test_wrong_order_of_events_is_never_proved(change):
    system = system_of(15.0, 2.0, 0.925, braces=rk.Braces(1.0))
    proved = 0
    for orbit in rk.find_orbits(system, 1):
        if not (orbit.impacts and orbit.brace_hits):
            continue
        chain = chain_of(orbit)
        enclosed(chain, system)
        kinds, phases = chain.kinds, chain.phases
        wrong = {
            "side": chain._replace(side=-chain.side),
            "kinds": chain._replace(kinds=tuple(BRACE if kind == IMPACT else IMPACT for kind in kinds)),
            "order": chain._replace(kinds=kinds[1:] + kinds[:1]),
            "missing": chain._replace(kinds=kinds[:-1], phases=phases[:-1]),
            "mirrored": chain._replace(mirrored=not chain.mirrored),
        }[change]
        if change == "order" and wrong.kinds == kinds:
            continue
        proved += 1
        with pytest.raises(Refused):
            enclosed(wrong, system)
    assert proved > 0


def test_solution_with_a_negative_speed_after_the_impact_is_never_proved():
    """The second root of the (1, 1) mode at A = 2, T = 1 leaves the base with V = -0.063: no block does."""
    amplitude, period, e = ONE
    frequency, half = math.tau / period, 0.5 * period
    t, beta = math.tanh(0.5 * half), amplitude / (1.0 + frequency**2)
    less, more = (1.0 - e) / (2.0 * e), (1.0 + e) / (2.0 * e)
    square = (frequency * t * less) ** 2 + more**2
    speeds = np.roots([square, -2.0 * t * more, t * t - (frequency * beta) ** 2])
    for speed in speeds:
        phase = math.atan2((t - speed * more) / (beta * frequency), -t * speed * less / beta)
        chain = Chain((IMPACT,), 1, 1, True, (phase,))
        if speed > 0:
            enclosed(chain, system_of(*ONE))
        else:
            with pytest.raises(Refused, match="wrong sign"):
                enclosed(chain, system_of(*ONE))
    assert speeds.min() < 0 < speeds.max()


def test_orbit_is_proved_up_to_its_grazing_and_not_beyond():
    """Another event comes from the next double on: (1, 3) mode, T = .4, e = .925."""
    last = 10.541711176647445

    def mode(amplitude):
        fastest = max(rk.theory.symmetric_modes(amplitude, 0.4, 0.925, 3), key=lambda one: one.velocity)
        return Chain((IMPACT,), 1, 3, True, (fastest.phase,)), system_of(amplitude, 0.4, 0.925)

    enclosed(*mode(last))
    for amplitude in (math.nextafter(last, 11.0), 11.0, 12.0, 14.0):
        with pytest.raises(Refused, match="another event"):
            enclosed(*mode(amplitude))


def test_nothing_is_proved_below_a_fold():
    """Both modes of the (1, 1) fold at T = 2, e = .925 are proved just above A_E, and none below."""
    threshold = rk.theory.existence_amplitude(2.0, 0.925, 1)
    for above in (1e-2, 1e-6, 1e-10):
        modes = rk.theory.symmetric_modes(threshold * (1.0 + above), 2.0, 0.925, 1)
        assert len(modes) == 2
        for mode in modes:
            chain = Chain((IMPACT,), 1, 1, True, (mode.phase,))
            enclosed(chain, system_of(threshold * (1.0 + above), 2.0, 0.925))
            with pytest.raises(Refused):
                enclosed(chain, system_of(threshold * (1.0 - above), 2.0, 0.925))


def test_symmetry_breaking_is_not_decided_over_a_range_of_amplitudes():
    amplitude, period, restitution = 7.333153027271592, 1.721328, 0.8
    symmetric = evolve(orbit_of(7.333, period, restitution), system=system_of(amplitude, period, restitution))
    assert symmetric.symmetric
    assert rk.prove(symmetric).stable is not None
    for width in (1e-15, 1e-9, 1e-6):
        proof = rk.prove(symmetric, uncertain={"amplitude": width})
        assert proof.proved
        assert proof.stable is None


def test_proof_for_a_range_of_parameters():
    orbit = orbit_of(*ONE)
    wide = rk.prove(orbit, uncertain={"amplitude": 0.01})
    assert wide.proved
    assert wide.stable
    assert wide.existence > 1e-3
    assert not rk.prove(orbit, uncertain={"amplitude": 0.9}).proved
    for amplitude in (1.99, 2.01):
        assert (
            abs(rk.prove(orbit_of(amplitude, 1.0, 0.925)).phases[0][0] - wide.phases[0][0]) <= wide.existence
        )


def test_twice_the_period_is_not_proved_as_least():
    chain, system = chain_of(orbit_of(*ONE)), system_of(*ONE)
    k, turn = len(chain.phases), math.pi * chain.half_turns
    twice = chain._replace(
        kinds=chain.kinds * 3,
        phases=tuple(psi + turn * n for n in range(3) for psi in chain.phases),
        half_turns=3 * chain.half_turns,
    )
    assert len(twice.phases) == 3 * k
    with pytest.raises(Refused, match="shorter period"):
        enclosed(twice, system)


def test_symmetric_orbit_is_not_proved_as_an_unsymmetric_one():
    chain, system = chain_of(orbit_of(*ONE)), system_of(*ONE)
    whole = chain._replace(
        kinds=chain.kinds * 2,
        phases=chain.phases + tuple(psi + math.pi * chain.half_turns for psi in chain.phases),
        half_turns=2 * chain.half_turns,
        mirrored=False,
    )
    with pytest.raises(Refused, match="symmetry"):
        enclosed(whole, system)


def test_mirror_image_after_whole_cycles_is_never_a_symmetry():
    """The chain of A = 1.68584537, T = 2.03158606, e = .8 closes after two cycles, mirrored, which no motion does."""
    chain = Chain((IMPACT,), 1, 2, True, (0.2,))
    assert not chain.closes
    orbit = orbit_of(*ONE)
    assert not rk.prove(evolve(orbit, period=2)).proved


def test_orbit_with_other_counts_of_events_is_not_proved():
    orbit = orbit_of(*ONE)
    for wrong in ({"impacts": 1, "brace_hits": 1}, {"impacts": 4}, {"impacts": 2, "brace_hits": 2}):
        assert not rk.prove(evolve(orbit, **wrong)).proved


ONE_SIDED = (
    (6.785214554128202, 1.7354045891899763, 0.925, 0.4636711490294164),
    (7.960670207456471, 2.1098980613433693, 0.925, 0.8186166898050804),
    (4.863431097694022, 1.9888554000361183, 0.8, 0.41095380649030444),
    (3.944541376602235, 2.2005194166073063, 0.925, 0.43628825026568696),
    (4.016673691509082, 2.4207453348732524, 0.925, 0.552813908585378),
    (5.4921360826026095, 2.272763700032252, 0.925, 0.6556131741242407),
    (11.63949096488361, 1.1247740792252245, 0.925, 0.33859743914999607),
)
"""A, T, e and brace angle of responses with one brace impact on one side and two on the other. A symmetric orbit is near."""


@pytest.mark.parametrize("case", ONE_SIDED)
def test_asymmetric_orbit_given_as_a_symmetric_one_is_not_proved(case):
    *harmonic, angle = case
    orbit = orbit_of(*harmonic, braces=rk.Braces(angle, 0.5))
    proof = rk.prove(orbit)
    assert (proof.impacts, proof.brace_hits) == (orbit.impacts, orbit.brace_hits) == (2, 3)
    assert "asymmetric orbit of period 1 with 2 impacts and 3 brace impacts" in proof.claim
    wrong = rk.prove(evolve(orbit, symmetric=True))
    assert not wrong.proved
    assert "not symmetric" in wrong.claim


def test_verdict_with_the_orbit_of_another_system_is_refused():
    verdict = rk.classify(system_of(*ONE))
    with pytest.raises(ValueError, match="subject must have the system of its orbit"):
        rk.prove(evolve(verdict, system=system_of(2.5, 1.0, 0.925)))


def test_start_whose_rest_leads_to_the_mirror_image_is_not_proved_to_reach_the_orbit():
    system = system_of(1.0869527, 1.3382289, 0.8)
    verdict = rk.classify(system)
    assert verdict.superstable
    assert not verdict.symmetric
    assert rk.prove(verdict).starts
    forcing = evolve(system.forcing, phase=math.pi)
    for named in (False, True):  # the symmetry is that of the proved orbit, whatever the verdict says
        proof = rk.prove(evolve(verdict, system=evolve(system, forcing=forcing), symmetric=named))
        assert proof.proved
        assert proof.starts is False
        assert "mirror image" in proof.claim


def test_start_that_overturns_is_not_proved_to_reach_the_orbit():
    verdict = rk.classify(system_of(*ONE))
    other = evolve(verdict, start=rk.State(0.9, 0.9))
    assert rk.classify(other.system, other.start).kind is rk.Kind.OVERTURNED
    proof = rk.prove(other)
    assert proof.proved
    assert proof.starts is False
    assert "is not proved" in proof.claim


def test_orbit_with_contact_at_a_brace_is_not_proved():
    verdict = rk.classify(
        system_of(2.555908015993062, 2.9903134527330972, 0.1, braces=rk.Braces(0.0466, restitution=0.3))
    )
    assert verdict.superstable
    assert verdict.brace_hits_per_period is None
    proof = rk.prove(verdict)
    assert not proof.proved
    assert "contact with a brace" in proof.claim


@pytest.mark.parametrize(("middle", "brace"), [(1e-3, None), (0.999, rk.Braces(1.0))])
def test_flight_of_states_that_may_lie_beyond_the_base_or_a_brace_is_refused(middle, brace):
    with ctx.workprec(BITS):
        p = balls_of(system_of(*ONE, braces=brace), {})
        state = trajectory.State(1, arb(0.3), arb(middle, 2e-3), arb(0.01), 0, False)
        with pytest.raises(Refused, match="may reach"):
            trajectory.flight(p, state)


def test_set_of_states_that_may_reach_the_base_is_refused():
    """On a section at an event of the orbit every neighbourhood contains states beyond the base."""
    verdict = rk.classify(system_of(*ONE))
    psi = rk.prove(verdict.orbit).phases[0][0]
    for shift in (0.0, 1e-13, -1e-13):
        moved = evolve(verdict, orbit=evolve(verdict.orbit, phase=(psi + shift) % math.tau))
        assert not rk.prove(moved).starts


@pytest.mark.parametrize("width", [0.01, 0.02, 0.03])
def test_one_orbit_lies_within_the_radius_of_uniqueness_for_a_range_of_amplitudes(width):
    """The phases of the whole range lie within this radius, as those of both ends do."""
    proof = rk.prove(orbit_of(*ONE), uncertain={"amplitude": width})
    assert proof.proved
    assert 0 < proof.existence <= proof.uniqueness
    for sign in (-1, 1):
        end = rk.prove(orbit_of(ONE[0] + sign * width, *ONE[1:]))
        away = [abs(a - b) for (a, _), (b, _) in zip(proof.phases, end.phases, strict=True)]
        assert max(away) <= proof.existence


def test_orbit_with_a_changed_field_does_not_prove_another_orbit():
    orbit = orbit_of(*ONE)
    assert not rk.prove(evolve(orbit, impacts=0)).proved
    resting = rk.classify(rk.System(rk.Harmonic(1.1, period=2.0), 0.5)).orbit
    assert resting.superstable
    assert rk.prove(resting).proved
    for change in ({"phase": resting.phase + 1.0}, {"state": rk.State(velocity=0.3)}):
        assert not rk.prove(evolve(resting, **change)).proved


def test_zero_outside_the_interval_of_an_event_is_refused():
    """A guess in double precision may be wrong: then the zero that Newton's method finds is not that of the event."""
    with ctx.workprec(BITS):
        arc = arc_from(balls_of(system_of(*ONE), {}), 1, arb(0.3), arb(0), arb(0.5))
        first = Search(arc, IMPACT).first(arb(0), arb(3), 1)
        assert arc.at(first).value.contains(0)
        with pytest.raises(Refused, match="not enclosed"):
            Search(arc, IMPACT).time(first.upper() + 0.1, first.upper() + 0.2)


@pytest.mark.parametrize("braces", [None, rk.Braces(0.7, 0.6)])
def test_sets_contain_the_motions_of_their_states(braces):
    """The corners of a set, followed one by one at a higher precision, lie in its images, cycle after cycle."""
    system, size = system_of(*ONE, braces=braces), 1e-5
    with ctx.workprec(BITS):
        p, phase, last = balls_of(system, {}), arb(0.4), arb(60)
        basis = arb_mat([[0.6, -0.3], [0.8, 0.5]])
        first = States(1, phase, arb_mat([[0.3], [0.2]]), basis, (arb(size), arb(0.5 * size)))
        images = [first, *islice(sets_on_sections(p, first, last), 4)]
        images += islice(sets_on_sections(p, renewed(images[-1]), last), 3)
    assert len(images) == 8
    with ctx.workprec(2 * BITS):
        for one, other in product((-size, size), (-0.5 * size, 0.5 * size)):
            r = arb_mat([[one], [other]])
            angle, velocity = (first.centre + basis * r).entries()
            state = trajectory.State(1, phase, angle, velocity, 0, False)
            motion = islice(states_on_sections(p, state, phase, last), 7)
            for now, there in zip(images[1:], motion, strict=True):
                box = now.box()
                assert now.side == there.side
                assert box.angle.contains(there.angle)
                assert box.velocity.contains(there.velocity)


def test_start_that_converges_to_another_orbit_is_not_proved_to_reach_this_one():
    system = system_of(10.0, 1.721328, 0.8)
    verdict = rk.classify(system)
    mirrored = rk.State(-verdict.orbit.state.angle, -verdict.orbit.state.velocity)
    if verdict.symmetric:
        pytest.fail("the test needs an orbit without symmetry")
    forcing = evolve(system.forcing, phase=(verdict.orbit.phase + math.pi) % math.tau)
    begun = evolve(system, forcing=forcing)
    proof = rk.prove(evolve(verdict, system=begun, start=mirrored, orbit=verdict.orbit))
    assert proof.starts is False


def test_period_of_a_given_frequency_is_that_of_the_double():
    by_period, by_frequency = (
        rk.System(rk.Harmonic(2.0, **given), 0.925) for given in ({"period": 1.0}, {"frequency": math.tau})
    )
    with ctx.workprec(BITS):
        first, second = (balls_of(system, {}).frequency for system in (by_period, by_frequency))
        assert not first.overlaps(second)
        assert first.overlaps(2 * arb.pi())
        assert second == arb(math.tau)


# Verdicts


def test_level_of_a_proved_start_is_proved_and_that_of_a_proved_orbit_is_not():
    system = system_of(*THREE)
    plain, orbit, whole = (rk.classify(system, prove=how) for how in (False, "orbit", True))
    assert [one.evidence.level for one in (plain, orbit, whole)] == ["verified", "verified", "proved"]
    assert plain.orbit.proof is None
    assert orbit.orbit.proof.proved
    assert orbit.orbit.proof.starts is None
    assert whole.orbit.proof.starts is True
    assert "Evidence: proved" in str(whole)
    assert whole.kind is plain.kind
    assert whole.orbit == plain.orbit


def test_other_verdicts_have_no_proof():
    verdict = rk.classify(system_of(1.75, 2.0, 0.95), prove=True)
    assert verdict.kind is rk.Kind.OVERTURNED
    assert verdict.evidence.level == "exact"


def test_wrong_arguments_are_refused():
    system = system_of(*ONE)
    orbit = rk.classify(system).orbit
    with pytest.raises(ValueError, match='prove must be False, True or "orbit"; got'):
        rk.classify(system, prove="yes")
    with pytest.raises(TypeError, match="subject must be"):
        rk.prove(system)
    with pytest.raises(
        ValueError, match="uncertain must name parameters given: amplitude, period, restitution; got"
    ):
        rk.prove(orbit, uncertain={"frequency": 1e-9})
    with pytest.raises(TypeError, match="uncertain must be a dict; got 0.1"):
        rk.prove(orbit, uncertain=0.1)
    with pytest.raises(ValueError, match="amplitude must lie in"):
        rk.prove(orbit, uncertain={"amplitude": -1.0})
    with pytest.raises(ValueError, match="subject must be an orbit or a periodic verdict; got 'overturned'"):
        rk.prove(rk.classify(system_of(1.75, 2.0, 0.95)))
    full = rk.System(rk.Harmonic(2.0, period=1.0), 0.925, critical_angle=0.2)
    for refused in (lambda: rk.classify(full, prove=True), lambda: rk.horseshoe(full)):
        with pytest.raises(ValueError, match="proofs are available for the slender block only"):
            refused()
    assert cases.PRECISIONS[0] == BITS


# Maps


def test_share_of_a_map_counts_proofs_and_reasons():
    found = rk.parametric_map(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925),
        amplitude=np.linspace(1.0, 9.0, 8),
        period=np.linspace(0.4, 2.0, 8),
    ).dataset
    periodic = int((found.kind == rk.Kind.PERIODIC.code).sum())
    shares = rk.proved_share(found, points=20, seed=3)
    assert (shares.orbits.count, shares.orbits.of) == (20, 20)
    assert shares.starts.count + sum(shares.reasons.values()) == 20
    assert rk.proved_share(found, points=20, seed=3) == shares
    assert rk.proved_share(found.isel(amplitude=[4]), points=1000).orbits.of <= periodic


def test_share_of_a_map_names_what_was_refused(monkeypatch):
    from rocking.proof import attraction

    monkeypatch.setattr(attraction, "MAX_CYCLES", 2)
    found = rk.parametric_map(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925), amplitude=[2.0, 2.1], period=[1.0, 1.1]
    ).dataset
    shares = rk.proved_share(found)
    assert (shares.orbits.count, shares.starts.count) == (4, 0)
    assert list(shares.reasons.values()) == [4]
    assert "does not reach the neighbourhood within 2 cycles" in str(shares)


def test_maps_without_periodic_responses_and_full_blocks_are_refused():
    still = rk.parametric_map(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925), amplitude=[0.5, 0.6], period=[1.0, 1.1]
    ).dataset
    with pytest.raises(ValueError, match="result must have periodic responses; the map has none"):
        rk.proved_share(still)
    full = rk.parametric_map(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925, critical_angle=0.2),
        amplitude=[2.0, 2.1],
        period=[1.0, 1.1],
    ).dataset
    with pytest.raises(ValueError, match="proofs are available for the slender block only"):
        rk.proved_share(full)
    with pytest.raises(ValueError, match="points must"):
        rk.proved_share(full, points=0)
    with pytest.raises(TypeError, match="result must be a map of responses; got None"):
        rk.proved_share(None)
