"""Response diagrams against single verdicts, closed forms, and turns of the motion about the origin."""

import math
import time
from dataclasses import dataclass
from pkgutil import resolve_name as resolve

import attrs
import numpy as np
import pytest
import xarray as xr

import rocking as rk
from rocking.model.progress import Bar

CASCADE = rk.System(rk.Harmonic(amplitude=10.0, period=1.721328), restitution=0.8)
UNDAMPED = rk.System(rk.Harmonic(amplitude=4.0, period=0.4), restitution=1.0)
BRACED = rk.System(rk.Harmonic(amplitude=15.0, period=2.0), 0.925, rk.Braces(angle=1.0))
FULL = rk.System(rk.Harmonic(amplitude=2.5, period=1.5), restitution=0.9, critical_angle=0.3)
TABLED = attrs.evolve(FULL, restitution_table=((0.2, 0.85), (0.6, 0.8)))


@dataclass
class Case:
    """A parameter with some values, and the system at a value, written out."""

    system: rk.System
    parameter: str
    values: list
    at: object


def shaken(system, **changes):
    given = {"amplitude": system.forcing.amplitude, "phase": system.forcing.phase} | changes
    if "frequency" not in given:
        given.setdefault("period", system.forcing.period)
    return attrs.evolve(system, forcing=rk.Harmonic(**given))


