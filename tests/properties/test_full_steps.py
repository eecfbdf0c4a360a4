"""Steps of the full block: their error against its bound, and the first zero of their polynomials against exact roots."""

import math

import mpmath as mp
import numpy as np
import pytest
from flint import fmpq, fmpq_poly
from numba import njit

import rocking as rk
from oracles.full_block import DIGITS, Block, Cosine
from oracles.full_steps import Line, Motion, Start, Wave
from rocking.kernels import system as numbers
from rocking.kernels.arc.first_zero_full import first_zero_of_step
from rocking.kernels.arc.full_step import LONG, cannot_reach_base, error_bound, state_in, step_from
from rocking.kernels.base.cosine import HarmonicDrive, PulseDrive
from rocking.kernels.base.samples import SampledDrive
from rocking.motion.march_loop import parameters

FEW, MANY = 400, 20_000
STEPS = 200
ROUNDING = 2.0**-53


@pytest.fixture(scope="module")
def kernels():
    """The kernels, callable from Python."""
    zero, step, state, bound, clear = first_zero_of_step, step_from, state_in, error_bound, cannot_reach_base

    @njit
    def find(a, b, c, h):
        return zero(a, b, c, h)

    @njit
    def take(p, side, angle, velocity, drive):
        made = step(p, side, angle, velocity, drive)
        error = bound(p, side, velocity, made.series, made.sine, made.length, drive, LONG)
        return made, state(made, made.length), error, clear(p, side, made, drive)

    return find, take


@pytest.mark.parametrize("left", [(1.0, 1.0), (1.6, 0.9), (0.6, 1.1)])
def test_error_of_a_step_is_below_its_bound(kernels, left):
    random, worst = np.random.default_rng(1), 0.0
    for _ in range(40):
        alpha, amplitude, period, phase = (
            float(random.uniform(*limits)) for limits in ((0.05, 1.2), (0.0, 6.0), (0.3, 3.0), (-3.0, 3.0))
        )
        angle, velocity = float(random.uniform(0.0, 1.2)), float(random.uniform(-1.0, 1.0))
        block = numbers.full_block(0.9, alpha, left=numbers.LeftSide(*left, 0.9))
        p, side = numbers.harmonic_system(block, amplitude, 2 * math.pi / period, period, phase), -1
        drive = HarmonicDrive(math.cos(p.forcing.phase), math.sin(p.forcing.phase))
        made, (rise, speed), bound, _ = kernels[1](p, side, angle, velocity, drive)
        with mp.workdps(DIGITS):
            base = Cosine(amplitude, 2 * mp.pi / mp.mpf(p.forcing.frequency), p.forcing.phase)
            exact = Block(base, 0.9, alpha, left=left)
            u, v, _ = exact.step(side, mp.mpf(0), mp.mpf(angle), mp.mpf(velocity), mp.mpf(made.length) / 2)
            u, v, _ = exact.step(side, mp.mpf(made.length) / 2, u, v, mp.mpf(made.length) / 2)
        assert bound <= 1e-16
        error = max(abs(float(u - angle - rise)), abs(float(v - speed)))
        worst = max(worst, error)
        assert error <= bound + 40 * ROUNDING * (1.0 + amplitude + abs(velocity))
    assert worst > 0.0


def polynomial(random):
    """Return a + b t + c t^2 + ... on [0, 1] as (a, b, tuple): often with a zero at the start, or nearly with a double one.

    Kinds 4 to 7 begin with terms of very different sizes, as after a lift-off shortly before a sample.
    """
    kind = random.integers(8)
    c = random.normal(size=19) / np.cumprod(np.arange(2.0, 21.0))
    a, b = abs(random.normal()) * 10.0 ** random.uniform(-9, 0), random.normal()
    if kind == 1:
        a, b = 0.0, abs(b) * 10.0 ** random.uniform(-9, 0)
    if kind == 2:
        a, b, c[0] = 0.0, 0.0, abs(c[0])
    if kind == 3:  # the minimum of a parabola near 0
        place, bend = random.uniform(0.1, 0.9), abs(random.normal())
        a, b = bend * place**2 + random.normal() * 10.0 ** random.uniform(-15, -6), -2.0 * bend * place
        c = c * 1e-3
        c[0] = bend
        a = abs(a)
    if kind == 4:
        a, b, c[0] = 0.0, 0.0, 10.0 ** random.uniform(-16, 0)
    if kind == 5:
        a, b = 10.0 ** random.uniform(-30, -9), abs(b)
    if kind == 6:
        a, b, c[0] = (
            sign * 10.0 ** random.uniform(-18, -3) for sign in (1.0, *random.choice([-1.0, 1.0], 2))
        )
    if kind == 7:
        a, b, c[0], c[1] = 0.0, 0.0, 0.0, 10.0 ** random.uniform(-9, 0)
    return float(a), float(b), tuple(map(float, c))


