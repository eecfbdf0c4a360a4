"""Frames, impacts and design rules, each against an evaluation of another kind: momentum balances, root searches, oscillators."""

import math
import re
import warnings

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rocking as rk
from rocking.theory import (
    contact_restitution,
    design_angle,
    equal_displacement_angle,
    equivalent_damping,
    ishiyama_levels,
    pulse_overturning_rule,
    rocking_frame,
)

GRAVITY = mp.mpf("9.80665")
SHAPES = [(2.0, 0.5), (9.6, 1.6), (1.2, 0.7)]


def velocity(about, place, spin):
    """Velocity of a point of a body that rotates clockwise about another point."""
    x, y = place[0] - about[0], place[1] - about[1]
    return spin * y, -spin * x


def power(mass, inertia, before, after, place):
    """Sum of momenta of a rigid body before an impact times its velocities after: (corner, spin) of both motions."""
    (old, spin), (new, unit) = before, after
    v, u = velocity(old, place, spin), velocity(new, place, unit)
    return mass * (v[0] * u[0] + v[1] * u[1]) + inertia * spin * unit


def frame_by_momenta(height, width, beam, column, number):
    """Restitution and frequency parameter of a frame from its bodies.

    The impulses at the new corners and between columns and beam do no work on the motion after the impact. So the momenta
    before and after have the same product with it.
    """
    b, h = mp.mpf(width) / 2, mp.mpf(height) / 2
    old, new, centre = (2 * b, mp.mpf(0)), (mp.mpf(0), mp.mpf(0)), (b, h)
    inertia = mp.mpf(column) * (b * b + h * h) / 3
    # Before, the beam rests on the left top corners of columns that turn about the right bottom ones; after, conversely.
    left, right = (mp.mpf(0), 2 * h), (2 * b, 2 * h)
    v, u = velocity(old, left, 1), velocity(new, right, 1)
    before = number * power(column, inertia, (old, 1), (new, 1), centre) + beam * (v[0] * u[0] + v[1] * u[1])
    after = number * power(column, inertia, (new, 1), (new, 1), centre) + beam * (u[0] ** 2 + u[1] ** 2)
    # Small rotations about the unstable balance: moment of gravity per angle over the inertia.
    radius = mp.sqrt(b * b + h * h)
    moment = GRAVITY * (number * column * radius + beam * 2 * radius)
    return before / after, mp.sqrt(moment / after)


@pytest.mark.parametrize(("height", "width"), SHAPES)
@pytest.mark.parametrize(("beam", "column", "number"), [(0.0, 700.0, 2), (2800.0, 350.0, 4), (1e5, 10.0, 3)])
def test_frame_is_that_of_the_momenta_and_energies_of_its_bodies(height, width, beam, column, number):
    with mp.workdps(30):
        restitution, frequency = frame_by_momenta(height, width, beam, column, number)
    frame = rocking_frame(height, width, beam / (number * column))
    assert frame.restitution == pytest.approx(float(restitution), rel=1e-14)
    assert frame.frequency_parameter == pytest.approx(float(frequency), rel=1e-14)
    assert (frame.height, frame.width) == (height, width)


def test_frame_without_a_beam_is_its_column():
    column, frame = rk.Block(2.0, 0.5), rocking_frame(2.0, 0.5, 0.0)
    assert (frame.inertia_ratio, frame.frequency_parameter) == (
        column.inertia_ratio,
        column.frequency_parameter,
    )
    assert frame.restitution == pytest.approx(column.restitution, rel=1e-15)


@pytest.mark.parametrize(("height", "width"), SHAPES)
@pytest.mark.parametrize("fraction", [0.0, 0.3, 0.8, 1.0])
def test_restitution_conserves_the_angular_momentum_about_the_point_of_impact(height, width, fraction):
    with mp.workdps(30):
        b, h, k = mp.mpf(width) / 2, mp.mpf(height) / 2, mp.mpf(fraction)
        inertia = (b * b + h * h) / 3
        place = (-k * b, mp.mpf(0))  # on the side of the new corner (-b, 0)

        def momentum(corner):
            x, y = velocity(corner, (mp.mpf(0), h), 1)
            return inertia + (h - place[1]) * x - (0 - place[0]) * y

        wanted = momentum((b, mp.mpf(0))) / momentum((-b, mp.mpf(0)))
    block = rk.Block(height, width, restitution=0.5)
    assert contact_restitution(block.critical_angle, fraction) == pytest.approx(float(wanted), rel=1e-14)


