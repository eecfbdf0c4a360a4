"""Claims on equations of motion, on responses and on their identification: Eqs. (1) to (7), figures 1 to 8."""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp

import rocking as rk
from rocking.model.text import percent
from rocking.papers.catalogue import YIM_LIN_1991
from rocking.papers.report.claim import PROVABLE, Finding, agreement, small
from rocking.papers.yim_lin_1991 import surveys
from rocking.papers.yim_lin_1991.surveys import CHAOTIC, OVERTURNING, PERIODIC, QUASI_PERIODIC, Case

EQUATIONS = YIM_LIN_1991.chapter("Equations of motion")
BLOCK = rk.Block(height=2.0, width=0.5, restitution=0.925)
# Step of central differences, and their largest admissible error relative to the largest second derivative.
STEP, LEFT = 1e-3, 1e-5


def _physical_residual(side: int) -> float:
    """Return the largest difference between θ'' of an exact motion and of Eq. (1), relative to the largest θ''."""
    system = BLOCK.system(acceleration=3.0, frequency_hz=1.2)
    motion = rk.simulate(system, cycles=20)
    seconds = np.linspace(0.5, 15.0, 20_000)
    tau = BLOCK.time(seconds)
    parts = [
        np.radians(BLOCK.degrees(motion.at(tau + shift)[0]))
        for shift in (-BLOCK.time(STEP), 0.0, BLOCK.time(STEP))
    ]
    differences = (parts[0] - 2.0 * parts[1] + parts[2]) / STEP**2
    base = 3.0 * np.cos(2.0 * np.pi * 1.2 * seconds)
    expected = rk.theory.physical_acceleration(BLOCK, parts[1], base)
    chosen = np.all([side * part > 0.0 for part in parts], axis=0)
    return float(np.abs(differences - expected)[chosen].max() / np.abs(expected).max())


@EQUATIONS.claim("Fig. 1")
def figure_1() -> Finding:
    """A rectangular block H by B on two corners; the critical angle is arccot(H/B)."""
    angle = np.radians(BLOCK.degrees(1.0))
    stands, falls = (
        rk.simulate(
            rk.System(rk.Harmonic(amplitude=0.0, period=1.0), 0.925), rk.State(angle=start), cycles=60
        ).outcome
        for start in (0.999, 1.001)
    )
    holds = (
        abs(angle - np.arctan2(0.5, 2.0)) < 1e-15
        and stands is rk.Outcome.AT_REST
        and falls is rk.Outcome.OVERTURNED
    )
    return Finding(
        bool(holds),
        f"H = 2 m, B = 0.5 m: θcr = {angle:.6f} rad; released at 0.999 θcr: {stands}, at 1.001 θcr: {falls}",
    )


@EQUATIONS.claim("Eq. (1a)")
def equation_1a() -> Finding:
    """Rocking about O, θ > 0: inertia, base acceleration and weight."""
    residual = _physical_residual(1)
    return Finding(
        residual < LEFT,
        f"second differences of the computed motion in SI units satisfy it to {small(residual)} of the largest θ''",
    )


@EQUATIONS.claim("Eq. (1b)")
def equation_1b() -> Finding:
    """Rocking about O', θ < 0: as Eq. (1a), with θcr + θ."""
    residual = _physical_residual(-1)
    return Finding(
        residual < LEFT,
        f"second differences of the computed motion in SI units satisfy it to {small(residual)} of the largest θ''",
    )


@EQUATIONS.claim("Eq. (2)")
def equation_2() -> Finding:
    """An impact reduces the angular velocity by the factor e, 0 ≤ e ≤ 1."""
    system = PERIODIC[0].system
    hits = surveys.impacts(rk.simulate(system, cycles=200))
    off = np.abs(hits["after"] - system.restitution * hits["before"]).max()
    return Finding(bool(off < 1e-15), f"{len(hits)} impacts: Θ'₊ and e Θ'₋ are {agreement(off)}")


@EQUATIONS.claim("Eq. (3)")
def equation_3() -> Finding:
    """The base acceleration is harmonic, with constant amplitude, frequency and phase."""
    forcing = rk.Harmonic(amplitude=2.0, frequency=3.0, phase=0.7)
    times = np.linspace(0.0, 50.0, 1001)
    off = np.abs(forcing.acceleration(times) - 2.0 * np.cos(3.0 * times + 0.7)).max()
    return Finding(
        bool(off < 1e-13),
        f"the acceleration of the base and A cos(Ωτ + φ) are {agreement(off)} over 50 units of τ",
    )


