"""Verdicts on known motions: all response types, all criteria, their sentences, and values that do not apply."""

import math
import re
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import rocking as rk
from rocking.kernels.classify import verdict as kernel
from rocking.model.verdict import Criterion
from rocking.response.evidence import STATEMENTS, at_most

NOT_PERIODIC = (
    "period",
    "impacts_per_period",
    "brace_hits_per_period",
    "symmetric",
    "multipliers",
    "orbit",
)


def system(amplitude, period, restitution, phase=0.0, braces=None):
    return rk.System(rk.Harmonic(amplitude, period=period, phase=phase), restitution, braces)


SYMMETRIC = system(6.5, 0.4, 0.925)
TENTH = system(5.5, 0.5, 0.925, phase=1.8), rk.State(velocity=0.15)
LOSSLESS = system(4.0, 0.4, 1.0)
CHAOTIC = system(10.103037, 1.721328, 0.8)
FALLING = system(1.75, 2.0, 0.95)
RESTING = system(0.5, 1.0, 0.9)
LIFTING = system(1.0111, 4.7531, 0.925)
LEAVING = system(4.0, 3.0, 0.5, braces=rk.Braces(0.2, 0.0))
PRESSED = system(0.2, 1.0, 0.9, braces=rk.Braces(1.5, 0.5))

