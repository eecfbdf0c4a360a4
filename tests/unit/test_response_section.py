"""The impact section contains all impacts at Θ = 0, in order, and each follows from the one before."""

import math
import tracemalloc

import numpy as np
import pytest

import rocking as rk

CHAOTIC = rk.System(rk.Harmonic(amplitude=2.0, period=0.4), restitution=1.0)
BRACED = rk.System(
    rk.Harmonic(amplitude=15.0, period=2.0, phase=0.3), restitution=0.925, braces=rk.Braces(angle=1.0)
)
MODE = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
RESTING = rk.System(rk.Harmonic(amplitude=1.045, period=1.0), restitution=0.5)
FIELDS = ["time", "cycle", "phase", "before", "after"]


@pytest.mark.parametrize(
    "system", [CHAOTIC, BRACED, MODE, RESTING], ids=["chaotic", "braced", "periodic", "resting"]
)
@pytest.mark.parametrize("transient", [0, 57])
def test_impacts_are_those_of_the_motion_to_the_last_bit(system, transient):
    motion = rk.simulate(system, rk.State(velocity=0.01), cycles=400)
    of_system = rk.impact_section(system, rk.State(velocity=0.01), cycles=400, transient=transient)
    events = motion.events[(motion.events["kind"] == "impact") & (motion.events["cycle"] >= transient)]
    np.testing.assert_array_equal(of_system, rk.impact_section(motion, transient=transient))
    assert list(of_system.dtype.names) == FIELDS
    for name in FIELDS:
        np.testing.assert_array_equal(of_system[name], events[name])
    assert transient or len(of_system) == motion.impacts
    assert ("rest" in motion.events["kind"]) == (system is RESTING)


def test_each_impact_follows_from_the_one_before_by_the_closed_form():
    """Eq. (5): from (0, v) at phase ψ the angle is zero again, and the speed that before the impact, when the next comes."""
    impacts = rk.impact_section(CHAOTIC, rk.State(velocity=0.01), cycles=300)
    forcing, a, b = CHAOTIC.forcing, impacts[:-1], impacts[1:]
    side, t, beta = np.sign(a["after"]), np.diff(impacts["time"]), 2.0 / (1 + forcing.frequency**2)
    c, s, omega = np.cos(a["phase"]), np.sin(a["phase"]), forcing.frequency
    after, sinh, cosh = np.abs(a["after"]), np.sinh(t), np.cosh(t)
    later = a["phase"] + omega * t
    angle = after * sinh - (cosh - 1) + side * beta * (np.cos(later) - c * cosh + omega * s * sinh)
    velocity = after * cosh - sinh + side * beta * (-omega * np.sin(later) - c * sinh + omega * s * cosh)
    # at τ = 120 an ulp of the time moves the phase by 2e-13
    np.testing.assert_allclose(angle, 0.0, atol=1e-12)
    np.testing.assert_allclose(side * velocity, b["before"], atol=1e-11)
    np.testing.assert_allclose(np.cos(later - b["phase"]), 1.0, atol=1e-12)


def test_every_impact_turns_the_velocity_by_e_and_no_more():
    impacts = rk.impact_section(BRACED, cycles=500)
    # the block passes through Θ = 0: the sign stays
    np.testing.assert_allclose(impacts["after"], 0.925 * impacts["before"], rtol=1e-15)


def test_mode_1_1_strikes_at_its_two_points():
    """Closed form of A = 2, T = 1, e = .925: V = .5320172278868 at φ = −1.6779140886924, and half a cycle later."""
    impacts = rk.impact_section(MODE, cycles=2_000, transient=1_990)
    assert len(impacts) == 20
    np.testing.assert_allclose(np.abs(impacts["after"]), 0.5320172278868, atol=1e-12)
    phase = np.where(impacts["after"] > 0, -1.6779140886924, math.pi - 1.6779140886924)
    np.testing.assert_allclose(impacts["phase"], phase % (2 * math.pi), atol=1e-12)