def first_root(a, b, c):
    """Return the first root in (0, 1] at which the polynomial falls, by exact isolation; infinity if there is none."""
    exact = fmpq_poly([fmpq(*float(one).as_integer_ratio()) for one in (a, b, *c)])
    falls = [
        float(root.real) for root, _ in exact.numer().complex_roots() if root.imag == 0 and 0 < root.real <= 1
    ]
    slope = exact.derivative()
    falls = [x for x in sorted(falls) if slope(fmpq(*x.as_integer_ratio())) < 0]
    return falls[0] if falls else math.inf


def check_polynomials(find, count, seed):
    random, wrong, crossing = np.random.default_rng(seed), [], 0
    for _ in range(count):
        a, b, c = polynomial(random)
        found, exact = find(a, b, c, 1.0), first_root(a, b, c)
        crossing += exact < math.inf
        if found == exact or abs(found - exact) <= 1e-9 * exact:
            continue
        # An invented zero must be one to rounding; beyond a missed one the polynomial must stay above 0 to rounding.
        places = np.array([found]) if found < exact else np.linspace(exact, min(found, 1.0), 2_000)
        terms = np.array([a, b, *c]) * places[:, None] ** np.arange(21)
        value, size = terms.sum(axis=1), np.abs(terms).sum(axis=1)
        if (np.abs(value) if found < exact else -value).max() > 16 * ROUNDING * size.max():
            wrong.append((a, b, c, found, exact))
    assert not wrong, f"{len(wrong)} of {count} wrong; the first: {wrong[0]}"
    assert crossing > 0.3 * count


def test_first_zero_of_a_polynomial_is_that_of_exact_isolation(kernels):
    check_polynomials(kernels[0], FEW, 0)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(1, 4))
def test_first_zero_of_many_polynomials_is_that_of_exact_isolation(kernels, seed):
    check_polynomials(kernels[0], MANY, seed)


def test_a_start_that_rounding_put_below_zero_and_that_falls_is_the_zero(kernels):
    assert kernels[0](-1e-17, -0.5, (0.1,) * 19, 1.0) == 0.0


def start_of_step(random, sampled):
    """Return the start of a step and the order of its zero.

    It lies after an impact, at a lift-off, in flight, shortly before a touch, or just after a lift-off at which |A| hardly
    exceeds the limit but grows fast.
    """
    alpha, amplitude = float(random.uniform(0.02, 1.2)), float(random.uniform(0.0, 8.0))
    frequency, phase = 2 * math.pi / float(random.uniform(0.3, 3.0)), float(random.uniform(-math.pi, math.pi))
    side, kind = int(random.choice([-1, 1])), random.integers(5)
    cosine, sine = math.cos(phase), math.sin(phase)
    angle, velocity, order = float(random.uniform(0.0, 1.2)), float(random.uniform(-1.0, 1.0)), 0
    if kind in (1, 3):  # pushed away from the base
        cosine = -side * abs(cosine)
    if kind == 4:
        least = math.tan(alpha) / alpha
        amplitude = max(amplitude, 2.0 * least)
        cosine = -side * (1.0 + 10.0 ** float(random.uniform(-12, -1))) * least / amplitude
        sine = side * math.sqrt(1.0 - cosine**2)
    now = amplitude * cosine
    base = Line(now, frequency * amplitude * sine) if sampled else Wave(amplitude, frequency, cosine, sine)
    bend = -math.sin(alpha) / alpha - side * now * math.cos(alpha)
    if kind == 0 or (kind == 1 and bend <= 0.0):
        angle, velocity, order = 0.0, abs(velocity) * 10.0 ** float(random.uniform(-9, 0)), 1
    elif kind == 1:
        angle, velocity, order = 0.0, 0.0, 2
    elif kind == 3 and bend > 0.0:
        time = float(random.uniform(0.01, 0.3))
        angle = abs(bend * time**2 / 2 + random.normal() * 10.0 ** random.uniform(-15, -4))
        velocity = -bend * time
    elif kind == 4:
        angle, velocity, order = 0.0, 0.0, 2
        if random.random() < 0.5:
            angle, order = 10.0 ** float(random.uniform(-20, -9)), 0
    return Start(alpha, side, angle, velocity, base), order


def harmonic(start, _):
    """Return parameters and drive of a step under a cosine."""
    base = start.base
    block, period = numbers.full_block(0.9, start.alpha), 2 * math.pi / base.frequency
    p = numbers.harmonic_system(block, base.amplitude, base.frequency, period, 0.0)
    return p, HarmonicDrive(base.cosine, base.sine)


