"""Base reactions, impulses and the slender range, against the geometry of a rigid rectangle."""

import math
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest

from oracles import reactions
from rocking import Block, Braces, Harmonic, PiecewiseLinear, Pulse, State, System, simulate
from rocking.motion.model_warnings import block_warnings
from rocking.motion.validity import base_reaction, impact_friction

GRAVITY = 9.80665
TALL = Block(height=2.0, width=0.3)
STOCKY = Block(height=1.5, width=0.35)
SQUAT = Block(height=1.0, width=0.6, restitution=0.7)
HOLLOW = Block(height=3.0, width=0.9, inertia_ratio=1.6)

CASES = {
    "(1,1), tall block": (2.0, 1.0, 0.925, TALL),
    "(1,3), stocky block": (6.5, 0.4, 0.925, STOCKY),
    "chaotic, hollow block": (10.103037, 1.721328, 0.8, HOLLOW),
    "slow shaking, chatter and rest": (1.1, 3.0, 0.5, TALL),
}


def run(amplitude, period, restitution, cycles=12, start=None, braces=None):
    system = System(Harmonic(amplitude=amplitude, period=period), restitution=restitution, braces=braces)
    return simulate(system, start or State(), cycles=cycles)


def centre(block, angle, height=0):
    """Centre of mass of the rectangle turned by `angle` (clockwise) about its right corner, or its left one for `angle` < 0.

    The base corners lie at ±B/2 and height 0 before; a point (x, y) relative to the pivot turns to (x cos + y sin, y cos − x sin).
    """
    pivot = mp.mpf(block.width) / 2 * (1 if angle > 0 else -1)
    x, y = -pivot, mp.mpf(block.height) / 2
    return pivot + x * mp.cos(angle) + y * mp.sin(angle), y * mp.cos(angle) - x * mp.sin(angle)


def flights(motion, thin):
    """Return (start, end, side, Θ') of some arcs between two impacts at Θ = 0."""
    events = motion.events
    inner = [
        (before, after)
        for before, after in pairwise(events)
        if before["kind"] == after["kind"] == "impact" and after["time"] - before["time"] > 1e-3
    ]
    return [(b["time"], a["time"], math.copysign(1, b["after"]), b["after"]) for b, a in thin(inner, 8)]


def reactions_from_positions(motion, block, begun, side, velocity, time):
    """Return (H/Mg, N/Mg) from second differences of the centre's position, to 20 digits. Eq. (5) gives only the angle."""
    with mp.workdps(60):
        forcing = motion.system.forcing
        frequency, begun = mp.mpf(forcing.frequency), mp.mpf(begun)
        rate = mp.sqrt(
            mp.mpf(GRAVITY) / (mp.mpf(block.inertia_ratio) * mp.hypot(block.height, block.width) / 2)
        )
        critical = mp.atan2(block.width, block.height)
        psi = frequency * begun + mp.mpf(forcing.phase)
        beta = side * mp.mpf(forcing.amplitude) / (1 + frequency**2)

        def place(seconds):
            t = rate * seconds - begun
            wave = (
                mp.cos(psi + frequency * t) - mp.cos(psi) * mp.cosh(t) + frequency * mp.sin(psi) * mp.sinh(t)
            )
            height = side * velocity * mp.sinh(t) - (mp.cosh(t) - 1) + beta * wave
            return centre(block, critical * side * height)

        now, step = mp.mpf(time) / rate, mp.mpf(10) ** -15
        earlier, here, later = place(now - step), place(now), place(now + step)
        x, y = ((a - 2 * b + c) / step**2 for a, b, c in zip(earlier, here, later, strict=True))
        push = (
            GRAVITY * critical * mp.mpf(forcing.amplitude) * mp.cos(frequency * mp.mpf(time) + forcing.phase)
        )
        return float((push + x) / GRAVITY), float((GRAVITY + y) / GRAVITY)


@pytest.mark.parametrize("case", CASES)
def test_base_reaction_is_mass_times_acceleration_of_the_centre_placed_by_geometry(case, thin):
    amplitude, period, restitution, block = CASES[case]
    motion = run(amplitude, period, restitution)
    compared = 0
    for begun, ended, side, velocity in flights(motion, thin):
        times = begun + (ended - begun) * np.array([0.02, 0.3, 0.7, 0.98])
        sideways, upward = base_reaction(motion, block, times, np.full(times.shape, side))
        for time, *ours in zip(times, sideways, upward, strict=True):
            exact = reactions_from_positions(motion, block, begun, side, velocity, time)
            # a state wrong by 1e-14 and a time by half an ulp move the reaction by amplitude times frequency times that
            np.testing.assert_allclose(
                ours, exact, rtol=0, atol=1e-13 * max(1, amplitude * 2 * math.pi / period)
            )
            compared += 1
    assert compared >= 8