SAID = {
    "no return": (
        FALLING,
        None,
        {},
        (
            "overturned: overturning is certain from τ = 10.3092, after 4 impacts, because the growing part of the motion cannot be "
            "reversed. Evidence: exact, within 6 cycles."
        ),
    ),
    "no return at once": (
        system(0.0, 1.0, 0.9),
        rk.State(1.5),
        {},
        (
            "overturned: overturning is certain from τ = 0, without an impact, because the growing part of the motion cannot be "
            "reversed. Evidence: exact, within … cycle."
        ),
    ),
    "rest": (
        RESTING,
        None,
        {},
        (
            "rest: the block remains at rest, because A = 0.5 ≤ 1 cannot lift it off. Evidence: exact, from the initial state "
            "on."
        ),
    ),
    "rest in the end": (
        system(0.0, 1.0, 0.9),
        rk.State(0.5),
        {},
        "rest: the block remains at rest, because A = 0 ≤ 1 cannot lift it off. Evidence: exact, within … cycles.",
    ),
    "leaning": (
        PRESSED,
        rk.State(-1.5),
        {},
        (
            "rest: the block remains in contact with the brace at Θ = -1.5, because A = 0.2 ≤ Θb − 1 = 0.5 cannot pull it off. "
            "Evidence: exact, from the initial state on."
        ),
    ),
    "reset": (
        LIFTING,
        None,
        {},
        (
            "periodic: superstable orbit of period 1, symmetric, infinitely many impacts: every lift-off from rest has the same "
            "state, on alternating sides; successive ones are 1 half cycle of the forcing apart, and perturbations grew less than "
            "1e8-fold in between. Evidence: verified, within the first cycle."
        ),
    ),
    "reset on one side": (
        system(3.2, 1.5, 0.0),
        None,
        {},
        (
            "periodic: superstable orbit of period 2, asymmetric, 2 impacts: every lift-off from rest has the same state; "
            "successive ones are 2 cycles of the forcing apart, and perturbations grew less than 1e8-fold in between. Evidence: "
            "verified, after … cycles."
        ),
    ),
    "reset on the braces": (
        LEAVING,
        None,
        {},
        (
            "periodic: superstable orbit of period 1, symmetric, 2 impacts, 2 brace impacts: every release from a brace has the "
            "same state, on alternating sides; successive ones are 1 half cycle of the forcing apart, and perturbations grew less "
            "than 1e8-fold in between. Evidence: verified, within the first cycle."
        ),
    ),
    "unresolved reset": (
        system(6.0, 1.0, 0.01),
        None,
        {},
        (
            "undetermined: the block repeatedly comes to rest or into sustained contact with a brace, but perturbations grow more "
            "than 1e8-fold between two releases, so that its period cannot be resolved in double precision. Evidence: none, after "
            "… cycles; a longer run does not help, try slightly different parameters."
        ),
    ),
    "orbit": (
        *TENTH,
        {},
        (
            "periodic: stable orbit of period 10, asymmetric, 4 impacts: Newton residual |P(x) − x| ≤ …, largest Floquet "
            "multiplier 0.732 in modulus; the motion is so close (distance … one period earlier) that it cannot turn away to "
            "second order (test at … % of its limit). Evidence: verified, after … cycles."
        ),
    ),
    "neutral orbit": (
        LOSSLESS,
        rk.State(0.0403216219, 0.1926036397),
        {},
        (
            "periodic: neutrally stable orbit of period 3, symmetric, 2 impacts: no event dissipates energy; the motion returns to "
            "within 1e-11 of an earlier state, and its averages over both halves of the run agree to 9 digits or more; nearby "
            "motions stay near but need not converge. Evidence: verified, after … cycles."
        ),
    ),
    "torus": (
        LOSSLESS,
        None,
        {},
        (
            "quasi-periodic: motion on an invariant torus: no event dissipates energy; averages over both halves of the run agree "
            "to 9 digits or more for the times between impacts and to … for the squared speeds; nearby trajectories diverge no "
            "faster than linearly; and the motion does not return to within 1e-11 in 64 cycles. Evidence: statistical, over … "
            "cycles; a motion that stays near a torus for long may leave it later."
        ),
    ),
    "between": (
        LOSSLESS,
        rk.State(-0.306, 0.12),
        {"max_cycles": 12_000},
        (
            "undetermined: no event dissipates energy, and averages over both halves of the run agree to 6.… digits: more than in "
            "chaotic motion (below 6), but not all conditions for a torus are met. Evidence: none, after 12,000 cycles; increase "
            "max_cycles above 12,000."
        ),
    ),
    "exponent": (
        CHAOTIC,
        None,
        {},
        (
            "chaotic: largest Lyapunov exponent 0.07… ± 0.00… per τ, … standard errors above zero. Evidence: statistical, over "
            "100,000 cycles; a longer run may show that the chaos is transient."
        ),
    ),
    "unwatched": (
        CHAOTIC,
        None,
        {"max_cycles": 5_000},
        (
            "undetermined: no orbit of period up to 64 was reached, and 5,000 cycles are too few to call the response chaotic. "
            "Evidence: none, after 5,000 cycles; increase max_cycles to 10,000 or more."
        ),
    ),
    "unwatched between braces": (
        system(15.0, 2.0, 0.925, braces=rk.Braces(1.0)),
        None,
        {"max_cycles": 50_000},
        (
            "undetermined: no orbit of period up to 64 was reached, and 50,000 cycles are too few to call the response chaotic. "
            "Evidence: none, after 50,000 cycles; increase max_cycles to 100,000 or more."
        ),
    ),
    "indistinct": (
        *TENTH,
        {"max_cycles": 20_000, "max_period": 9},
        (
            "undetermined: no orbit of period up to 9 was reached, and the largest Lyapunov exponent, -0.0… ± 0.0… per τ, is "
            "negative. Evidence: none, after 20,000 cycles; increase max_period above 9 or max_cycles above 20,000."
        ),
    ),
    "standing": (
        system(0.0, 1.0, 0.9),
        rk.State(1.0),
        {},
        (
            "undetermined: the motion remains on an unstable orbit; it returns to within 1e-11 of an earlier state, and "
            "perturbations grow at a rate of 1 per τ. Evidence: none, after 100,000 cycles; change the initial state slightly."
        ),
    ),
}


@pytest.mark.parametrize("name", SAID)
def test_sentence_tells_what_was_shown(name):
    asked, start, budget, said = SAID[name]
    told = str(rk.classify(asked, start, **budget))
    assert re.fullmatch(re.escape(said).replace("…", ".{1,15}?"), told), told


def test_every_criterion_has_a_sentence_and_says_why_where_it_decides_nothing():
    assert list(STATEMENTS) == list(Criterion)
    assert all(bool(each.why) == (each.level == "none") for each in Criterion)


def test_criteria_and_kinds_have_the_codes_of_the_kernels():
    assert [(each.name, each) for each in Criterion] == [(each.name, each) for each in kernel.Ground]
    assert [(each.name, each.code) for each in rk.Kind] == [(each.name, each) for each in kernel.Kind]


def test_what_sticks_to_an_island_for_long_may_leave_it_so_that_a_torus_is_statistical():
    assert Criterion.TORUS.level == "statistical"


