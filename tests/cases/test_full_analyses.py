"""Verdicts, exponents, orbits and maps of the full block: against many digits, single motions and the limit of slender blocks."""

import math

import mpmath as mp
import numpy as np
import pytest

import rocking as rk
from oracles.full_block import DIGITS, Block, Cosine
from rocking.motion.march_loop import monodromy

PERIODIC = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), 0.925, critical_angle=0.25)
CHAOTIC = rk.System(rk.Harmonic(amplitude=10.188, period=1.7105), 0.8, critical_angle=0.1)


def drawn(count, seed, angles):
    """Return random systems of the paper's ranges, with critical angles between two limits."""
    random = np.random.default_rng(seed)
    return [
        rk.System(
            rk.Harmonic(amplitude=random.uniform(0.0, 12.0), period=random.uniform(0.2, 3.0)),
            random.uniform(0.5, 0.95),
            critical_angle=None if angles is None else random.uniform(*angles),
        )
        for _ in range(count)
    ]


@pytest.mark.parametrize(
    "seed", [pytest.param(k, marks=pytest.mark.long) if k in (1, 3, 4) else k for k in range(6)]
)
def test_tangent_vectors_are_differences_of_states_in_many_digits(seed):
    random = np.random.default_rng(seed)
    alpha, restitution = float(random.uniform(0.05, 1.0)), float(random.uniform(0.4, 0.8))
    amplitude = math.tan(alpha) / alpha * float(random.uniform(0.8, 1.6))
    forcing = rk.Harmonic(
        amplitude, period=float(random.uniform(0.5, 1.5)), phase=float(random.uniform(-3, 3))
    )
    start = rk.State(*(float(value) for value in random.uniform(-0.3, 0.3, 2)))
    found = monodromy(rk.System(forcing, restitution, critical_angle=alpha), start, 2)
    with mp.workdps(DIGITS):
        end, near = 2 * mp.mpf(forcing.period), mp.mpf(10) ** -12
        exact = Block(
            Cosine(amplitude, 2 * mp.pi / mp.mpf(forcing.frequency), forcing.phase), restitution, alpha
        )
        columns = []
        for step in ((near, 0), (0, near)):
            there, back = (
                exact.final(end, start.angle + sign * step[0], start.velocity + sign * step[1])[:2]
                for sign in (1, -1)
            )
            columns.append([float((one - two) / (2 * near)) for one, two in zip(there, back, strict=True)])
    assert np.linalg.norm(found) > 0.1
    np.testing.assert_allclose(found, np.array(columns).T, rtol=0, atol=1e-11 * np.abs(found).max())


def test_area_is_kept_but_for_impacts():
    start = rk.State(0.2, -0.1)
    motion = rk.simulate(CHAOTIC, start, cycles=5)
    assert motion.impacts > 3
    found = np.linalg.det(monodromy(CHAOTIC, start, 5))
    assert found == pytest.approx(0.8 ** (2 * motion.impacts), rel=1e-10)


def test_verdicts_tend_to_those_of_slender_blocks():
    """At θcr = 0.001 the equations differ by 10⁻⁶, which changes no kind of these responses, and no period."""
    differ = 0
    for system in drawn(60, 3, None):
        slender = rk.classify(system)
        full = rk.classify(rk.System(system.forcing, system.restitution, critical_angle=0.001))
        differ += (slender.kind, slender.period) != (full.kind, full.period)
        if slender.period is not None and full.period == slender.period and slender.multipliers[0] != 0:
            assert abs(slender.multipliers[0] - full.multipliers[0]) < 1e-3
    assert differ <= 1  # a chaotic transient may end elsewhere


def test_multipliers_differ_from_those_of_the_slender_block_by_the_square_of_the_angle():
    slender = rk.classify(rk.System(PERIODIC.forcing, 0.925)).multipliers[0]
    apart = [
        abs(rk.classify(rk.System(PERIODIC.forcing, 0.925, critical_angle=angle)).multipliers[0] - slender)
        for angle in (0.08, 0.04, 0.02)
    ]
    assert apart[0] / apart[1] == pytest.approx(4.0, rel=0.05)
    assert apart[1] / apart[2] == pytest.approx(4.0, rel=0.05)


