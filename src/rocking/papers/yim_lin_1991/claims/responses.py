"""Claims on the classes of response, Eqs. (6) and (7), and figures 2 to 6."""

from __future__ import annotations

import numpy as np

import rocking as rk
from rocking.papers.report.claim import PROVABLE, Chapter, Finding, agreement
from rocking.papers.yim_lin_1991 import cached_surveys, table_exponents
from rocking.papers.yim_lin_1991.cases import CHAOTIC, OVERTURNING, PERIODIC, QUASI_PERIODIC, Case

CHAPTER = Chapter("Classes of response")


def _periodic(case: Case, period: int, symmetric: bool, impacts: int) -> tuple[bool, str]:
    found = rk.classify(case.system, case.start, prove=PROVABLE)
    as_said = (found.kind, found.period, found.symmetric, found.impacts_per_period) == (
        rk.Kind.PERIODIC,
        period,
        symmetric,
        impacts,
    )
    shape = "symmetric" if found.symmetric else "asymmetric"
    proved = ", proved in ball arithmetic" if found.evidence.level == "proved" else ""
    return as_said, (
        f"{found.kind}, period {found.period}, {shape}, {found.impacts_per_period} impacts per period, largest |Θ| {found.peak:.4f}{proved}"
    )


@CHAPTER.claim("Eq. (6)")
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


@CHAPTER.claim("Eq. (7)", cost=1.0)
def equation_7() -> Finding:
    """A quasi-periodic response combines two or more incommensurate frequencies."""
    density, turns = cached_surveys.torus_spectrum(), cached_surveys.torus_turns()
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


@CHAPTER.claim("Figs. 2a, 3a")
def figure_2a() -> Finding:
    """A = 2, T = 1, e = 0.925 from rest: the harmonic (1, 1) mode."""
    return Finding(*_periodic(PERIODIC[0], 1, True, 2))


@CHAPTER.claim("Figs. 2b, 3b")
def figure_2b() -> Finding:
    """A = 6.5, T = 0.4, e = 0.925 from rest: the one-third subharmonic, (1, 3)."""
    return Finding(*_periodic(PERIODIC[1], 3, True, 2))


@CHAPTER.claim(
    "Figs. 2c, 3c",
    misprint="(2, 10): the response is asymmetric and has period 10, but four impacts per period, hence two rocking cycles",
)
def figure_2c() -> Finding:
    """A = 5.5, T = 0.5, e = 0.925 from 0.15, φ = 1.8: asymmetric one-tenth subharmonic, the (1, 10) mode."""
    case = PERIODIC[2]
    one, figures = _periodic(case, 10, False, 2)
    two, _ = _periodic(case, 10, False, 4)
    return Finding(one, figures, shown=two)


@CHAPTER.claim(
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
        shown=velocity.period == 10 and angle.period == 7 and bool(angle.symmetric),
    )


@CHAPTER.claim("Fig. 4")
def figure_4() -> Finding:
    """A = 1.75, T = 2, e = 0.95: the block overturns."""
    motion = rk.simulate(OVERTURNING.system, cycles=20)
    fell = motion.overturning
    cycle = fell.cycle + 1 if fell else 0
    return Finding(
        motion.outcome is rk.Outcome.OVERTURNED,
        f"{motion.outcome} in cycle {cycle}, after {motion.impacts} impacts; overturning is certain (proved)",
    )


@CHAPTER.claim("Fig. 5")
def figure_5() -> Finding:
    """A = 4, T = 0.4, e = 1: quasi-periodic."""
    found = rk.classify(QUASI_PERIODIC.system)
    return Finding(found.kind is rk.Kind.QUASI_PERIODIC, f"{found.evidence}")


@CHAPTER.claim("Fig. 6", cost=0.7)
def figure_6() -> Finding:
    """A = 2, T = 0.4, e = 1: chaotic."""
    kinds = [rk.classify(system).kind for system in table_exponents.sea_systems(32)]
    chaotic, other = kinds.count(rk.Kind.CHAOTIC), len(kinds) - kinds.count(rk.Kind.CHAOTIC)
    undetermined = kinds.count(rk.Kind.UNDETERMINED)
    return Finding(
        chaotic > len(kinds) // 2 and other == undetermined,
        f"of {len(kinds)} runs with forcing phases within {table_exponents.SEA_PHASES:g} of each other, {chaotic} are chaotic and "
        f"{undetermined} undetermined (long sojourns near islands)",
    )


@CHAPTER.claim("Overturning response")
def overturning_amplitudes() -> Finding:
    """Overturning occurs at large amplitudes of the base acceleration."""
    found = cached_surveys.damped()
    overturned = (found.kind == rk.Kind.OVERTURNED.code).transpose("period", "amplitude").values
    quarters = [float(part.mean()) for part in np.array_split(overturned, 4, axis=1)]
    shares = ", ".join(f"{100 * share:.1f} %" for share in quarters)
    return Finding(
        quarters[0] == min(quarters) and quarters[-1] == max(quarters),
        f"fraction overturned in the four quarters of A from 0 to 16, e = 0.925: {shares}",
    )


@CHAPTER.claim("Chaotic response")
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
