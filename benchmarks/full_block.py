"""The full block: the engine, heyoka, SciPy's DOP853 and RK4 on the same motions, with the error of each.

Errors are those of the state after 20 cycles, or at a time under a ground motion, against 40 digits. RK4 interpolates the instants
of impacts within its step. Heyoka finds impacts as events, under a ground motion from sample to sample.
"""

import time
from functools import partial
from math import cos, sin
from typing import NamedTuple

import heyoka as hy
import mpmath as mp
import numpy as np
from numba import njit
from scipy.integrate import solve_ivp

import rocking as rk
from benchmarks.clock import quickest_in_turn
from benchmarks.table import Figure
from rocking.kernels.motion import march
from rocking.kernels.motion.march import Recording
from rocking.motion.march_loop import parameters
from tests.oracles.full_block import DIGITS, Block, Cosine, Samples

CYCLES, TURNS = 20, 25
# Cycles of the timed runs: enough that calls from Python cost nothing.
LONG, LONG_OF_SCIPY = 1_000, 20
# Runs under a ground motion that are timed together: after the first one the caches hold what a run needs.
RUNS = 20
STEPS_OF_RK4 = 1_000
STEPS_PER_SAMPLE = 10
OVER_HEYOKA, OVER_RK4 = 2.5, 20.0
RECORD_OVER_HEYOKA, RECORD_OVER_RK4 = 10.0, 4.0
SECONDS_OF_MAP = 15.0


class Case(NamedTuple):
    """Full block with a base motion, from an initial state in general position."""

    name: str
    system: rk.System
    start: rk.State
    until: float  # τ


HARMONIC = tuple(
    Case(
        f"A={amplitude:.4g} T={period:.4g} e={restitution} θcr={angle}",
        rk.System(rk.Harmonic(amplitude, period=period), restitution, critical_angle=angle),
        rk.State(0.1, 0.05),
        CYCLES * period,
    )
    for amplitude, period, restitution, angle in (
        (2.0, 1.0, 0.925, 0.25),
        (6.5, 0.4, 0.925, 0.25),
        (10.103037, 1.721328, 0.8, 0.1),
    )
)


def record_case():
    """Return a block that rocks under a part of the example's ground motion, up to shortly after an impact.

    The engine follows each arc to its impact. So up to an instant in flight it would do more than the others.
    """
    motion = rk.example_ground_motion()
    base = motion.normalised(9.80665 * 0.2, 2.0)
    values = np.asarray(base.values)[400:1600] * base.scale * 5.0
    system = rk.System(rk.PiecewiseLinear(values, step=base.step), 0.925, critical_angle=0.2)
    return Case("ground motion, 1,045 samples", system, rk.State(0.3, 0.1), 1_045 * base.step)


def exact(case):
    """Return the state at the end in many digits, and the number of impacts."""
    forcing, block = case.system.forcing, case.system
    with mp.workdps(DIGITS):
        if is_periodic(case):
            base, until = (
                Cosine(forcing.amplitude, 2 * mp.pi / mp.mpf(forcing.frequency), 0),
                mp.mpf(case.until),
            )
        else:
            base, until = Samples(forcing.values * forcing.scale, forcing.step), mp.mpf(case.until)
        end = Block(base, block.restitution, block.critical_angle).final(
            until, case.start.angle, case.start.velocity
        )
    return float(end[0]), float(end[1]), end[2]


def is_periodic(case):
    return isinstance(case.system.forcing, rk.Harmonic)


def repeated(run, times):
    """Return a function that calls ``run`` several times, and gives the last result."""

    def runs():
        for _ in range(times):
            result = run()
        return result

    return runs