@pytest.mark.parametrize(
    ("asked", "kind"),
    [
        (RESTING, "rest"),
        (SYMMETRIC, "periodic"),
        (LOSSLESS, "quasi-periodic"),
        (CHAOTIC, "chaotic"),
        (FALLING, "overturned"),
    ],
)
def test_kind_is_that_of_the_motion_and_what_does_not_apply_is_none(asked, kind):
    verdict = rk.classify(asked)
    assert verdict.kind == kind
    assert (verdict.system, verdict.start) == (asked, rk.State())
    missing = {name for name in NOT_PERIODIC if getattr(verdict, name) is None}
    assert missing == (set() if kind == "periodic" else set(NOT_PERIODIC))
    assert (verdict.exponent is None) == (kind == "overturned")
    assert (verdict.exponent_error is None) == (kind in ("overturned", "quasi-periodic"))
    assert (verdict.steady_peak is None) == (kind not in ("periodic", "rest"))
    assert (verdict.transient is None) == (kind == "chaotic")
    assert verdict.evidence.cycles == verdict.cycles


@pytest.mark.parametrize(
    ("asked", "start", "level"),
    [
        (FALLING, None, "exact"),
        (PRESSED, rk.State(1.5), "exact"),
        (LIFTING, None, "verified"),
        (*TENTH, "verified"),
        (LOSSLESS, None, "statistical"),
        (CHAOTIC, None, "statistical"),
        (system(6.0, 1.0, 0.01), None, "none"),
    ],
)
def test_level_of_the_evidence_is_named_in_its_sentence(asked, start, level):
    evidence = rk.classify(asked, start).evidence
    assert evidence.level == level
    assert f" Evidence: {level}, " in evidence.statement
    assert bool(evidence.tolerances) == (level in ("verified", "statistical"))


def test_orbit_returns_to_its_state_after_its_period_with_its_impacts():
    verdict = rk.classify(*TENTH)
    orbit, forcing = verdict.orbit, TENTH[0].forcing
    again = rk.simulate(
        system(forcing.amplitude, forcing.period, 0.925, phase=orbit.phase), orbit.state, cycles=orbit.period
    )
    assert abs(again.final.angle - orbit.state.angle) < 1e-13
    assert abs(again.final.velocity - orbit.state.velocity) < 1e-13
    assert (again.impacts, again.brace_hits) == (verdict.impacts_per_period, verdict.brace_hits_per_period)
    assert again.peak == pytest.approx(verdict.steady_peak, abs=1e-12)
    assert 0.0 <= orbit.phase < 2 * math.pi


def test_steady_motion_passes_through_the_orbit():
    verdict = rk.classify(SYMMETRIC)
    points = rk.simulate(SYMMETRIC, cycles=3_000).section(verdict.orbit.phase)[-verdict.period :]
    away = np.hypot(*(points - [verdict.orbit.state.angle, verdict.orbit.state.velocity]).T)
    assert away.min() < 1e-12
    assert verdict.peak >= verdict.steady_peak


@pytest.mark.parametrize(
    ("asked", "hits"), [(LIFTING, (None, 0)), (LEAVING, (2, 2)), (system(4.0, 1.0, 0.0), (6, 0))]
)
def test_motion_that_is_released_alike_forgets_everything(asked, hits):
    """Started from the release itself, the motion is back there a period later."""
    verdict = rk.classify(asked)
    orbit = verdict.orbit
    assert (verdict.multipliers, verdict.exponent, verdict.superstable) == ((0j, 0j), -math.inf, True)
    assert (verdict.impacts_per_period, verdict.brace_hits_per_period) == hits
    events = rk.simulate(asked, cycles=20 + 4 * verdict.period).events
    releases = events[events["kind"] == ("leave" if orbit.state.angle else "lift-off")]
    cycles = releases["time"] / asked.forcing.period
    later = cycles[-1] - verdict.period
    assert abs(cycles - later).min() < 1e-9
    turn = np.mod(releases["phase"] - orbit.phase + 1.0, math.pi) - 1.0
    assert abs(turn).max() < 1e-9
    assert set(np.abs(releases["angle"])) == {abs(orbit.state.angle)}