def _fallen(_: float, state: np.ndarray) -> float:
    return float(state[0])


_fallen.terminal, _fallen.direction = True, -1  # type: ignore[attr-defined]


def _integrated(system: rk.System, impacts: int) -> tuple[np.ndarray, np.ndarray]:
    """Integrate from rest by a Runge-Kutta method of order 8, with u = side · Θ.

    Returns
    -------
    tuple of (array, array)
        Times of the first impacts, and speeds after them.
    """
    forcing, e = system.harmonic, system.restitution
    time, speed, side, times, speeds = 0.0, 0.0, -1, [], []
    for _ in range(impacts):

        def motion(tau: float, state: np.ndarray, side: int = side) -> tuple[float, float]:
            return state[1], state[0] - 1.0 - side * float(forcing.acceleration(tau))

        # a negligibly short step away from Θ = 0, so that the start is not an event
        lifted = solve_ivp(motion, (time, time + 1e-6), (0.0, speed), "DOP853", rtol=1e-12, atol=1e-18)
        flight = solve_ivp(
            motion, (time + 1e-6, time + 100.0), lifted.y[:, -1], "DOP853", events=_fallen, rtol=1e-13, atol=1e-15
        )  # fmt: skip
        time, speed, side = float(flight.t_events[0][0]), -e * float(flight.y_events[0][0][1]), -side
        times.append(time)
        speeds.append(speed)
    return np.array(times), np.array(speeds)


@EQUATIONS.claim("Eqs. (4a), (4b)")
def equation_4() -> Finding:
    """The normalised equation Θ'' − Θ = −A cos(Ωτ + φ) ∓ 1 on either side."""
    system = PERIODIC[0].system
    times, speeds = _integrated(system, 20)
    hits = surveys.impacts(rk.simulate(system, cycles=30))[:20]
    apart = max(np.abs(hits["time"] - times).max(), np.abs(np.abs(hits["after"]) - speeds).max())
    return Finding(
        bool(apart < 1e-9),
        f"first 20 impacts at A = 2, T = 1, e = 0.925 by numerical integration: times and speeds differ by {small(apart)}",
    )


@EQUATIONS.claim("Eqs. (5a), (5b)")
def equation_5() -> Finding:
    """Between impacts Θ is a sum of sinh, cosh, ±1 and β cos(Ωτ + φ), with β = A/(1 + Ω²)."""
    system = PERIODIC[0].system
    motion = rk.simulate(system, cycles=30)
    forcing = system.harmonic
    beta = forcing.amplitude / (1.0 + forcing.frequency**2)
    hits = surveys.impacts(motion)
    worst = 0.0
    for k in range(10, 30):
        start, stop = hits["time"][k], hits["time"][k + 1]
        times = np.linspace(start, stop, 52)[1:-1]
        angle, _ = motion.at(times)
        side = np.sign(angle[0])
        rest = angle - side - beta * np.cos(forcing.frequency * times + forcing.phase)
        shape = np.column_stack((np.sinh(times - start), np.cosh(times - start)))
        fitted = np.linalg.lstsq(shape, rest, rcond=None)[0]
        worst = max(worst, float(np.abs(shape @ fitted - rest).max()))
    return Finding(
        worst < 1e-13, f"two constants fit 50 points on each of 20 arcs, on both sides, to {small(worst)}"
    )


CLASSES = YIM_LIN_1991.chapter("Classes of response")


def _periodic(case: Case, period: int, symmetric: bool, impacts: int) -> tuple[bool, str]:
    response = rk.classify(case.system, case.start, prove=PROVABLE)
    orbit = response.period, response.symmetric, response.impacts_per_period
    shape = "symmetric" if response.symmetric else "asymmetric"
    proved = ", proved in ball arithmetic" if response.evidence.level == "proved" else ""
    return response.kind is rk.Kind.PERIODIC and orbit == (period, symmetric, impacts), (
        f"{response.kind}, period {response.period}, {shape}, {response.impacts_per_period} impacts per period, "
        f"largest |Θ| {response.peak:.4f}{proved}"
    )


@CLASSES.claim("Eq. (6)")
def equation_6() -> Finding:
    """A periodic response repeats itself after a fixed time."""
    case = PERIODIC[1]
    motion = rk.simulate(case.system, cycles=2_000)
    times = np.linspace(1_900.0, 1_990.0, 5_001) * case.system.harmonic.period
    later = times + 3.0 * case.system.harmonic.period
    off = np.abs(motion.at(later)[0] - motion.at(times)[0]).max()
    return Finding(
        bool(off < 1e-11), f"figure 2b after 1,900 cycles: Θ(τ + 3T) and Θ(τ) are {agreement(off)}"
    )