CASES = {
    "amplitude": Case(CASCADE, "amplitude", [0.9, 9.0, 10.103037, 10.5, 10.7, 11.5], lambda value: shaken(CASCADE, amplitude=value)),
    "undamped": Case(UNDAMPED, "amplitude", [1.5, 2.0, 3.9, 4.0, 4.1, 4.8], lambda value: shaken(UNDAMPED, amplitude=value)),
    "period": Case(UNDAMPED, "period", [0.38, 0.4, 0.6], lambda value: shaken(UNDAMPED, period=value)),
    "frequency": Case(CASCADE, "frequency", [3.7, 3.9], lambda value: shaken(CASCADE, frequency=value)),
    "phase": Case(CASCADE, "phase", [-1.0, 2.0], lambda value: shaken(CASCADE, phase=value)),
    "restitution": Case(CASCADE, "restitution", [0.5, 0.75], lambda value: attrs.evolve(CASCADE, restitution=value)),
    "brace_angle": Case(BRACED, "brace_angle", [0.8, 2.0], lambda value: attrs.evolve(BRACED, braces=rk.Braces(value))),
    "brace_restitution": Case(BRACED, "brace_restitution", [0.3, 0.9], lambda value: attrs.evolve(BRACED, braces=rk.Braces(1.0, value))),
    "critical_angle": Case(FULL, "critical_angle", [0.05, 0.3, 0.9], lambda value: attrs.evolve(FULL, critical_angle=value)),
    "full block": Case(FULL, "amplitude", [0.5, 2.0, 2.5], lambda value: shaken(FULL, amplitude=value)),
    "table": Case(TABLED, "amplitude", [0.5, 1.5], lambda value: shaken(TABLED, amplitude=value)),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_verdict_at_each_value_is_that_of_classify(name):
    case = CASES[name]
    found = rk.response_diagram(case.system, **{case.parameter: case.values[::-1]}, max_cycles=20_000)
    assert found.values.tolist() == case.values
    for k, value in enumerate(case.values):
        alone = rk.classify(case.at(value), max_cycles=20_000)
        assert found.verdicts[k] == alone
        assert (found.kind[k], found.period[k]) == (alone.kind, alone.period or 0)
        assert found.symmetric[k] == bool(alone.symmetric)
        assert found.evidence[k] == alone.evidence.statement
        for column, number in (("exponent", alone.exponent), ("exponent_error", alone.exponent_error)):
            shown = getattr(found, column)[k]
            assert np.isnan(shown) if number is None else shown == number


def test_all_types_of_response_are_among_the_cases():
    kinds = set()
    for case in CASES.values():
        kinds |= set(
            rk.response_diagram(case.system, **{case.parameter: case.values}, max_cycles=20_000).kind
        )
    assert kinds >= {"rest", "periodic", "quasi-periodic", "chaotic", "overturned"}


def test_start_and_limits_are_those_of_classify():
    start = rk.State(0.0, 0.15)
    system = rk.System(rk.Harmonic(5.5, period=0.5, phase=1.8), restitution=0.925)
    found = rk.response_diagram(system, start, amplitude=[5.5])
    assert (found.period.tolist(), found.start) == ([10], start)
    assert rk.response_diagram(system, start, amplitude=[5.5], max_period=9).kind.tolist() != ["periodic"]
    assert rk.response_diagram(CASCADE, amplitude=[10.103037], max_cycles=500).kind.tolist() == [
        "undetermined"
    ]


@pytest.mark.parametrize("restitution", [0.8, 0.925])
def test_exponent_of_a_stable_focus_is_ln_e_times_the_impact_rate(restitution):
    """Complex multipliers have the modulus e² over a period with two impacts."""
    system = rk.System(rk.Harmonic(2.0, period=1.0), restitution)
    periods = np.array([0.9, 1.0, 1.1])
    found = rk.response_diagram(system, period=periods)
    assert all(abs(verdict.multipliers[0].imag) > 0.1 for verdict in found.verdicts)
    np.testing.assert_allclose(found.exponent, 2 * math.log(restitution) / periods, rtol=1e-12)
    assert not found.exponent_error.any()


def test_exponents_are_those_of_two_tangent_vectors():
    """Real multipliers near a symmetry breaking, and chaos; two estimates differ by five standard errors at most."""
    found = rk.response_diagram(CASCADE, amplitude=[7.2, 10.103037])
    for verdict, exponent, error in zip(found.verdicts, found.exponent, found.exponent_error, strict=True):
        spectrum = rk.lyapunov(verdict.system, cycles=50_000)
        assert abs(exponent - spectrum.values[0]) <= 5 * math.hypot(error, spectrum.errors[0])
    assert found.exponent[0] < -0.03
    assert found.exponent[1] > 0.05


def turns_about_origin(system, start, cycles, first=0):
    """Return the clockwise turns of (Θ, Θ') about the origin per cycle; samples lie closer than half a turn."""
    period = system.forcing.period
    motion = rk.simulate(system, start, cycles=first + cycles)
    times = np.linspace(first * period, (first + cycles) * period, 400 * cycles + 1)
    angle, velocity = motion.at(times)[:2]
    return -np.diff(np.unwrap(np.arctan2(velocity, angle))).sum() / (2 * math.pi * cycles)


@pytest.mark.parametrize(
    ("system", "kind"),
    [
        (rk.System(rk.Harmonic(6.5, period=0.4), 0.925), "periodic"),
        (attrs.evolve(FULL, critical_angle=0.6), "periodic"),
        (UNDAMPED, "quasi-periodic"),
        (shaken(UNDAMPED, amplitude=4.86), "quasi-periodic"),
        (shaken(BRACED, amplitude=14.0), "chaotic"),
    ],
)
def test_rotation_number_is_twice_the_turns_about_the_origin(system, kind):
    """Over N cycles, turns of a regular motion are off by 1/N at most; those of chaos have an error of their own."""
    found = rk.response_diagram(system, amplitude=[system.forcing.amplitude])
    assert found.kind.tolist() == [kind]
    regular, cycles = kind != "chaotic", 1_000
    turns = turns_about_origin(system, rk.State(), cycles, 1_000)
    tolerance = 2 / cycles if regular else 5 * found.rotation_error[0] * math.sqrt(1 + 20_000 / cycles)
    assert abs(2 * turns - found.rotation[0]) < tolerance
    assert found.rotation[0] > 0.5


def test_rotation_numbers_of_the_symmetric_modes_are_fractions():
    """The (1, n) mode has two impacts in n cycles, Yim & Lin (1991)."""
    for amplitude, period, n in ((2.0, 1.0, 1), (6.5, 0.4, 3)):
        (mode,) = (
            each
            for each in rk.theory.symmetric_modes(amplitude, period, 0.925, n)
            if each.admissible and each.stable
        )
        found = rk.response_diagram(
            rk.System(rk.Harmonic(amplitude, period=period), 0.925), amplitude=[amplitude]
        )
        assert found.period.tolist() == [mode.n]
        assert found.rotation.tolist() == [2 / mode.n]
        assert found.rotation_error.tolist() == [0.0]


def test_rotation_number_of_free_rocking_has_a_closed_form():
    """A = 0 and e = 1 from Θ₀: a quarter period is arccosh(1/(1 − Θ₀)), and two of them lie between impacts."""
    system = rk.System(rk.Harmonic(0.0, period=1.0), restitution=1.0)
    found = rk.response_diagram(system, rk.State(0.5), period=[0.7, 1.0])
    assert found.kind.tolist() == ["quasi-periodic"] * 2
    np.testing.assert_allclose(found.rotation, np.array([0.7, 1.0]) / (2 * math.acosh(2.0)), rtol=1e-12)
    assert (found.rotation_error < 1e-9).all()


def test_rotation_within_an_island_is_the_angle_of_the_multipliers():
    """For the (1, 1) mode at e = 1, V = t + Ωβ and 2 cos χ = −2C + 2S/V. A cycle turns by 2χ."""
    frequency, half = 2 * math.pi, 0.5
    speed = math.tanh(half / 2) + frequency / (1 + frequency**2)
    turn = math.acos(-math.cosh(half) + math.sinh(half) / speed) / math.pi
    system = rk.System(rk.Harmonic(1.0, period=1.0, phase=-math.pi / 2), restitution=1.0)
    found = rk.response_diagram(system, rk.State(velocity=speed * (1 + 1e-4)), amplitude=[1.0])
    assert found.kind.tolist() == ["quasi-periodic"]
    assert found.rotation[0] == pytest.approx(2.0, abs=1e-12)
    free = found.rotation_numbers[0].free
    assert min(abs(free - turn), abs(free - (1 - turn))) < 1e-6


def test_torus_bent_around_its_mean_keeps_its_mean_number_of_impacts():
    """`rotation_number` refuses it, because its points do not surround their mean."""
    system, start = rk.System(rk.Harmonic(0.3, period=2.0), 1.0), rk.State(velocity=0.55)
    with pytest.raises(ValueError, match="strongly bent"):
        rk.rotation_number(system, start)
    found = rk.response_diagram(system, start, amplitude=[0.3])
    assert found.rotation_numbers == (None,)
    assert found.rotation[0] == pytest.approx(2.0, abs=1e-9)


def test_brace_hits_are_no_impacts():
    """Bouncing on one brace never turns about the origin."""
    system = rk.System(rk.Harmonic(0.1, period=1.0), 0.9, rk.Braces(1.5, 1.0))
    found = rk.response_diagram(system, rk.State(1.3), amplitude=[0.1])
    assert found.kind.tolist() == ["quasi-periodic"]
    assert found.rotation.tolist() == [0.0]
    assert found.rotation_numbers[0].section == "brace hits"


def test_rotation_number_of_chaos_lies_within_its_error():
    found = rk.response_diagram(BRACED, amplitude=[14.0, 15.0])
    assert found.kind.tolist() == ["chaotic"] * 2
    for k, verdict in enumerate(found.verdicts):
        longer = rk.lyapunov(verdict.system, rk.State(0.1, 0.2), cycles=200_000)
        error = found.rotation_error[k]
        assert 0.0 < error < 0.02
        assert abs(found.rotation[k] - longer.impacts / longer.cycles) < 5 * error
    assert found.rotation_numbers == (None, None)


def test_number_is_unknown_without_a_response_and_zero_at_rest():
    """At e = 0.5 and A slightly above 1 infinitely many impacts precede rest in each cycle."""
    system = rk.System(rk.Harmonic(1.0, period=2.0), restitution=0.5)
    found = rk.response_diagram(system, amplitude=[0.9, 1.05, 1.3, 30.0])
    assert found.kind.tolist() == ["rest", "periodic", "periodic", "overturned"]
    np.testing.assert_array_equal(found.rotation, [0.0, math.nan, 2.0, math.nan])
    np.testing.assert_array_equal(found.rotation_error, [0.0, math.nan, 0.0, math.nan])
    assert np.isneginf(found.exponent[:2]).all()
    assert np.isnan(found.exponent[3])
    few = rk.response_diagram(CASCADE, amplitude=[10.103037], max_cycles=500)
    assert np.isnan(few.rotation).all()


def test_dataset_comes_back_from_a_file(tmp_path):
    found = rk.response_diagram(FULL, rk.State(0.1), amplitude=[0.5, 2.0, 30.0])
    found.to_xarray().to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "a.nc") as read:
        names = read["kind"].attrs["flag_meanings"].split()
        assert [names[code] for code in read["kind"].values] == found.kind.tolist()
        for name in ("symmetric", "exponent", "exponent_error", "rotation", "rotation_error"):
            assert read[name].dims == ("amplitude",)
            np.testing.assert_array_equal(read[name], getattr(found, name))
        assert read["orbit_period"].values.tolist() == found.period.tolist()
        assert tuple(read["evidence"].values.tolist()) == found.evidence
        assert read["level"].values.tolist() == [verdict.evidence.level for verdict in found.verdicts]
        assert read["amplitude"].values.tolist() == found.values.tolist()
        assert (read.attrs["start_angle"], read.attrs["critical_angle"]) == (0.1, 0.3)
        assert "amplitude" not in read.attrs
        for name, variable in read.variables.items():
            assert variable.attrs["long_name"], name
            assert variable.dtype.kind not in "fi" or name == "kind" or variable.attrs["units"], name


