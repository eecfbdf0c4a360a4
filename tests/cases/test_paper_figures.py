"""The motions of Yim & Lin (1991), figures 2–6 and 13a: response types, numbers of impacts, overturning."""

import math

import numpy as np
import pytest

import rocking as rk

SETTLING = 2_000  # cycles after which the damped motions repeat to 1e-10
MAX_FORCING_PERIOD = 64


def _system(amplitude, period, restitution, phase=0.0, braces=None):
    return rk.System(rk.Harmonic(amplitude=amplitude, period=period, phase=phase), restitution, braces)


def _period(section):
    """The least number of cycles after which the last section point comes back to 1e-10."""
    returns = np.abs(section[-1] - section[-2 : -2 - MAX_FORCING_PERIOD : -1]).max(axis=1)
    return int(np.argmax(returns < 1e-10)) + 1 if (returns < 1e-10).any() else None


def _asymmetry(motion, cycles):
    """Return the largest distance of Θ(τ + n T/2) from −Θ(τ) over the last response."""
    length = cycles * motion.system.forcing.period
    times = motion.duration - length * np.linspace(1.0, 0.5, 500)
    early, late = motion.at(times), motion.at(times + length / 2)
    return max(np.abs(np.add(early, late)).max(axis=1))


PERIODIC = {
    "2a, 3a": (_system(2.0, 1.0, 0.925), rk.State(), 1, 2, True),
    "2b, 3b": (_system(6.5, 0.4, 0.925), rk.State(), 3, 2, True),
    "2c, 3c": (_system(5.5, 0.5, 0.925, phase=1.8), rk.State(velocity=0.15), 10, 4, False),
}


@pytest.mark.parametrize(
    ("system", "start", "period", "impacts", "symmetric"), PERIODIC.values(), ids=PERIODIC
)
def test_periodic_responses(system, start, period, impacts, symmetric):
    motion = rk.simulate(system, start, cycles=SETTLING)
    assert motion.outcome is rk.Outcome.BOUNDED
    assert _period(motion.section(phase=system.forcing.phase + 0.3)) == period
    responses = 20
    late = motion.events["cycle"] >= SETTLING - responses * period
    assert set(motion.events["kind"][late]) == {"impact"}
    assert (
        abs(int(late.sum()) - responses * impacts) <= 1
    )  # an impact may lie on the instant where the count begins
    asymmetry = _asymmetry(motion, period)
    assert (asymmetry < 1e-9) if symmetric else (asymmetry > 1e-2)


def test_mode_1_1_strikes_with_the_closed_form_speed_and_phase():
    """Eqs (8)–(10) at A = 2, T = 1, e = .925: V and φ just after an impact onto the positive side."""
    impacts = rk.simulate(_system(2.0, 1.0, 0.925), cycles=SETTLING).events[-2:]
    onto = impacts[impacts["after"] > 0][0]
    assert math.isclose(onto["after"], 0.5320172278868, abs_tol=1e-12)
    assert math.isclose(math.remainder(onto["phase"] + 1.6779140886924, 2 * math.pi), 0.0, abs_tol=1e-12)


def test_mode_1_3_strikes_with_the_closed_form_speed_and_phase():
    impacts = rk.simulate(_system(6.5, 0.4, 0.925), cycles=SETTLING).events[-2:]
    onto = impacts[impacts["after"] > 0][0]
    assert math.isclose(onto["after"], 0.6582529904285, abs_tol=1e-12)
    assert math.isclose(math.remainder(onto["phase"] + 1.8716076665268, 2 * math.pi), 0.0, abs_tol=1e-12)


@pytest.mark.parametrize("record", ["all", "section", "none"])
def test_figure_4_overturns_in_the_sixth_cycle_after_4_impacts(record):
    motion = rk.simulate(_system(1.75, 2.0, 0.95), cycles=50, record=record)
    assert motion.outcome is rk.Outcome.OVERTURNED
    assert (motion.overturning.cycle, motion.overturning.impacts) == (5, 4)
    assert motion.impacts == 4
    assert motion.cycles < 50


CENTRE = np.array([0.0403216219, 0.1926036397])


def _islands(start, cycles):
    """Section points of A = 4, T = .4, e = 1, every third one in a list of its own."""
    section = rk.simulate(_system(4.0, 0.4, 1.0), start, cycles=cycles, record="section").section()
    return [section[first::3] for first in range(3)]


def test_figure_5_from_rest_lies_on_three_closed_curves():
    """Each third of the section stays apart from the others and turns about a point of its own."""
    islands = _islands(rk.State(), 30_000)
    corners = [(points.min(axis=0), points.max(axis=0)) for points in islands]
    for one in range(3):
        low, high = corners[one]
        others = np.concatenate([islands[other] for other in range(3) if other != one])
        assert not ((others > low) & (others < high)).all(axis=1).any()
    turns = np.arctan2(*((islands[1] - CENTRE) / (corners[1][1] - corners[1][0])).T)
    occupied = np.unique(np.floor((turns + math.pi) / (2 * math.pi) * 200))
    assert len(occupied) == 200