FAMILIES = {
    "harmonic": 250,
    "harmonic, braces": 150,
    "harmonic, full": 150,
    "harmonic, full, table": 150,
    "harmonic, full, table, braces": 50,
    "record": 75,
    "record, full": 75,
    "pulse": 50,
    "pulse, full": 50,
}
"""Random motions of each family whose extremes are compared with a dense scan: 1,000 in all."""


def base_motion(family, rng):
    """Return a random base motion, and the same for the oracle."""
    if family.startswith("harmonic"):
        amplitude, period, phase = rng.uniform(0.2, 8), math.exp(rng.uniform(-1.2, 1.3)), rng.uniform(-3, 3)
        base = Harmonic(amplitude=amplitude, period=period, phase=phase)
        return base, reactions.Cosine(amplitude, 2 * math.pi / period, phase)
    if family.startswith("record"):
        smooth = np.hanning(rng.integers(3, 12))
        values = np.convolve(rng.normal(size=rng.integers(60, 250)), smooth / np.linalg.norm(smooth))
        step, scale = math.exp(rng.uniform(-3.5, -1.2)), rng.uniform(0.5, 2.5)
        return PiecewiseLinear(values, step=step, scale=scale), reactions.Lines(scale * values, step)
    kind = str(
        rng.choice(("half-sine", "one-sine", "one-cosine", "rectangular", "triangular", "trapezoidal"))
    )
    amplitude, duration = rng.uniform(1.1, 4) * rng.choice((-1, 1)), math.exp(rng.uniform(-1, 1.2))
    pulse = Pulse(kind, amplitude=amplitude, duration=duration)
    if "ine" in kind:
        turns, phase = {"half-sine": (0.5, -1), "one-sine": (1, -1), "one-cosine": (1, 0)}[kind]
        rate = 2 * math.pi * turns / duration
        return pulse, reactions.Cosine(amplitude, rate, phase * math.pi / 2, duration)
    form = {"rectangular": [1, 1], "triangular": [0, 1, 0], "trapezoidal": [0, 1, 1, 1, 0]}[kind]
    return pulse, reactions.Lines(amplitude * np.array(form), duration / (len(form) - 1))


def drawn(family, number):
    """Return a random motion, its block, and both as the oracle has them."""
    rng = np.random.default_rng((list(FAMILIES).index(family), number))
    base, same = base_motion(family, rng)
    block = Block(height=2.0, width=2 * math.tan(rng.uniform(0.06, 0.5)), inertia_ratio=rng.uniform(1.1, 1.8))
    e, full = rng.uniform(0, 1) ** 0.3, "full" in family
    table = (
        [(0.1, rng.uniform(0.5, 1)), (rng.uniform(0.2, 1.5), rng.uniform(0.2, 1))]
        if "table" in family
        else []
    )
    braces = Braces(rng.uniform(0.2, 1.5), rng.uniform(0, 1)) if "braces" in family else None
    system = System(base, e, braces, block.critical_angle if full else None, table)
    start = State()
    if rng.uniform() < 0.5:
        start = State(rng.uniform(-0.9, 0.9) * (braces.angle if braces else 1), rng.uniform(-0.5, 0.5))
    length = {"cycles": int(rng.integers(3, 20))}
    if not family.startswith("harmonic"):
        length = {"duration": base.span + rng.uniform(0.5, 4)}
    motion = simulate(system, start, **length)
    rock = reactions.Rocking(block.critical_angle, block.inertia_ratio, full, ((0.0, e), *table))
    until = motion.duration if motion.overturning is None else motion.overturning.time
    events = [tuple(row[["time", "kind", "angle", "before", "after"]].item()) for row in motion.events]
    return motion, block, rock, reactions.followed(rock, same, (start.angle, start.velocity), events, until)


def differences(family, number):
    """Return the differences of friction, base reaction and angle from a dense scan; a friction above 1 as 1/friction."""
    motion, block, *same = drawn(family, number)
    found, exact = motion.validity(block), reactions.extremes(*same)
    if found.reaction is None:
        assert exact.reaction == math.inf
        return np.array([0, 0, found.angle - exact.angle])
    needed, expected = (value if value < 1 else 2 - 1 / value for value in (found.friction, exact.friction))
    return np.array([needed - expected, found.reaction - exact.reaction, found.angle - exact.angle])