@CLASSES.claim("Eq. (7)", cost=1.0)
def equation_7() -> Finding:
    """A quasi-periodic response combines two or more incommensurate frequencies."""
    density, turns = surveys.torus_spectrum(), surveys.torus_turns()
    named = [line for line in density.peaks if line.name]
    rotation, free = density.rotation or 0.0, turns.free or 0.0
    # f_r and the rotation frequency about the centre of the island are equal up to multiples of f/3
    multiple = 3.0 * (rotation - free / 3.0), 3.0 * (rotation + free / 3.0)
    one = min(abs(m - round(m)) for m in multiple)
    nearest = min(abs(free - p / q) * q * q for q in range(1, 60) for p in range(q + 1))
    return Finding(
        len(density.peaks) > 3 and len(named) == len(density.peaks) and nearest > 0.05 and one < 1e-6,
        f"figure 5: {len(density.peaks)} lines, {len(named)} of them combinations of f/3 and f_r = {rotation:.8f} f; the motion makes "
        f"{free:.10f} turns in 3 cycles, not close to any fraction with a denominator below 60",
    )


@CLASSES.claim("Figs. 2a, 3a")
def figure_2a() -> Finding:
    """A = 2, T = 1, e = 0.925 from rest: the harmonic (1, 1) mode."""
    return Finding(*_periodic(PERIODIC[0], 1, True, 2))


@CLASSES.claim("Figs. 2b, 3b")
def figure_2b() -> Finding:
    """A = 6.5, T = 0.4, e = 0.925 from rest: the one-third subharmonic, (1, 3)."""
    return Finding(*_periodic(PERIODIC[1], 3, True, 2))


@CLASSES.claim(
    "Figs. 2c, 3c",
    misprint="(2, 10): the response is asymmetric and has period 10, but four impacts per period, hence two rocking cycles",
)
def figure_2c() -> Finding:
    """A = 5.5, T = 0.5, e = 0.925 from 0.15, φ = 1.8: asymmetric one-tenth subharmonic, the (1, 10) mode."""
    case = PERIODIC[2]
    one, figures = _periodic(case, 10, False, 2)
    two, _ = _periodic(case, 10, False, 4)
    return Finding(one, figures, explained=two)


@CLASSES.claim(
    "Fig. 2, caption",
    misprint="0.15 is the initial velocity, as in the caption of figure 3. An initial angle of 0.15 leads to a symmetric "
    "response of period 7",
)
def figure_2_caption() -> Finding:
    """The initial state of 2c is (θ, φ) = (0.15, 1.8): an angle."""
    system = PERIODIC[2].system
    angle, velocity = (
        rk.classify(system, start) for start in (rk.State(angle=0.15), rk.State(velocity=0.15))
    )
    return Finding(
        angle.period == 10,
        f"from Θ = 0.15: period {angle.period}; from Θ' = 0.15: period {velocity.period}",
        explained=velocity.period == 10 and angle.period == 7 and bool(angle.symmetric),
    )


@CLASSES.claim("Fig. 4")
def figure_4() -> Finding:
    """A = 1.75, T = 2, e = 0.95: the block overturns."""
    motion = rk.simulate(OVERTURNING.system, cycles=20)
    fell = motion.overturning
    cycle = fell.cycle + 1 if fell else 0
    return Finding(
        motion.outcome is rk.Outcome.OVERTURNED,
        f"{motion.outcome} in cycle {cycle}, after {motion.impacts} impacts; overturning is certain (proved)",
    )


@CLASSES.claim("Fig. 5")
def figure_5() -> Finding:
    """A = 4, T = 0.4, e = 1: quasi-periodic."""
    response = rk.classify(QUASI_PERIODIC.system)
    return Finding(response.kind is rk.Kind.QUASI_PERIODIC, f"{response.evidence}")


@CLASSES.claim("Fig. 6", cost=0.7)
def figure_6() -> Finding:
    """A = 2, T = 0.4, e = 1: chaotic."""
    kinds = [rk.classify(system).kind for system in surveys.sea_systems(32)]
    chaotic, other = kinds.count(rk.Kind.CHAOTIC), len(kinds) - kinds.count(rk.Kind.CHAOTIC)
    undetermined = kinds.count(rk.Kind.UNDETERMINED)
    return Finding(
        chaotic > len(kinds) // 2 and other == undetermined,
        f"of {len(kinds)} runs with forcing phases within {surveys.SEA_PHASES:g} of each other, {chaotic} are chaotic and "
        f"{undetermined} undetermined (long sojourns near islands)",
    )