def pulse(start, random):
    """Return parameters and drive of a step that the end of a pulse may cut short."""
    base, left = start.base, float(10.0 ** random.uniform(-3, 0))
    block = numbers.full_block(0.9, start.alpha)
    p = numbers.pulse_system(block, base.amplitude, base.frequency, 0.0, left, 10.0)
    return p, PulseDrive(0.0, base.cosine, base.sine)


def sampled(start, random):
    """Return parameters and drive of a step from a sample on."""
    base, step = start.base, float(10.0 ** random.uniform(-3, 0))
    values = [base.value, base.value + base.slope * step]
    system = rk.System(rk.PiecewiseLinear(values, step=step), 0.9, critical_angle=start.alpha)
    return parameters(system, None), SampledDrive(0, 0.0)


def fault_of(kernels, place, random, start, order):
    """Return what is wrong with a step: "inaccurate", or its first zero is "missed" or "invented"; and whether it has a zero."""
    find, take = kernels
    p, drive = place(start, random)
    step, (rise, _), _, clear = take(p, start.side, start.angle, start.velocity, drive)
    found = math.inf if clear else find(step.angle, step.velocity, step.series, step.length)
    exact = Motion(start, step.length)
    fall = exact.first_fall(order)

    def rounding(time):
        push = 1.0 + float(start.base.largest(time).upper())
        size = start.angle + abs(start.velocity) * time + push * time**2
        return 16 * ROUNDING * size + 1e-16 * (time / step.length) ** 2

    if abs(float(exact.at(step.length).mid()) - (start.angle + rise)) > rounding(step.length):
        return "inaccurate", fall is not None
    if found < math.inf and float(abs(exact.at(found)).mid()) > rounding(found):
        return "invented" if fall is None or found < fall.low else "misplaced", True
    if fall is not None and fall.low < found:
        for time in np.linspace(fall.low, min(found, step.length), 60).tolist():
            if float(exact.at(time).mid()) < -rounding(time):
                return "missed", True
    return "", fall is not None


def check_steps(kernels, place, count, seed):
    random, wrong, crossings = np.random.default_rng(seed), [], 0
    for _ in range(count):
        start, order = start_of_step(random, place is sampled)
        fault, crosses = fault_of(kernels, place, random, start, order)
        crossings += crosses
        if fault:
            wrong.append((fault, start))
    assert not wrong, f"{len(wrong)} of {count} wrong; the first: {wrong[0]}"
    assert crossings > 0.1 * count


class Ramp:
    """Base acceleration that is linear in time, for the other oracle; samples would round its slope."""

    def __init__(self, line):
        self.value, self.slope = mp.mpf(line.value), mp.mpf(line.slope)

    def at(self, time):
        return self.value + self.slope * time

    def corner_after(self, _):
        return mp.inf


def base_by_collocation(base):
    """Return the base acceleration of a step as the other oracle takes it."""
    if isinstance(base, Line):
        return Ramp(base)
    cosine, sine = mp.mpf(base.cosine), mp.mpf(base.sine)
    size = mp.mpf(base.amplitude) * mp.sqrt(cosine**2 + sine**2)
    return Cosine(size, 2 * mp.pi / mp.mpf(base.frequency), mp.atan2(sine, cosine))


@pytest.mark.parametrize("linear", [False, True])
def test_enclosure_holds_the_motion_by_collocation(linear):
    random = np.random.default_rng(2)
    for _ in range(10):
        start, _ = start_of_step(random, linear)
        with mp.workdps(DIGITS):
            base = base_by_collocation(start.base)
            time, u, v = mp.mpf(0), mp.mpf(start.angle), mp.mpf(start.velocity)
            exact = Block(base, 0.9, start.alpha)
            for _ in range(32):
                u, v, _ = exact.step(start.side, time, u, v, mp.mpf(1) / 64)
                time += mp.mpf(1) / 64
            ball = Motion(start, 0.5).at(0.5)
            middle, radius = (mp.mpf(str(each.str(40, radius=False))) for each in (ball.mid(), ball.rad()))
            assert abs(u - middle) <= radius + mp.mpf(10) ** -25
            assert radius < 1e-16


@pytest.mark.parametrize(
    "place",
    [harmonic, pytest.param(pulse, marks=pytest.mark.long), pytest.param(sampled, marks=pytest.mark.long)],
)
def test_first_zero_of_a_step_is_that_of_the_enclosed_motion(kernels, place):
    check_steps(kernels, place, STEPS, 0)


@pytest.mark.long
@pytest.mark.parametrize("place", [harmonic, pulse, sampled])
@pytest.mark.parametrize("part", range(5))
def test_first_zeros_of_many_steps_are_those_of_the_enclosed_motion(kernels, thin, part, place):
    """24,000 steps in all; a million with --exhaustive."""
    for seed in thin(range(334 * part, 334 * (part + 1)), 7):
        check_steps(kernels, place, STEPS, 1 + seed)