STEP_S = 1e-5
"""Step of the samples in s between which the first lack of friction is sought."""


@pytest.mark.parametrize("family", FAMILIES)
def test_first_lack_of_friction_is_that_of_dense_samples(family):
    sought = 0
    for number in range(7):
        motion, block, rock, followed = drawn(family, number)
        needed = motion.validity(block).friction
        if needed is None or needed < 2e-3:
            continue
        needed = min(needed, 5.0)
        if needed < 5.0:
            assert motion.validity(block, friction=needed).slides_from is None
        for share in (0.3, 0.8, 1 - 1e-6, 1 + 1e-6):
            friction = share * needed
            found = motion.validity(block, friction=friction)
            expected = reactions.first_slip(rock, followed, friction, block.time(seconds=STEP_S))
            if expected == math.inf:
                assert found.slides_from is None, (number, share)
                assert not found.refusal
            else:
                assert found.slides_from == pytest.approx(expected, abs=1e-9), (number, share)
            sought += 1
    assert sought >= 16


@pytest.mark.parametrize("family", FAMILIES)
def test_friction_reaction_and_angle_are_those_of_a_dense_scan(family):
    for number in range(6):
        np.testing.assert_allclose(
            differences(family, number), 0, rtol=0, atol=1e-9, err_msg=f"motion {number}"
        )


@pytest.mark.long
@pytest.mark.timeout(3600)
def test_friction_reaction_and_angle_of_a_thousand_motions_are_those_of_a_dense_scan():
    for family, count in FAMILIES.items():
        found = np.array([differences(family, number) for number in range(count)])
        print(f"{family}: {count} motions, largest differences {np.abs(found).max(axis=0)}")
        np.testing.assert_allclose(found, 0, rtol=0, atol=1e-9, err_msg=family)


def impulse(block, restitution, before=-1.0):
    """Horizontal and vertical impulse on a block of unit mass at Θ = 0, and where on the base it acts.

    From the momentum of the centre, whose velocity is that of its position, and the moment about it. The place is −1 at
    the corner about which the block turned until then, 1 at the one that is hit.
    """
    after, step = restitution * before, mp.mpf(10) ** -20
    with mp.workdps(50):
        right, left = centre(block, step), centre(block, -step)
        here = (mp.mpf(0), mp.mpf(block.height) / 2)
        arriving = [before * (there - now) / step for there, now in zip(right, here, strict=True)]
        leaving = [after * (now - there) / step for there, now in zip(left, here, strict=True)]
        across, up = (b - a for a, b in zip(arriving, leaving, strict=True))
        radius = mp.hypot(block.height, block.width) / 2
        spin = (mp.mpf(block.inertia_ratio) - 1) * radius**2 * (after - before)
        # clockwise moment of an impulse (across, up) at (p, −H/2) from the centre: −(H/2) across − p up
        place = -(spin + mp.mpf(block.height) / 2 * across) / up
        return float(across), float(up), float(-place / (mp.mpf(block.width) / 2))


@pytest.mark.parametrize("block", [TALL, SQUAT, HOLLOW], ids=["tall", "squat", "hollow"])
@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.925, 1.0])
def test_friction_of_an_impact_is_that_of_the_impulse_that_reverses_the_centre(block, restitution):
    motion = run(2.0, 1.0, restitution, cycles=4)
    across, up, _ = impulse(block, restitution)
    assert up > 0
    needed, when = impact_friction(motion, block)
    assert -needed == pytest.approx(abs(across) / up, rel=1e-14, abs=1e-15)
    assert when == motion.events["time"][motion.events["kind"] == "impact"][0]


@pytest.mark.parametrize(
    "block", [TALL, HOLLOW, Block(height=1.0, width=0.6)], ids=["tall", "hollow", "squat"]
)
def test_housner_restitution_puts_the_impulse_at_the_corner_that_is_hit_and_less_puts_it_outside(block):
    assert impulse(block, block.housner_restitution)[2] == pytest.approx(1, abs=1e-13)
    for change, inside in ((1e-3, True), (-1e-3, False)):
        restitution = block.housner_restitution + change
        assert (impulse(block, restitution)[2] < 1) is inside
        warned = any("Housner" in warning for warning in run(2.0, 1.0, restitution).validity(block).warnings)
        assert warned is not inside


def test_impact_governs_a_slender_block_with_little_restitution():
    found = run(2.0, 1.0, 0.5).validity(TALL)
    assert found.friction_source == "impact"
    assert found.friction == pytest.approx(0.5 / 1.5 / (0.3 / 2.0), rel=1e-14, abs=0)
    assert any("coefficient of friction" in warning for warning in found.warnings)