def test_one_line_tells_range_start_and_types():
    found = rk.response_diagram(CASCADE, amplitude=[0.9, 10.4, 10.5, 10.7, 11.5])
    assert str(found) == (
        "response diagram over amplitude 0.9 to 11.5, 5 values, each from Θ = 0, Θ' = 0: "
        "1 rest, 3 periodic (periods 1, 2, 4), 1 overturned"
    )


def test_progress_counts_every_value(monkeypatch):
    done = []
    monkeypatch.setattr(Bar, "advance", lambda bar, count: done.append(count))
    rk.response_diagram(CASCADE, amplitude=np.linspace(2, 5, 37))
    assert sum(done) == 37


def test_value_that_does_not_take_the_start_is_refused_before_any_verdict(monkeypatch):
    """At θcr = 1 a block lies flat at Θ = π/2."""
    begun = []
    monkeypatch.setattr("rocking.orbits.diagrams.verdicts_over", lambda *given, **more: begun.append(given))
    with pytest.raises(
        ValueError, match=r"^angle must lie within ±1\.5708, where the block lies flat; got 2"
    ):
        rk.response_diagram(FULL, rk.State(2.0), critical_angle=[0.1, 0.2, 1.0])
    assert begun == []


@pytest.mark.parametrize("place", ["verdicts.batch.classify_one", "diagrams.mean_impacts"])
def test_no_value_begins_after_an_interruption(place, monkeypatch):
    begun, real = [], resolve(f"rocking.orbits.{place}")

    def counting(*given):
        begun.append(given)
        if len(begun) == 20:
            raise KeyboardInterrupt
        time.sleep(0.002)  # a value takes longer than to learn of the interruption
        return real(*given)

    monkeypatch.setattr(f"rocking.orbits.{place}", counting)
    with pytest.raises(KeyboardInterrupt):
        rk.response_diagram(UNDAMPED, amplitude=np.linspace(1.5, 3.0, 500), max_cycles=100)
    assert len(begun) < 300