def test_verdicts_are_true_of_long_motions():
    kinds = set()
    for system in drawn(60, 7, (0.05, 0.8)):
        verdict = rk.classify(system)
        kinds.add(str(verdict.kind))
        motion = rk.simulate(system, cycles=400, record="section")
        assert (verdict.kind == "overturned") == (motion.outcome == "overturned") or verdict.cycles > 400
        if verdict.kind == "periodic" and verdict.multipliers[0] != 0:
            section, period = motion.section(), verdict.period
            reach = abs(verdict.multipliers[0]) ** (300 / period)
            if motion.outcome != "overturned" and reach < 1e-10:
                np.testing.assert_allclose(section[-1], section[-1 - period], rtol=0, atol=1e-8)
    assert {"periodic", "overturned", "rest"} <= kinds


def test_exponent_of_chaos_is_the_divergence_of_two_motions():
    """Renormalised after each cycle, as in Benettin's method, with motions alone."""
    spectrum = rk.lyapunov(CHAOTIC, cycles=4_000)
    state, apart, growth = rk.simulate(CHAOTIC, cycles=200, record="none").final, np.array([1e-8, 0.0]), []
    for _ in range(2_000):
        near = rk.State(state.angle + apart[0], state.velocity + apart[1])
        one, two = (rk.simulate(CHAOTIC, at, cycles=1, record="none").final for at in (state, near))
        apart = np.array([two.angle - one.angle, two.velocity - one.velocity])
        size = np.hypot(*apart)
        growth.append(math.log(size / 1e-8))
        apart, state = apart * (1e-8 / size), one
    parts = np.array(growth).reshape(20, -1).mean(axis=1) / CHAOTIC.periodic.period
    error = math.hypot(parts.std() / math.sqrt(19), spectrum.errors[0])
    assert spectrum.values[0] > 5 * spectrum.errors[0]
    assert abs(parts.mean() - spectrum.values[0]) < 5 * error
    assert abs(spectrum.sum_rule_error) < 1e-9


def test_orbits_repeat_and_have_the_multipliers_of_differences():
    found = rk.find_orbits(PERIODIC, 1)
    slender = rk.find_orbits(rk.System(PERIODIC.forcing, 0.925), 1)
    assert found.settled
    assert [(orbit.impacts, orbit.stability) for orbit in found] == [
        (orbit.impacts, orbit.stability) for orbit in slender
    ]
    for orbit in found:
        assert orbit.residual < 1e-11
        end = rk.simulate(PERIODIC, orbit.start, cycles=orbit.period).final
        assert math.hypot(end.angle - orbit.start.angle, end.velocity - orbit.start.velocity) < 1e-11
        columns = []
        for step in ((1e-6, 0.0), (0.0, 1e-6)):
            there, back = (
                rk.simulate(
                    PERIODIC,
                    rk.State(orbit.start.angle + sign * step[0], orbit.start.velocity + sign * step[1]),
                    cycles=orbit.period,
                ).final
                for sign in (1, -1)
            )
            columns.append(((there.angle - back.angle) / 2e-6, (there.velocity - back.velocity) / 2e-6))
        wanted = np.linalg.eigvals(np.array(columns).T)
        for multiplier in orbit.multipliers:
            assert np.abs(wanted - multiplier).min() < 1e-6
    verdict = rk.classify(PERIODIC)
    again = rk.find_orbit(PERIODIC, verdict.orbit.start, 1)
    assert again.multipliers[0] == pytest.approx(verdict.multipliers[0], abs=1e-9)
    assert any(np.abs(np.array(orbit.multipliers) - again.multipliers[0]).min() < 1e-9 for orbit in found)


def test_orbit_of_the_full_block_gives_its_state_at_any_phase():
    orbit = rk.classify(PERIODIC).orbit
    orbit = rk.find_orbit(PERIODIC, orbit.start, 1)
    motion = orbit.motion(cycles=1)
    for time in np.linspace(0.05, 0.95, 7):
        state = orbit.at(PERIODIC.periodic.phase + PERIODIC.periodic.frequency * time)
        assert np.hypot(*(np.array([state.angle, state.velocity]) - motion.at(time))) < 1e-10


def test_maps_are_the_single_verdicts():
    amplitudes, angles = np.linspace(0.5, 12.0, 8), np.array([0.05, 0.2, 0.4, 0.8])
    found = rk.parametric_map(
        rk.System(rk.Harmonic(1.0, period=1.3), restitution=0.8), amplitude=amplitudes, critical_angle=angles
    ).dataset
    assert found.kind.dims == ("amplitude", "critical_angle")
    assert found.critical_angle.attrs["units"] == "rad"
    kinds = [str(kind) for kind in rk.Kind]
    for i, amplitude in enumerate(amplitudes):
        for k, angle in enumerate(angles):
            system = rk.System(rk.Harmonic(float(amplitude), period=1.3), 0.8, critical_angle=float(angle))
            verdict = rk.classify(system)
            assert kinds[int(found.kind[i, k])] == str(verdict.kind)
            assert float(found.peak[i, k]) == verdict.peak