@CLASSES.claim("Overturning response")
def overturning_amplitudes() -> Finding:
    """Overturning occurs at large amplitudes of the base acceleration."""
    survey = surveys.damped()
    overturned = (survey.kind == rk.Kind.OVERTURNED.code).transpose("period", "amplitude").values
    quarters = [float(part.mean()) for part in np.array_split(overturned, 4, axis=1)]
    shares = ", ".join(f"{100 * share:.1f} %" for share in quarters)
    return Finding(
        quarters[0] == min(quarters) and quarters[-1] == max(quarters),
        f"fraction overturned in the four quarters of A from 0 to 16, e = 0.925: {shares}",
    )


@CLASSES.claim("Chaotic response")
def divergence() -> Finding:
    """Nearby trajectories of a chaotic response diverge exponentially."""
    system = CHAOTIC.system
    near, far = (
        rk.simulate(system, rk.State(velocity=v), cycles=400, record="section").section()
        for v in (0.0, 1e-12)
    )
    apart = np.hypot(*(near - far).T)
    reached = int(np.argmax(apart > 1e-2))
    rate = np.log(1e-2 / 1e-12) / max(reached, 1)
    return Finding(
        bool(apart.max() > 1e-2 and rate > 0.02),
        f"figure 6: a trajectory that starts at a distance of 1e-12 is 0.01 away after {reached} cycles, {rate:.2f} nats per cycle on "
        "average",
    )


IDENTIFICATION = YIM_LIN_1991.chapter("Identification of responses")
SUBHARMONIC = PERIODIC[1].system


@IDENTIFICATION.claim("Fig. 7a")
def figure_7a() -> Finding:
    """The Poincaré map of the one-third subharmonic has three fixed points."""
    points = rk.simulate(SUBHARMONIC, cycles=2_000, record="section").section()[-300:]
    distinct = len(np.unique(points.round(9), axis=0))
    return Finding(distinct == 3, f"{distinct} points, visited in turn over the last 300 of 2,000 cycles")


@IDENTIFICATION.claim(
    "Fig. 7b",
    qualified="three closed curves, visited in turn; they are the intersections of one torus with the section",
    cost=0.7,
)
def figure_7b() -> Finding:
    """The Poincaré map of the quasi-periodic response forms three tori."""
    turns = surveys.torus_turns()
    low, high = surveys.dimension(QUASI_PERIODIC.system, 20_000).estimate.interval
    curves = turns.period == 3 and low < 1.0 < high
    return Finding(
        low < 2.0 < high,
        f"period of the islands {turns.period}; dimension of the points {low:.2f} to {high:.2f}",
        explained=curves,
    )


@IDENTIFICATION.claim(
    "Fig. 7c",
    qualified="the response is chaotic, but undamped motions conserve area, so that nothing attracts: it is a chaotic sea "
    "around islands",
)
def figure_7c() -> Finding:
    """The Poincaré map of the chaotic response is a strange attractor."""
    spectrum = surveys.spectrum(CHAOTIC.system, 100_000)
    total = float(spectrum.values.sum())
    return Finding(
        total < -1e-6,
        f"λ₁ + λ₂ = {small(total)} per unit of τ over 10⁵ cycles: areas are conserved",
        explained=abs(total) < 1e-9 and spectrum.values[0] > 0.0,
    )


@IDENTIFICATION.claim(
    "Fig. 8a",
    qualified="the line at a third of the forcing frequency is the strongest, but the line at the forcing frequency is strong too",
    cost=0.2,
)
def figure_8a() -> Finding:
    """The spectral density of the periodic response has a single dominant frequency."""
    motion = rk.simulate(SUBHARMONIC, cycles=8_790)
    density = rk.spectral_density(motion, transient=600)
    strongest = sorted(density.peaks, key=lambda line: -line.amplitude)[:2]
    shares = [0.5 * line.amplitude**2 / density.variance for line in strongest]
    return Finding(
        shares[0] > 0.9,
        f"{strongest[0].name} has {100 * shares[0]:.1f} % of the variance, {strongest[1].name} {100 * shares[1]:.1f} %",
        explained=strongest[0].name == "f/3" and shares[1] > 0.1,
    )


@IDENTIFICATION.claim("Fig. 8b")
def figure_8b() -> Finding:
    """The spectral density of the quasi-periodic response has a finite number of incommensurate frequencies."""
    density = surveys.torus_spectrum()
    unnamed = sum(1 for line in density.peaks if not line.name)
    return Finding(
        unnamed == 0 and len(density.peaks) > 2 and density.line_share > 0.99,
        f"{len(density.peaks)} lines, all combinations of two frequencies, hold {percent(density.line_share)} of the variance",
    )