def test_impact_at_the_corner_is_housners_and_at_the_centre_without_loss():
    angles = np.array([rk.Block(*shape).critical_angle for shape in SHAPES])
    housner = [rk.Block(*shape).housner_restitution for shape in SHAPES]
    assert contact_restitution(angles, 1.0) == pytest.approx(housner, rel=1e-15)
    assert contact_restitution(angles, 0.0).tolist() == [1.0, 1.0, 1.0]
    assert contact_restitution(angles[:, None], np.array([0.0, 0.5])).shape == (3, 2)


@pytest.mark.parametrize(
    ("degrees", "priestley", "fema"), [(10, 3.15, 1.81), (15, 7.20, 4.02), (20, 13.12, 7.02)]
)
def test_damping_is_the_percentage_of_makris_and_konstantinidis(degrees, priestley, fema):
    """Makris & Konstantinidis (2003), to the last digit printed."""
    with mp.workdps(30):
        r = (1 - mp.mpf(3) / 2 * mp.sin(mp.radians(degrees)) ** 2) ** 2
        exact = {"priestley": -mp.mpf("0.34") * mp.log(r), "fema-356": mp.mpf("0.4") * (1 - mp.sqrt(r))}
    e = 1 - 1.5 * math.sin(math.radians(degrees)) ** 2
    for rule, printed in (("priestley", priestley), ("fema-356", fema)):
        found = equivalent_damping(e, rule)
        assert found == pytest.approx(float(exact[rule]), rel=1e-13)
        assert 100 * found == pytest.approx(printed, abs=0.005)


def test_damping_at_the_ends_of_its_range():
    assert equivalent_damping([1.0, 0.0], "fema-356").tolist() == [0.0, 0.4]
    assert equivalent_damping([1.0, 0.0], "priestley").tolist() == [0.0, math.inf]


def displacement(ground, period, damping):
    """Largest displacement of an oscillator during a motion, by integration with small steps."""
    omega = math.tau / period

    def slope(t, state):
        base = np.interp(t, ground.times, ground.acceleration)
        return [state[1], -2 * damping * omega * state[1] - omega**2 * state[0] - base]

    done = solve_ivp(
        slope,
        (0.0, ground.duration),
        [0.0, 0.0],
        "DOP853",
        np.linspace(0.0, ground.duration, 100_000),
        rtol=1e-10,
        atol=1e-13,
        max_step=ground.step,
    )
    return np.abs(done.y[0]).max()


# One sine of 0.6 s, and 4 s of rest, in which the oscillators reach their largest displacements.
PULSE = rk.GroundMotion(np.append(np.sin(np.pi * np.arange(61) / 30), np.zeros(400)), step=0.01)


@pytest.mark.parametrize("rule", ["fema-356", "priestley"])
@pytest.mark.parametrize(("height", "width", "pga"), [(3.0, 0.8, 5.0), (2.0, 0.5, 3.0), (6.0, 1.5, 3.0)])
def test_angle_of_the_loop_is_that_of_the_oscillator_whose_period_it_has(height, width, pga, rule):
    ground, block = PULSE.scaled(pga=pga), rk.Block(height, width)
    angle = design_angle(ground, block, rule)
    assert 0.01 < angle < 1.0
    theta, slenderness = mp.mpf(angle) * mp.mpf(block.critical_angle), mp.mpf(block.critical_angle)
    alpha = mp.sqrt(3 * GRAVITY / (4 * mp.hypot(height, width) / 2))
    period = 4 / alpha * mp.acosh(1 / (1 - theta / slenderness))
    damping = float(equivalent_damping(block.restitution, rule))
    wanted = displacement(ground, float(period), damping) / (
        float(mp.hypot(height, width)) / 2 * math.cos(slenderness)
    )
    # The loop ends 1e-10 from its angle; the integration is exact to about 1e-8.
    assert float(theta) == pytest.approx(wanted, rel=1e-6)


def test_loop_that_reaches_the_critical_angle_overturns_and_a_weak_motion_does_not_rock():
    block = rk.Block(3.0, 0.8)
    assert design_angle(PULSE.scaled(pga=50.0), block) == math.inf
    assert design_angle(rk.GroundMotion([0.0, 0.0], step=0.01), block) == 0.0