def engine(case, cycles):
    """Return a function that marches the block to the end, and gives the state there; runs replace cycles under a ground motion."""
    length, marched = (None, cycles) if is_periodic(case) else (case.until, 1)
    p = parameters(case.system, length)
    begun, _ = march.begin_march(p, case.start.angle, case.start.velocity)

    def run():
        arc = march.march(p, begun, marched, Recording())[1].arc
        return arc.side * arc.angle, arc.side * arc.velocity

    return repeated(run, cycles // marched)


@njit
def rk4_harmonic(amplitude, frequency, angle, restitution, theta, rate, h, count):
    side = 1.0 if theta > 0.0 else -1.0
    for k in range(count):
        t = k * h
        now, mid, later = (
            amplitude * cos(frequency * t),
            amplitude * cos(frequency * (t + 0.5 * h)),
            amplitude * cos(frequency * (t + h)),
        )
        theta, rate, side = rk4_step(theta, rate, side, angle, restitution, h, now, mid, later)
    return theta, rate


@njit
def rk4_samples(values, step, angle, restitution, theta, rate, samples):
    side, h = (1.0 if theta > 0.0 else -1.0), step / STEPS_PER_SAMPLE
    for index in range(samples):
        start, change = values[index], values[index + 1] - values[index]
        for part in range(STEPS_PER_SAMPLE):
            now = start + change * part / STEPS_PER_SAMPLE
            mid = start + change * (part + 0.5) / STEPS_PER_SAMPLE
            later = start + change * (part + 1.0) / STEPS_PER_SAMPLE
            theta, rate, side = rk4_step(theta, rate, side, angle, restitution, h, now, mid, later)
    return theta, rate


@njit
def bend(theta, side, angle, push):
    w = angle * (1.0 - side * theta)
    return -side * sin(w) / angle - push * cos(w)


@njit
def rk4_step(theta, rate, side, angle, restitution, h, now, mid, later):
    a1 = bend(theta, side, angle, now)
    v2 = rate + 0.5 * h * a1
    a2 = bend(theta + 0.5 * h * rate, side, angle, mid)
    v3 = rate + 0.5 * h * a2
    a3 = bend(theta + 0.5 * h * v2, side, angle, mid)
    v4 = rate + h * a3
    a4 = bend(theta + h * v3, side, angle, later)
    after, speed = (
        theta + h / 6.0 * (rate + 2.0 * v2 + 2.0 * v3 + v4),
        rate + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4),
    )
    if side * after >= 0.0:
        return after, speed, side
    share = theta / (theta - after)
    speed, left = restitution * (rate + share * (speed - rate)), (1.0 - share) * h
    turned = bend(0.0, -side, angle, later)
    return left * (speed + 0.5 * left * turned), speed + left * turned, -side


def rk4(case, cycles):
    """Return a function that integrates by RK4, and gives the state at the end."""
    forcing, block = case.system.forcing, case.system
    given = block.critical_angle, block.restitution, case.start.angle, case.start.velocity
    if is_periodic(case):
        h = forcing.period / STEPS_OF_RK4
        return lambda: rk4_harmonic(forcing.amplitude, forcing.frequency, *given, h, cycles * STEPS_OF_RK4)
    values = np.ascontiguousarray(forcing.values * forcing.scale)
    samples = round(case.until / forcing.step)
    return repeated(lambda: rk4_samples(values, forcing.step, *given, samples), cycles)


class Heyoka:
    """Integrator heyoka at its default tolerance, with impacts as events; as in its manual."""

    def __init__(self, case):
        self.case = case
        angle, velocity = hy.make_vars("angle", "velocity")
        forcing, critical, e = case.system.forcing, case.system.critical_angle, case.system.restitution
        if is_periodic(case):
            push, count = forcing.amplitude * hy.cos(forcing.frequency * hy.time), 1
        else:
            push, count = hy.par[1] + hy.par[2] * hy.time, 3
        w = critical * (1.0 - hy.par[0] * angle)
        equations = [
            (angle, velocity),
            (velocity, -hy.par[0] * hy.sin(w) / critical - push * hy.cos(w)),
        ]

        def impact(block, slope):
            block.state[1] *= e
            block.pars[0] = -block.pars[0]
            return True

        event = hy.t_event(angle, callback=impact)
        self.block = hy.taylor_adaptive(equations, [0.0, 0.0], t_events=[event], pars=[1.0, 0.0, 0.0][:count])

    def run(self, cycles):
        if is_periodic(self.case):
            return self.run_once(cycles)
        return repeated(lambda: self.run_once(1), cycles)()

    def run_once(self, cycles):
        block, case = self.block, self.case
        block.state[:], block.pars[0], block.time = (case.start.angle, case.start.velocity), 1.0, 0.0
        block.reset_cooldowns()
        if is_periodic(case):
            block.propagate_until(cycles * case.system.forcing.period)
            return tuple(block.state)
        forcing = case.system.forcing
        values = forcing.values * forcing.scale
        for index in range(round(case.until / forcing.step)):
            block.pars[1:] = values[index], (values[index + 1] - values[index]) / forcing.step
            block.time = 0.0
            block.propagate_until(forcing.step)
        return tuple(block.state)