@IDENTIFICATION.claim("Fig. 8c", cost=1.3)
def figure_8c() -> Finding:
    """The spectral density of the chaotic response is a broad band."""
    # One run in forty stays near an island so long that its lines hold half of the variance.
    systems = surveys.sea_systems(9)
    shares = [rk.spectral_density(rk.simulate(system, cycles=8_192)).line_share for system in systems]
    return Finding(
        bool(np.median(shares) < 0.5),
        f"lines hold {100 * np.median(shares):.0f} % of the variance, the band the rest (median of {len(shares)} runs with "
        f"phases within {surveys.SEA_PHASES:g}); the largest value is {100 * max(shares):.0f} %",
    )


@IDENTIFICATION.claim(
    "Response identification",
    qualified="0 is the exponent along the flow, which every motion has; both exponents of the section are negative, here "
    "ln e per impact",
)
def exponent_periodic() -> Finding:
    """The Lyapunov exponent of the periodic response is 0."""
    spectrum = surveys.spectrum(SUBHARMONIC, 20_000)
    expected = math.log(0.925) * 2.0 / 3.0
    per_cycle, error = (float(pair[0]) for pair in spectrum.per_cycle)
    return Finding(
        abs(per_cycle) < 1e-3,
        f"λ₁ = λ₂ = {per_cycle:.6f} per cycle; ln e times 2 impacts in 3 cycles is {expected:.6f}",
        explained=abs(per_cycle - expected) < 2.0 * error,
    )


@IDENTIFICATION.claim("Response identification")
def exponent_quasi_periodic() -> Finding:
    """The Lyapunov exponent of the quasi-periodic response is 0."""
    spectrum = surveys.spectrum(QUASI_PERIODIC.system, 200_000)
    value = float(spectrum.per_cycle[0][0])
    return Finding(
        abs(value) < 1e-3,
        f"λ₁ = {small(value)} per cycle over 2·10⁵ cycles, decreasing as ln n/n: shear, no exponential divergence",
    )


@IDENTIFICATION.claim("Response identification")
def exponent_chaotic() -> Finding:
    """The Lyapunov exponent of the chaotic response is 0.14 (unit, length of run and initial state not given)."""
    mean, spread = surveys.sea()
    return Finding(
        abs(mean - 0.14) < spread,
        f"{mean:.3f} nats per cycle over {surveys.SEA_CYCLES:,} cycles, single runs ± {spread:.3f}; it decreases with the "
        "length of the run",
    )


@IDENTIFICATION.claim("Response identification")
def dimension_periodic() -> Finding:
    """The dimension of the periodic response is 0."""
    isolated = surveys.dimension(SUBHARMONIC, 2_000, transient=2_000).estimate.isolated
    return Finding(isolated == 3, f"section: 0 ({isolated} isolated points)")


@IDENTIFICATION.claim(
    "Response identification",
    qualified="2 is the dimension of the torus in the flow; in the section, to which the 0 of the periodic response refers, it is 1",
)
def dimension_quasi_periodic() -> Finding:
    """The dimension of the quasi-periodic response is 2.0."""
    low, high = surveys.dimension(QUASI_PERIODIC.system, 20_000).estimate.interval
    return Finding(
        low < 2.0 < high,
        f"section {low:.2f} to {high:.2f}, flow {low + 1:.2f} to {high + 1:.2f}",
        explained=low < 1.0 < high,
    )


@IDENTIFICATION.claim(
    "Response identification",
    error="a chaotic sea fills an area: 2 in the section, 3 in the flow; a small number of points gives 2.3 at large radii",
)
def dimension_chaotic() -> Finding:
    """The dimension of the chaotic response is 2.3, not an integer."""
    section = surveys.sea_dimension().estimate
    fine = section.slopes[section.radii[:-1] < 0.03]
    slope = float(fine[: max(len(fine) // 2, 1)].mean()) if len(fine) else math.nan
    coarse = float(section.slopes[section.radii[:-1] >= surveys.COARSE].mean())
    return Finding(
        abs(slope + 1.0 - 2.3) < 0.1,
        f"local slopes in the section: {coarse:.2f} at radii above {surveys.COARSE} standard deviations, {slope:.2f} at the "
        f"smallest radii; in the flow {coarse + 1:.2f} and {slope + 1:.2f}",
        explained=slope > 1.6,
    )
