"""Claims on the equations of motion, Eqs. (1) to (5), and figure 1."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

import rocking as rk
from rocking.papers.report.claim import Chapter, Finding, agreement, small
from rocking.papers.yim_lin_1991.cases import PERIODIC

CHAPTER = Chapter("Equations of motion")
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


@CHAPTER.claim("Fig. 1")
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


@CHAPTER.claim("Eq. (1a)")
def equation_1a() -> Finding:
    """Rocking about O, θ > 0: inertia, base acceleration and weight."""
    residual = _physical_residual(1)
    return Finding(
        residual < LEFT,
        f"second differences of the computed motion in SI units satisfy it to {small(residual)} of the largest θ''",
    )


@CHAPTER.claim("Eq. (1b)")
def equation_1b() -> Finding:
    """Rocking about O', θ < 0: as Eq. (1a), with θcr + θ."""
    residual = _physical_residual(-1)
    return Finding(
        residual < LEFT,
        f"second differences of the computed motion in SI units satisfy it to {small(residual)} of the largest θ''",
    )


@CHAPTER.claim("Eq. (2)")
def equation_2() -> Finding:
    """An impact reduces the angular velocity by the factor e, 0 ≤ e ≤ 1."""
    system = PERIODIC[0].system
    hits = rk.simulate(system, cycles=200).events
    hits = hits[hits["kind"] == "impact"]
    off = np.abs(hits["after"] - system.restitution * hits["before"]).max()
    return Finding(bool(off < 1e-15), f"{len(hits)} impacts: Θ'₊ and e Θ'₋ are {agreement(off)}")


@CHAPTER.claim("Eq. (3)")
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
        found = solve_ivp(
            motion, (time + 1e-6, time + 100.0), lifted.y[:, -1], "DOP853", events=_fallen, rtol=1e-13, atol=1e-15
        )  # fmt: skip
        time, speed, side = float(found.t_events[0][0]), -e * float(found.y_events[0][0][1]), -side
        times.append(time)
        speeds.append(speed)
    return np.array(times), np.array(speeds)


@CHAPTER.claim("Eqs. (4a), (4b)")
def equation_4() -> Finding:
    """The normalised equation Θ'' − Θ = −A cos(Ωτ + φ) ∓ 1 on either side."""
    system = PERIODIC[0].system
    times, speeds = _integrated(system, 20)
    hits = rk.simulate(system, cycles=30).events
    hits = hits[hits["kind"] == "impact"][:20]
    apart = max(np.abs(hits["time"] - times).max(), np.abs(np.abs(hits["after"]) - speeds).max())
    return Finding(
        bool(apart < 1e-9),
        f"first 20 impacts at A = 2, T = 1, e = 0.925 by numerical integration: times and speeds differ by {small(apart)}",
    )


@CHAPTER.claim("Eqs. (5a), (5b)")
def equation_5() -> Finding:
    """Between impacts Θ is a sum of sinh, cosh, ±1 and β cos(Ωτ + φ), with β = A/(1 + Ω²)."""
    system = PERIODIC[0].system
    motion = rk.simulate(system, cycles=30)
    forcing = system.harmonic
    beta = forcing.amplitude / (1.0 + forcing.frequency**2)
    hits = motion.events[motion.events["kind"] == "impact"]
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