def test_basins_are_the_single_verdicts():
    starts = np.linspace(-0.9, 0.9, 7)
    found = rk.basin_map(PERIODIC, angle=starts, velocity=starts, boundary_runs=0)
    names = [each.name for each in found.attractors]
    assert "overturned" in names
    for i, angle in enumerate(starts):
        for k, velocity in enumerate(starts):
            at = found.dataset.attractor.sel(angle=angle, velocity=velocity)
            verdict = rk.classify(PERIODIC, rk.State(float(angle), float(velocity)))
            name = names[int(at)]
            assert (name == "overturned") == (verdict.kind == "overturned"), (i, k)
            assert name.startswith("period") == (verdict.kind == "periodic")


def test_surveys_of_random_points_answer_for_the_full_block():
    safe = rk.safe_basin(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.8, critical_angle=0.3),
        amplitude=[1.0, 3.0],
        samples=300,
    )
    assert math.isnan(safe.heteroclinic_amplitude)
    assert all(0.0 < each.value < 1.0 for each in safe.shares)
    share = rk.chaos_share(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=1.0, critical_angle=0.3),
        restitution=[0.5, 0.9],
        samples=40,
    )
    assert share.dataset.attrs["critical_angle"] == 0.3
    curve = rk.overturning_amplitude(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925, critical_angle=0.3),
        period=[1.5, 2.0],
        amplitude=np.linspace(1, 5, 21),
        phases=2,
    )
    assert np.isnan(curve.dataset.heteroclinic_amplitude).all()
    for period, lowest, resolution in zip(
        (1.5, 2.0), curve.dataset.lowest.values, curve.dataset.resolution.values, strict=True
    ):
        assert 0.0 < resolution < 0.3
        phase = float(curve.dataset.lowest_phase.sel(period=period))
        system = rk.System(rk.Harmonic(float(lowest), period=period, phase=phase), 0.925, critical_angle=0.3)
        assert rk.simulate(system, cycles=1_000, record="none").outcome == "overturned"
    assert rk.repeatability(PERIODIC, samples=40).kinds


def test_orbit_diagram_is_the_section_of_single_motions():
    values = [1.5, 2.0, 2.5]
    diagram = rk.orbit_diagram(PERIODIC, amplitude=values, sweep="rest", transient=50, cycles=3)
    over_angles = rk.orbit_diagram(PERIODIC, critical_angle=[0.1, 0.25], sweep="rest", transient=50, cycles=3)
    for k, value in enumerate(values):
        system = rk.System(rk.Harmonic(value, period=1.0), 0.925, critical_angle=0.25)
        section = rk.simulate(system, cycles=53, record="section").section()
        np.testing.assert_allclose(diagram.points[0, k], section[50:53], rtol=0, atol=1e-9)
    np.testing.assert_array_equal(over_angles.points[0, 1], diagram.points[0, 1])


@pytest.mark.parametrize(
    "call",
    [
        lambda: rk.continue_orbit(rk.classify(PERIODIC).orbit, "brace_angle", (0.5, 2.0)),
        lambda: rk.saddle_manifolds(PERIODIC),
        lambda: rk.tangency_amplitude(PERIODIC),
        lambda: rk.parametric_map(
            rk.System(
                rk.Harmonic(1.0, period=1.0), restitution=0.9, braces=rk.Braces(8.0), critical_angle=0.2
            ),
            amplitude=[1.0, 2.0],
            period=[1.0, 2.0],
        ),
        lambda: rk.chaos_share(
            rk.System(
                rk.Harmonic(1.0, period=1.0), restitution=0.9, braces=rk.Braces(8.0), critical_angle=0.2
            )
        ),
        lambda: rk.parametric_map(
            rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.9, critical_angle=2.0),
            amplitude=[1.0, 2.0],
            period=[1.0, 2.0],
        ),
    ],
)
def test_what_has_no_answer_is_refused_in_one_line(call):
    with pytest.raises((TypeError, ValueError)) as refused:
        call()
    assert "\n" not in str(refused.value)
    assert len(str(refused.value)) < 200