FINITE = rk.System(rk.PiecewiseLinear([0.0, 2.0, 0.0], step=1.0), restitution=0.9)


@pytest.mark.parametrize(
    "change, error, message",
    [
        (dict(system=3), TypeError, "system must be a System; got 3"),
        (dict(system=FINITE), TypeError, "system must have a periodic base motion, rk.Harmonic; got PiecewiseLinear"),
        (
            dict(system=FINITE, amplitude=None, restitution=[0.5]),
            TypeError,
            "system must have a periodic base motion, rk.Harmonic; got PiecewiseLinear",
        ),
        (dict(period=[1.0]), TypeError, "give exactly one of amplitude, period, .*; got amplitude=.* and period="),
        (dict(amplitude=[]), ValueError, r"amplitude must hold one number or more; got \[\]"),
        (dict(amplitude=[1.0, math.inf]), ValueError, r"amplitude must hold finite numbers; got \[1.0, inf\]"),
        (dict(amplitude=np.arange(100_001.0)), ValueError, "amplitude must hold 100,000 different numbers at most; got 100,001"),
        (dict(amplitude="a"), TypeError, "amplitude must be a real number or an array"),
        (dict(amplitude=[1.0, -1.0]), ValueError, r"amplitude must lie in \[0, 1000\]; got -1.0"),
        (dict(amplitude=None, brace_restitution=[1.0]), TypeError, "brace_restitution must be used with a braced system"),
        (
            dict(amplitude=None, brace_angle=[0.5, 2.0], start=rk.State(0.8)),
            ValueError,
            r"angle must lie between the braces, in \[-0.5, 0.5\]; got 0.8",
        ),
        (dict(start=(0, 0)), TypeError, r"start must be a State; got \(0, 0\)"),
        (dict(max_cycles=0), ValueError, r"max_cycles must be a whole number in \[1, 100000000\]; got 0"),
        (dict(max_period=1.5), ValueError, r"max_period must be a whole number in \[1, 10000\]; got 1.5"),
    ],
)  # fmt: skip
def test_refusals_are_one_line(change, error, message):
    given = dict(system=CASCADE, amplitude=[1.0]) | change
    with pytest.raises(error, match=f"^{message}") as refused:
        rk.response_diagram(**given)
    assert "\n" not in str(refused.value)