def dop853(case, cycles):
    """Return a function that integrates by SciPy's DOP853 at rtol 1e-12, restarted after each impact."""
    forcing, critical, e = case.system.forcing, case.system.critical_angle, case.system.restitution

    def run():
        time, state, side = 0.0, (case.start.angle, case.start.velocity), 1.0

        def push(at):
            return float(forcing.acceleration(at))

        def rates(at, y):
            w = critical * (1.0 - side * y[0])
            return y[1], -side * sin(w) / critical - push(at) * cos(w)

        def angle(_, y):
            return y[0]

        angle.terminal = True
        while True:
            angle.direction = -side
            arc = solve_ivp(
                rates,
                (time, cycles * forcing.period),
                state,
                method="DOP853",
                rtol=1e-12,
                atol=1e-14,
                events=angle,
            )
            if arc.status != 1:
                return tuple(arc.y[:, -1])
            time, state, side = arc.t[-1], (0.0, e * arc.y[1, -1]), -side

    return run


def speed():
    """Time the engine, and the ratios of the others' times to it, each with its error."""
    for case in HARMONIC:
        peer = Heyoka(case)
        peers = {
            "heyoka": (lambda cycles, peer=peer: partial(peer.run, cycles), LONG, OVER_HEYOKA),
            f"RK4, T/{STEPS_OF_RK4:,}": (partial(rk4, case), LONG, OVER_RK4),
            "SciPy DOP853, rtol 1e-12": (partial(dop853, case), LONG_OF_SCIPY, None),
        }
        yield from compared(case, peers, LONG)
    case = record_case()
    peer = Heyoka(case)
    peers = {
        "heyoka": (lambda runs: partial(peer.run, runs), RUNS, RECORD_OVER_HEYOKA),
        "RK4, ten steps per sample": (partial(rk4, case), RUNS, RECORD_OVER_RK4),
    }
    yield from compared(case, peers, RUNS)
    yield map_of_responses()


def map_of_responses():
    """Time a map over the ranges of figure 11 of Yim & Lin."""

    def computed(points):
        start = time.perf_counter()
        amplitudes, periods = np.linspace(0.0, 16.0, points), np.linspace(0.2, 3.0, points)
        system = rk.System(rk.Harmonic(2.0, period=1.0), 0.925, critical_angle=0.25)
        rk.parametric_map(system, amplitude=amplitudes, period=periods)
        return time.perf_counter() - start

    computed(10)  # loads the kernels
    note = "0 ≤ A ≤ 16, 0.2 ≤ T ≤ 3"
    return Figure("map, 99,856 points, e=0.925 θcr=0.25", computed(316), "s", SECONDS_OF_MAP, note=note)


def compared(case, peers, cycles):
    """Yield the time of the engine per cycle, or per run under a ground motion, and the ratios of the others' times to it."""
    angle, velocity, impacts = exact(case)
    ways = [engine(case, cycles), *(way(count) for way, count, _ in peers.values())]
    (mine, _), *others = quickest_in_turn(TURNS, ways)
    unit = "cycle" if is_periodic(case) else "run"
    note = f"per {unit}; error after {impacts} impacts {error(engine(case, CYCLES)(), angle, velocity):.1e}"
    yield Figure(case.name, 1e6 * mine / cycles, "µs", note=note)
    for (name, (way, count, goal)), (taken, _) in zip(peers.items(), others, strict=True):
        note = f"error {error(way(CYCLES)(), angle, velocity):.1e}"
        yield Figure(f"  {name}", taken / count / (mine / cycles), "×", goal, least=True, note=note)


def error(found, angle, velocity):
    """Return the larger error of Θ and Θ'."""
    return max(abs(found[0] - angle), abs(found[1] - velocity))