def test_figure_5_is_a_curve_not_an_area():
    """At one direction from the centre all section points lie at one distance: chaos would fill a band."""
    points = (_islands(rk.State(), 60_000)[1] - CENTRE) / [0.03, 0.1]
    turns, distances = np.arctan2(points[:, 1], points[:, 0]), np.hypot(points[:, 0], points[:, 1])
    order = np.argsort(turns)
    steps = np.abs(np.diff(distances[order]))
    assert steps.max() < 0.02 * distances.max()


def test_figure_5_turns_about_its_centre_by_the_known_rotation():
    """.4744150886 of a turn every 3 cycles, by a weighted Birkhoff average."""
    points = (_islands(rk.State(), 60_000)[1] - CENTRE) / [0.03, 0.1]
    turns = np.mod(np.diff(np.arctan2(points[:, 1], points[:, 0])), 2 * math.pi)
    place = (np.arange(len(turns)) + 0.5) / len(turns)
    weight = np.exp(-1 / (place * (1 - place)))
    assert math.isclose((weight * turns).sum() / weight.sum() / (2 * math.pi), 0.4744150886, abs_tol=2e-10)


def test_islands_without_loss_hold_for_a_million_cycles():
    """e = 1, started inside: the farthest point of 10⁶ cycles is that of the first 3·10⁴."""
    start = rk.State(angle=CENTRE[0] + 0.0015, velocity=CENTRE[1])
    for points in _islands(start, 1_000_000):
        first = points[:10_000]
        margin = 1e-3 * (first.max(axis=0) - first.min(axis=0))
        assert (points >= first.min(axis=0) - margin).all()
        assert (points <= first.max(axis=0) + margin).all()


@pytest.mark.parametrize(("amplitude", "period"), [(1.0, 1.0), (3.0, 0.8), (2.0, 2.0)])
@pytest.mark.parametrize("off", [0.0, 0.005])
def test_neutrally_stable_1_1_modes_without_loss_hold_for_a_million_cycles(amplitude, period, off):
    """V = t + Ωβ, φ = −π/2 with t < V < 1/t: two impacts a cycle permanently, the peak that of the first thousand cycles."""
    frequency = 2 * math.pi / period
    t = math.tanh(math.pi / frequency / 2)
    speed = t + frequency * amplitude / (1 + frequency**2)
    assert t < speed < 1 / t
    system = _system(amplitude, period, 1.0, phase=-math.pi / 2)
    start = rk.State(velocity=speed * (1 + off))
    short = rk.simulate(system, start, cycles=1_000, record="none")
    long = rk.simulate(system, start, cycles=1_000_000, record="none")
    assert long.outcome is rk.Outcome.BOUNDED
    assert abs(long.impacts - 2_000_000) <= 1
    assert math.isclose(long.peak, short.peak, rel_tol=1e-3)


def _stretching(phase, cycles, leap, distance):
    """Exponent per cycle of A = 2, T = .4, e = 1 from rest: a neighbour set back to its distance every leap."""
    system = _system(2.0, 0.4, 1.0, phase=phase)

    def after(point, count):
        final = rk.simulate(system, rk.State(*point), cycles=count, record="none").final
        return np.array([final.angle, final.velocity])

    point = after((0.0, 0.0), 1)
    offset, total = np.array([distance, 0.0]), 0.0
    for _ in range(cycles // leap):
        moved, beside = after(point, leap), after(point + offset, leap)
        apart = np.hypot(*(beside - moved))
        total += math.log(apart / distance)
        point, offset = moved, (beside - moved) * (distance / apart)
    return total / cycles


def test_figure_6_is_chaotic_at_the_known_rate():
    """.16 ± .035 per cycle at 10³ cycles over starts within 1e-7 in φ: the mean of 24 to four of its standard errors."""
    exponents = [_stretching(phase, 1_000, 5, 1e-8) for phase in np.linspace(0, 1e-7, 24)]
    assert abs(np.mean(exponents) - 0.16) < 4 * 0.035 / math.sqrt(24)
    assert min(exponents) > 0.03


def test_figure_6_fills_an_area():
    """Section points of the chaotic sea meet new boxes at a rate that a curve cannot."""
    section = rk.simulate(_system(2.0, 0.4, 1.0), cycles=40_000, record="section").section()
    low, high = section.min(axis=0), section.max(axis=0)
    boxes = np.unique(np.floor((section - low) / (high - low) * 60), axis=0)
    assert len(boxes) > 600  # a closed curve across such a grid meets a few hundred at most


def test_figure_13a_strikes_base_and_braces_at_the_known_rates():
    """A = 15, T = 2, braces at 1 with r = 1: 2.82 impacts and 2.75 brace hits a cycle."""
    cycles = 200_000
    motion = rk.simulate(_system(15.0, 2.0, 0.925, braces=rk.Braces(1.0, 1.0)), cycles=cycles, record="none")
    assert motion.outcome is rk.Outcome.BOUNDED
    assert abs(motion.impacts / cycles - 2.82) < 0.01
    assert abs(motion.brace_hits / cycles - 2.75) < 0.01
    assert math.isclose(motion.peak, 1.0, abs_tol=1e-13)
    # what impacts take away is the sum of the exponents, .531 − .751 per τ
    assert abs(2 * math.log(0.925) * motion.impacts / motion.duration + 0.220) < 0.002