@pytest.mark.parametrize(
    ("asked", "start"),
    [
        (system(0.0, 1.0, 0.9), rk.State(-1.0)),
        (system(0.0, 0.7, 1.0), rk.State(1.0)),
        (system(0.0, 1.0, 0.9, braces=rk.Braces(1.0, 0.5)), rk.State(1.0)),
    ],
)
def test_balance_on_a_corner_is_not_chaos(asked, start):
    """Differences grow as e^τ there, without end and without an error; the motion goes nowhere."""
    verdict = rk.classify(asked, start)
    assert (verdict.kind, verdict.exponent) == ("undetermined", None)


@pytest.mark.parametrize(
    ("amplitude", "period", "phase", "restitution"),
    [
        (1.6182613902870813, 2.5896206598153415, 5.398642486900438, 0.05),
        (3.573261564786464, 0.8029147622265249, 0.0, 0.05),
    ],
)
def test_peak_is_never_below_that_of_the_orbit_that_is_approached(amplitude, period, phase, restitution):
    """From below: the motion was followed until the orbit was certain, and was still growing.

    The residual, 1e-12 at most, leaves the orbit open to that over 1 − ρ, with ρ < 0.7.
    """
    asked = system(amplitude, period, restitution, phase)
    verdict = rk.classify(asked)
    assert verdict.peak == pytest.approx(rk.simulate(asked, cycles=2_000, record="none").peak, abs=5e-12)


@pytest.mark.parametrize(
    ("asked", "start"),
    [
        (
            system(4.0, 0.4, 1.0, -math.pi / 2),
            rk.State(0.0, rk.theory.symmetric_modes(4.0, 0.4, 1.0, 3)[0].velocity),
        ),
        (LOSSLESS, rk.State(0.0403216219, 0.1926036397)),
        (system(0.0, 1.0, 1.0), rk.State(1 - 1 / math.cosh(0.25))),
    ],
)
def test_neutral_orbit_is_not_called_attracting_and_has_exponent_0(asked, start):
    """Without loss the product of the multipliers is 1; rounding alone can put both inside the unit circle."""
    verdict = rk.classify(asked, start)
    assert verdict.kind == "periodic"
    assert "no event dissipates energy" in str(verdict)
    assert "Floquet multiplier" not in str(verdict)
    assert (verdict.exponent, verdict.exponent_error) == (0.0, None)


def test_proof_is_told_with_the_numbers_of_the_motion_that_was_judged():
    """A long chaotic transient: followed a second time it overturns too, but 45 cycles earlier."""
    asked = system(1.4614392188602885, 1.1210051098996907, 1.0, 5.945624965850551)
    verdict = rk.classify(asked, rk.State(0.3753078383505627, 0.36631564058283517))
    told = re.search(r"from τ = ([\d.]+)", str(verdict))
    assert told is None or verdict.transient == pytest.approx(float(told[1]) / asked.forcing.period, abs=1)


def test_transient_of_an_overturning_block_is_the_cycle_of_the_proof():
    assert rk.classify(FALLING).transient == rk.simulate(FALLING).overturning.cycle


def test_block_that_never_moves_has_no_transient():
    assert (rk.classify(RESTING).transient, rk.classify(RESTING).steady_peak) == (0, 0.0)
    leaning = rk.classify(PRESSED, rk.State(1.5))
    assert (leaning.transient, leaning.steady_peak) == (0, 1.5)


def test_orbit_longer_than_looked_for_is_not_called_anything_else():
    assert rk.classify(*TENTH, max_period=9, max_cycles=2_000).kind == "undetermined"
    assert rk.classify(*TENTH, max_period=10).period == 10


@pytest.mark.parametrize(
    ("size", "shown"), [(3.3e-15, "4e-15"), (1e-12, "1e-12"), (9.1e-13, "1e-12"), (0.0, "0")]
)
def test_size_is_rounded_up_to_one_digit(size, shown):
    assert at_most(size) == shown
    assert float(shown) >= size * (1 - 1e-15)