def test_dataset_over_the_period_holds_the_periods_of_the_responses():
    system = rk.System(rk.Harmonic(amplitude=5.5, period=1.0), restitution=0.925)
    data = rk.response_diagram(system, period=[0.3, 1.0]).to_xarray()
    assert data.period.values.tolist() == [0.3, 1.0]
    assert data.orbit_period.values.tolist() == [
        rk.classify(rk.System(rk.Harmonic(5.5, period=period), 0.925)).period or 0 for period in (0.3, 1.0)
    ]


def test_braces_that_a_varied_angle_adds_are_among_the_constant_parameters():
    system = rk.System(rk.Harmonic(2.0, period=1.0), 0.9)
    diagram = rk.response_diagram(system, brace_angle=[0.2, 0.3], max_cycles=100)
    responses = {verdict.system.braces.restitution for verdict in diagram.verdicts}
    assert responses == {diagram.fixed["brace_restitution"]}
    assert diagram.to_xarray().attrs["brace_restitution"] == diagram.fixed["brace_restitution"]
    assert "brace_angle" not in diagram.fixed


@pytest.mark.parametrize("start", [rk.State(0.3), rk.State(0.0, 0.3)])
def test_diagram_from_another_initial_state_does_not_take_the_verdicts_of_a_store(tmp_path, start):
    system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.9)
    diagram = {"system": system, "amplitude": [0.5, 1.5], "store": tmp_path / "diagram"}
    rk.response_diagram(**diagram)
    with pytest.raises(
        ValueError, match=r"holds a different survey: (angle|velocity) is 0 there and 0.3 here"
    ):
        rk.response_diagram(**diagram, start=start)