def test_block_that_never_moves_needs_only_the_friction_of_rest():
    found = run(0.7, 1.0, 0.9, cycles=3).validity(TALL)
    assert (found.friction_source, found.friction_time) == ("rest", 0.0)
    assert found.friction == pytest.approx(0.7 * math.atan(0.15), rel=1e-15, abs=0)
    assert (found.reaction, found.angle, found.warnings) == (1.0, 0.0, ())


def test_friction_of_rest_is_sought_only_while_the_block_rests():
    motion = run(1.3, 6.0, 0.0, cycles=6)
    assert (motion.events["kind"] == "rest").any()
    assert motion.validity(TALL).friction >= 0.999 * TALL.critical_angle


def test_free_block_released_at_an_angle_needs_the_friction_of_its_release():
    """At the release, A = 0: H/Mg = cos δ θ''/k and N/Mg = 1 + sin δ θ''/k with θ'' = −δ (in units of α²), k = Io/MR²."""
    block = Block(height=2.0, width=1.9, restitution=1.0)
    found = run(0.0, 1.0, 1.0, start=State(angle=0.9), cycles=3).validity(block)
    lean = np.linspace(0.1, 1, 100_001) * block.critical_angle
    speed = np.sqrt(lean**2 - (0.1 * block.critical_angle) ** 2)
    upward = 1 - (lean * np.sin(lean) + speed**2 * np.cos(lean)) / block.inertia_ratio
    sideways = (-lean * np.cos(lean) + speed**2 * np.sin(lean)) / block.inertia_ratio
    assert found.reaction == pytest.approx(upward.min(), abs=1e-9)
    assert found.friction == pytest.approx(np.max(np.abs(sideways) / upward), abs=1e-9)
    assert found.angle == pytest.approx(0.9 * block.critical_angle, rel=1e-14, abs=0)


def test_base_that_would_have_to_pull_makes_every_friction_too_small():
    found = run(15.0, 2.0, 0.925, braces=Braces(angle=1.0)).validity(
        Block(height=1.0, width=0.6, restitution=0.9)
    )
    assert found.reaction < 0
    assert (found.friction, found.friction_time) == (math.inf, found.reaction_time)
    assert any("pull" in warning for warning in found.warnings)


def test_brace_hits_and_leaning_are_left_out_and_named():
    found = run(15.0, 2.0, 0.925, braces=Braces(angle=1.0)).validity(TALL)
    assert any("brace impacts" in warning for warning in found.warnings)
    leaning = run(20.0, 3.0, 0.9, braces=Braces(angle=0.4, restitution=0.0), cycles=4)
    assert (leaning.events["kind"] == "lean").any()
    events = leaning.events
    ended = np.append(events["time"][1:], leaning.duration)
    share = np.sum((ended - events["time"])[events["kind"] == "lean"]) / leaning.duration
    assert any(
        f"contact with a brace: {share:.1%} of the time" in warning
        for warning in leaning.validity(TALL).warnings
    )


@pytest.mark.parametrize(("angle", "warned"), [(0.5, False), (3.0, False), (4.0, True)])
def test_slender_range_is_left_by_large_angles_with_the_error_named(angle, warned):
    """θcr = 0.149: restoring moment and push are computed with sin δ ≈ δ and cos δ ≈ 1, δ = θcr − |θ|."""
    motion = run(0.0, 1.0, 0.9, start=State(angle=angle), cycles=1, braces=Braces(angle=angle))
    found = motion.validity(TALL)
    lean = TALL.critical_angle - np.linspace(0, found.angle, 1001)
    lean[lean == 0] = np.nan
    moment, push = np.nanmax(lean / np.sin(lean) - 1), np.nanmax(1 / np.cos(lean) - 1)
    assert (found.moment_error, found.forcing_error) == pytest.approx((moment, push), rel=1e-9)
    sentences = [warning for warning in found.warnings if "slender" in warning]
    assert bool(sentences) is warned
    assert all(f"{push:.1%}" in sentence for sentence in sentences)


def test_overturning_motion_is_judged_up_to_its_proof():
    motion = run(1.75, 2.0, 0.95, cycles=50)
    found = motion.validity(TALL)
    assert motion.overturning is not None
    assert max(found.reaction_time, found.friction_time) <= found.until == motion.overturning.time
    assert 0 < found.friction < math.inf
    assert str(found).startswith(f"assessed up to τ = {found.until:.6g}, where overturning is proved\n")