def test_loop_that_does_not_converge_has_no_angle():
    strong = rk.example_ground_motion().scaled(pga=0.6 * 9.80665)
    assert math.isnan(design_angle(strong, rk.Block(2.0, 0.5)))


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0, 3.0])
def test_rule_of_the_half_sine_lies_above_the_exact_amplitude(ratio):
    """The exact one is 1/sin ψ with W sin ψ − cos ψ = exp(−(π − ψ)/W); the rule exceeds it by less than an eighth."""
    with mp.workdps(20):
        w = mp.mpf(ratio)
        psi = mp.findroot(
            lambda p: w * mp.sin(p) - mp.cos(p) - mp.exp(-(mp.pi - p) / w),
            (mp.mpf("0.4"), mp.mpf("1.2")),
            "illinois",
        )
        exact = 1 / mp.sin(psi)
    rule = pulse_overturning_rule("half-sine", ratio)
    assert rule == 1 + ratio / 2
    assert exact < rule < 1.14 * exact


@pytest.mark.parametrize(("kind", "slope"), [("half-sine", 2), ("one-sine", 6), ("one-cosine", 4)])
def test_rule_is_one_plus_a_part_of_the_frequency(kind, slope):
    found = pulse_overturning_rule(kind, np.array([0.0, 1.5, 3.0]))
    assert found.tolist() == [1.0, 1.0 + 1.5 / slope, 1.0 + 3.0 / slope]


@pytest.mark.parametrize(
    "block", [rk.Block(4.0, 1.0), rk.Block(2.0, 0.6), rk.Block(2.0, 0.5, inertia_ratio=1.2)]
)
def test_velocity_of_ishiyama_overturns_as_a_step(block):
    """The full block under a short push with that velocity overturns, and under one with 0.1 % less it does not."""
    pga, pgv = ishiyama_levels(block)
    assert pga == pytest.approx(9.80665 * block.width / block.height, rel=1e-14)
    if block.inertia_ratio == 4 / 3:
        a = block.critical_angle
        known = math.sqrt(8 * 9.80665 * block.radius * (1 - math.cos(a)) / (3 * math.cos(a) ** 2))
        assert pgv == pytest.approx(0.4 * known, rel=1e-12)
    seconds, step = 1e-5, pgv / 0.4

    def outcome(velocity):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", rk.InputWarning)  # of the acceleration
            push = rk.GroundMotion(np.full(2, velocity / seconds), step=seconds)
        return rk.simulate(block.system(push), record="none").outcome

    # while it lasts, gravity takes g tan α
    lost = pga * seconds / step
    assert lost < 1e-4
    assert outcome(1.001 * step) == "overturned"
    assert outcome(0.999 * step) != "overturned"


@pytest.mark.long
def test_velocity_of_ishiyama_is_a_fractile_and_no_bound():
    """The figures of the documentation: 60 synthetic records, lowest overturning PGV over v₀."""
    records, lowest = rk.synthetic_ground_motions(60, seed=1), {}
    for height, width in ((4.0, 1.0), (2.0, 0.5)):
        block = rk.Block(height, width)
        step = ishiyama_levels(block)[1] / 0.4
        levels = np.linspace(0.15, 3.0, 286) * step
        lowest[height] = rk.overturning_set(records, block, levels, intensity="pgv").lowest / step
    tall, low = lowest.values()
    assert (np.sum(tall < 0.4), np.sum(low < 0.4)) == (3, 0)
    assert (tall.min(), low.min()) == pytest.approx((0.376, 0.410), abs=5e-4)
    assert [round(float(np.nanmedian(each)), 1) for each in (tall, low)] == [0.6, 0.6]


def top_displacement(block, angle):
    """Sideways displacement of the upper corner, by its two places."""
    turned = block.critical_angle * (1.0 - np.asarray(angle))
    return 2.0 * block.radius * (math.sin(block.critical_angle) - np.sin(turned))


def test_blocks_of_equal_displacement():
    small, large = rk.Block(2.0, 0.4), rk.Block(5.0, 1.0)
    angles = np.linspace(0.0, 1.0, 11)
    found = equal_displacement_angle(angles, small, large)
    assert top_displacement(large, found) == pytest.approx(
        top_displacement(small, angles), rel=1e-12, abs=1e-15
    )
    assert equal_displacement_angle(found[:-1], large, small) == pytest.approx(
        angles[:-1], rel=1e-12, abs=1e-14
    )
    # the displacement of the small block on its critical angle is its width
    edge = 1.0 - math.asin(math.sin(large.critical_angle) * 0.6) / large.critical_angle
    assert math.isinf(equal_displacement_angle(edge + 1e-9, large, small))
    assert equal_displacement_angle(edge - 1e-9, large, small) == pytest.approx(1.0, abs=1e-8)
    assert equal_displacement_angle(0.3, small, small) == 0.3