REFUSED = {
    "max_cycles must be a whole number in [1, 100000000]; got 0": {"max_cycles": 0},
    "max_cycles must be a whole number in [1, 100000000]; got 1000000000.0": {"max_cycles": 1e9},
    "max_cycles must be a whole number in [1, 100000000]; got 1.5": {"max_cycles": 1.5},
    "max_cycles must be a whole number in [1, 100000000]; got nan": {"max_cycles": math.nan},
    "max_cycles must be a whole number in [1, 100000000]; got '9'": {"max_cycles": "9"},
    "max_period must be a whole number in [1, 10000]; got 0": {"max_period": 0},
    "max_period must be a whole number in [1, 10000]; got True": {"max_period": True},
    "start must be a State; got (0, 1) (make one: rk.State(angle=0.1, velocity=0.0))": {"start": (0, 1)},
    "angle must lie in [-1000, 1000]; got 1001.0": {"start": rk.State(1001)},
}


@pytest.mark.parametrize("message", REFUSED)
def test_what_cannot_be_judged_is_refused_in_one_line(message):
    with pytest.raises((ValueError, TypeError), match=f"^{re.escape(message)}$"):
        rk.classify(SYMMETRIC, **REFUSED[message])


def test_failure_in_the_thread_is_raised_where_it_is_waited_for(monkeypatch):
    def fail(*_):
        raise MemoryError

    rk.classify(RESTING)
    monkeypatch.setattr("rocking.kernels.batch.classify_one", fail)
    with pytest.raises(MemoryError):
        rk.classify(RESTING)


SCRIPT = """
import rocking as rk

system = rk.System(rk.Harmonic(10.103037, period=1.721328), 0.8)
rk.classify(system, max_cycles=10)
print("running", flush=True)
try:
    {run}
except KeyboardInterrupt:
    print("interrupted")
"""
ONE_LONG = "rk.classify(system, max_cycles=10**8)"
MANY_SHORT = "for _ in range(10**7): rk.classify(system, max_cycles=1000)"


@pytest.mark.parametrize("run", [ONE_LONG, MANY_SHORT])
@pytest.mark.parametrize("delay", [0.2, 0.57])
def test_interrupted_verdict_raises_keyboard_interrupt_and_the_process_ends(run, delay):
    with subprocess.Popen(
        [sys.executable, "-c", SCRIPT.format(run=run)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout.readline() == "running\n"
        time.sleep(delay)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=20)
    assert (process.returncode, out, err) == (0, "interrupted\n", "")


@pytest.mark.parametrize("asked", [FALLING, RESTING])
def test_end_that_another_run_does_not_meet_is_told_without_its_time(asked, monkeypatch):
    """As after a long chaotic transient, where one rounding otherwise leads elsewhere."""
    elsewhere = rk.simulate(SYMMETRIC, cycles=1, record="none")
    monkeypatch.setattr(sys.modules["rocking.response.classify"], "simulate", lambda *_, **__: elsewhere)
    verdict = rk.classify(asked)
    assert verdict.evidence.level == "exact"
    assert "the block remains at rest" in str(
        verdict
    ) or "overturning is certain, because the growing part" in str(verdict)
    assert re.search(
        r" Evidence: exact, within \d+ cycles?; the motion before is so sensitive that different rounding leads to a different "
        r"end\.$",
        str(verdict),
    )


@pytest.mark.parametrize("amplitude", [2.0, 2.2, 2.5, 3.0, 3.5, 4.0, 4.4, 5.0])
@pytest.mark.parametrize("period", [0.5, 1.0, 1.5, 2.5])
def test_period_of_what_forgets_is_the_least(amplitude, period):
    asked = system(amplitude, period, 0.0)
    verdict = rk.classify(asked)
    if verdict.superstable:
        section = rk.simulate(asked, cycles=verdict.cycles + 3 * verdict.period, record="section").section(
            1.3
        )
        last = section[-verdict.period :]
        repeats = [
            lag
            for lag in range(1, verdict.period + 1)
            if abs(last - section[-verdict.period - lag : -lag]).max() < 1e-7
        ]
        assert repeats == [verdict.period]


def test_free_rocking_that_hardly_loses_anything_is_not_chaotic():
    """Neighbours part linearly as their periods differ: no exponent."""
    assert rk.classify(system(0.0, 1.0, 0.999999), rk.State(0.5)).kind != "chaotic"


def test_exponent_of_an_orbit_longer_than_looked_for_is_that_of_its_multipliers():
    known = rk.classify(*TENTH).exponent
    measured = rk.classify(*TENTH, max_period=9, max_cycles=20_000)
    assert abs(measured.exponent - known) < 4.0 * measured.exponent_error