@pytest.mark.parametrize(
    ("braces", "why"),
    [
        (None, "overturning is certain from the start"),
        (Braces(angle=1.2), "contact with a brace: 100.0% of the time"),
    ],
    ids=["falls", "leans"],
)
def test_block_past_balance_on_a_still_base_is_not_judged_says_so_and_warns(braces, why):
    found = run(0.0, 1.0, 0.9, start=State(angle=1.2), braces=braces).validity(TALL)
    assert found.friction is found.friction_source is found.friction_time is None
    assert found.reaction is found.reaction_time is None
    assert (
        "least coefficient of friction without sliding: not assessed\nleast base reaction: not assessed\n"
        in str(found)
    )
    assert any(why in warning for warning in found.warnings)


def test_slender_range_far_beyond_a_right_angle_is_named_without_a_number():
    found = run(0.0, 1.0, 0.9, start=State(angle=900.0)).validity(TALL)
    assert found.moment_error == found.forcing_error == math.inf
    assert "inf" not in str(found)
    assert any("beyond 90°" in warning for warning in found.warnings)


@pytest.mark.parametrize("other", [1, System(Harmonic(1.0, period=1.0), restitution=0.9)])
def test_what_is_no_block_is_refused(other):
    with pytest.raises(TypeError, match="^block must be a Block; got "):
        run(2.0, 1.0, 0.9, cycles=1).validity(other)


def test_report_reads_as_lines_and_an_unrecorded_motion_is_refused():
    system = System(Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    text = str(simulate(system, cycles=5).validity(SQUAT))
    assert text.splitlines()[0].startswith("least coefficient of friction without sliding: 0.")
    assert "warning: outside the slender range" in text
    with pytest.raises(ValueError, match="record must be 'all'"):
        simulate(system, cycles=5, record="none").validity(TALL)


@pytest.mark.parametrize("block", [TALL, SQUAT, Block(height=1.8, width=0.6)], ids=["tall", "squat", "1:3"])
def test_acceleration_that_lifts_only_the_model_is_warned_of(block):
    """A standing block turns about its corner once a_x H/2 > g B/2; the model has it lift from A = 1 on."""
    truth = block.amplitude(GRAVITY * block.width / block.height)
    assert truth > 1.0
    for amplitude in (0.99, (1.0 + truth) / 2, truth * 1.0001):
        system = System(Harmonic(amplitude=amplitude, period=1.0), restitution=block.restitution)
        said = [text for text in simulate(system, cycles=3).validity(block).warnings if "lift-off" in text]
        assert bool(said) is (1.0 < amplitude < truth)
    among = [0.5, 1.0, (1.0 + truth) / 2, 3.0]
    assert any("1 of the 4 accelerations lie between" in text for text in block_warnings(block, among))


def test_what_concerns_the_block_is_said_without_a_motion_as_with_one():
    moving = run(2.0, 1.0, 0.7).validity(SQUAT)
    alone = list(block_warnings(SQUAT, 2.0, 0.5))
    assert (
        f"{moving.moment_error:.1%}, that of the base acceleration by up to {moving.forcing_error:.1%}"
        in alone[0]
    )
    assert any("less than Housner's" in text for text in alone)
    assert not list(block_warnings(TALL, 2.0, 1.0))


@pytest.mark.filterwarnings("ignore:height 190 m")
def test_height_of_a_tower_is_a_warning_with_either_equation_of_motion():
    tower = Block(height=190.0, width=55.0)
    said = "height 190 m is unusual: sizes are in metres"
    assert said in list(block_warnings(tower, 2.0))
    assert list(block_warnings(Block(height=190.0, width=90.0), 1.01, full=True)) == [said]
    assert not list(block_warnings(Block(height=30.0, width=8.0), 2.0))
    for model in ("slender", "full"):
        system = tower.system(acceleration=1.0, frequency_hz=1.0, model=model)
        assert said in simulate(system, cycles=2).validity(tower).warnings


def test_report_has_seconds_and_degrees_and_says_where_no_friction_would_do():
    motion = run(2.0, 1.0, 0.925)
    found = motion.validity(TALL)
    assert f"{math.degrees(found.angle):.4g}°, {motion.peak:.4g} of the critical angle" in str(found)
    for time in (found.friction_time, found.reaction_time):
        assert f"t = {TALL.seconds(time):.4g} s, τ = {time:.6g})" in str(found)
    jumping = run(15.0, 2.0, 0.925, braces=Braces(angle=1.0)).validity(Block(height=1.0, width=0.9))
    assert jumping.friction == math.inf
    assert "none suffices, because the base reaction vanishes (motion, t = " in str(jumping)