def test_equal_displacement_holds_for_the_median_of_records():
    """The figures of the documentation: ratio of the displacements of two sizes under 60 synthetic records."""
    records, slope = rk.synthetic_ground_motions(60, seed=1), math.atan(0.2)

    def ratios(radius, level):
        """Return the ratios for records under which both stand, and the number that overturns the smaller block."""
        blocks = [rk.Block(2 * R * math.cos(slope), 2 * R * math.sin(slope)) for R in (radius, 2 * radius)]
        peaks = [
            rk.incremental_dynamic_analysis(records, block, [1.0, level], intensity="pga-ratio")
            .dataset.peak.sel(level=level)
            .values
            for block in blocks
        ]
        stand = np.isfinite(peaks[0]) & np.isfinite(peaks[1]) & (peaks[0] > 0.0)
        small, large = (
            top_displacement(block, peak[stand]) for block, peak in zip(blocks, peaks, strict=True)
        )
        return large / small, int(np.isinf(peaks[0]).sum())

    moderate, few = ratios(4.0, 2.0)
    assert few == 1
    assert np.median(moderate) == pytest.approx(0.97, abs=0.005)
    assert np.quantile(moderate, [0.16, 0.84]) == pytest.approx([0.60, 1.18], abs=0.01)
    strong, many = ratios(2.0, 3.0)
    assert (many, strong.size) == (47, 12)
    assert np.median(strong) == pytest.approx(1.45, abs=0.01)


REFUSED = {
    "unsymmetric block of Ishiyama": (
        lambda: ishiyama_levels(rk.Block(2.0, 0.5, offset=0.05)),
        ValueError,
        "block must be symmetric; got ",
    ),
    "other slenderness": (
        lambda: equal_displacement_angle(0.5, rk.Block(2.0, 0.5), rk.Block(2.0, 0.4)),
        ValueError,
        "other must have the slenderness of the block, 14.0362°; got 11.3099°",
    ),
    "unsymmetric other block": (
        lambda: equal_displacement_angle(0.5, rk.Block(2.0, 0.5), rk.Block(2.0, 0.5, offset=0.05)),
        ValueError,
        "other must be symmetric; got ",
    ),
    "angle of equal displacement": (
        lambda: equal_displacement_angle(1.5, rk.Block(2.0, 0.5), rk.Block(4.0, 1.0)),
        ValueError,
        "angle must lie in [0, 1]; got 1.5",
    ),
    "mass": (
        lambda: rocking_frame(2.0, 0.5, -1.0),
        ValueError,
        "mass_ratio must lie in [0, 1e+06]; got -1.0",
    ),
    "squat columns": (
        lambda: rocking_frame(1.0, 2.0, 5.0),
        ValueError,
        "restitution must lie in [0, 1]; got -",
    ),
    "fraction": (lambda: contact_restitution(0.2, 1.5), ValueError, "fraction must lie in [0, 1]; got 1.5"),
    "angle": (
        lambda: contact_restitution(2.0, 1.0),
        ValueError,
        "critical_angle must lie in [0, 1.5708]; got 2.0",
    ),
    "squat": (
        lambda: contact_restitution([0.1, 1.2], 1.0),
        ValueError,
        "critical_angle must give a restitution that is not negative; got 1.2 (the block is too squat to rock on)",
    ),
    "rule": (
        lambda: equivalent_damping(0.9, "fema"),
        ValueError,
        "rule must be one of 'fema-356', 'priestley'; got 'fema'",
    ),
    "restitution": (lambda: equivalent_damping(1.1), ValueError, "restitution must lie in [0, 1]; got 1.1"),
    "ground": (
        lambda: design_angle(1.0, rk.Block(2.0, 0.5)),
        TypeError,
        "ground must be a GroundMotion; got 1.0",
    ),
    "block": (lambda: design_angle(PULSE, 1.0), TypeError, "block must be a Block; got 1.0"),
    "start": (
        lambda: design_angle(PULSE, rk.Block(2.0, 0.5), start=1.0),
        ValueError,
        "start must lie in [0.001, 0.999]; got 1.0",
    ),
    "damping": (
        lambda: design_angle(PULSE, rk.Block(2.0, 0.5, restitution=0.1), "priestley"),
        ValueError,
        "β must lie in [0, 0.99]; got 1.5",
    ),
    "kind": (
        lambda: pulse_overturning_rule("ricker", 1.0),
        ValueError,
        "kind must be one of 'half-sine', 'one-sine', ",
    ),
    "frequency": (
        lambda: pulse_overturning_rule("one-sine", 3.5),
        ValueError,
        "frequency must lie in [0, 3]; got 3.5",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_argument_outside_its_range_is_refused_in_one_line(case):
    call, error, message = REFUSED[case]
    with pytest.raises(error, match=f"^{re.escape(message)}"):
        call()