def test_free_rocking_loses_e_at_each_impact():
    """Housner: speed² before the first is 1 − (1 − Θ₀)², and every impact leaves e of its speed to the next."""
    free = rk.System(rk.Harmonic(amplitude=0.0, period=1.0), restitution=0.8)
    impacts = rk.impact_section(free, rk.State(angle=0.5), cycles=8)
    speeds = math.sqrt(0.75) * 0.8 ** np.arange(5)
    np.testing.assert_allclose(np.abs(impacts["before"][:5]), speeds, rtol=1e-14)


def test_usual_length_is_a_thousand_cycles_from_rest():
    np.testing.assert_array_equal(rk.impact_section(MODE), rk.impact_section(MODE, rk.State(), 1_000))


@pytest.mark.long
def test_memory_grows_with_the_impacts_kept_only():
    def peak(cycles, transient):
        tracemalloc.start()
        kept = rk.impact_section(MODE, cycles=cycles, transient=transient)
        size = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return len(kept), size

    rk.impact_section(MODE)
    (few, small), (as_few, long) = peak(1_000_000, 999_990), peak(2_000_000, 1_999_990)
    # the buffer of a breath is 64 MB, its events 80; recorded whole, the longer run is 570
    assert few == as_few == 20
    assert long < 1.2 * small < 4e8


def test_nothing_strikes_between_the_braces_or_at_rest():
    braces = rk.Braces(angle=1.5, restitution=1.0)
    beyond = rk.System(rk.Harmonic(amplitude=0.1, period=1.0), restitution=0.9, braces=braces)
    assert rk.simulate(beyond, rk.State(angle=1.3), cycles=50).brace_hits > 10
    assert len(rk.impact_section(beyond, rk.State(angle=1.3), cycles=50)) == 0
    still = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9)
    assert len(rk.impact_section(still)) == 0


def test_overturning_block_has_its_impacts_before_the_proof():
    falling = rk.System(rk.Harmonic(amplitude=1.75, period=2.0), restitution=0.95)
    assert len(rk.impact_section(falling, cycles=50)) == 4


@pytest.mark.parametrize(
    ("how", "message"),
    [
        ({"source": 3}, r"^source must be a System or a Motion; got 3$"),
        ({"cycles": 2.5}, r"^cycles must be a whole number in \[1, 1000000000\]; got 2.5$"),
        ({"cycles": 10, "transient": 10}, r"^transient must be a whole number in \[0, 9\]; got 10$"),
        ({"start": 3}, r"^start must be a State; got 3 "),
        (
            {"source": rk.simulate(MODE, cycles=3), "cycles": 3},
            r"^cycles must be omitted with a motion; got 3$",
        ),
        ({"source": rk.simulate(MODE, cycles=3), "transient": 3}, r"^transient must be .+ \[0, 2\]; got 3$"),
        (
            {"source": rk.simulate(MODE, cycles=3, record="none")},
            r"^record must be 'all' for events,.+'none'$",
        ),
    ],
)
def test_what_makes_no_section_is_refused_in_one_line(how, message):
    with pytest.raises((TypeError, ValueError), match=message):
        rk.impact_section(**{"source": MODE, **how})


@pytest.mark.parametrize("phase", [0.0, 1.0, -2.5, 3.0, 7.0, 100.0])
@pytest.mark.parametrize("record", ["all", "section"])
def test_stroboscopic_section_at_any_phase_is_the_motion_there(phase, record):
    """Every instant τ ≥ 0 of the run with Ωτ + φ ≡ phase (mod 2π), by count and by state."""
    forcing = rk.Harmonic(amplitude=2.0, period=0.4, phase=0.7)
    system = rk.System(forcing, restitution=1.0)
    motion = rk.simulate(system, rk.State(velocity=0.02), cycles=60)
    first = math.fmod(phase - 0.7, 2 * math.pi) / forcing.frequency % 0.4
    times = first + 0.4 * np.arange(60)
    section = rk.simulate(system, rk.State(velocity=0.02), cycles=60, record=record).section(phase)
    np.testing.assert_allclose(section, np.column_stack(motion.at(times)), atol=1e-10)
    np.testing.assert_allclose(np.cos(forcing.frequency * times + 0.7 - phase), 1.0, atol=1e-12)
