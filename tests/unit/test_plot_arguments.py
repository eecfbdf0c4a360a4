"""Arguments that plot functions share: units of a block, axes to draw into, and what is refused in one line."""

import math
import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

import rocking as rk
from made_results import BLOCK, MADE, RECORDS, SYSTEM, made

BRACED = rk.System(rk.Harmonic(15.0, period=2.0), 0.925, rk.Braces(1.0))
SHAKEN = rk.System(rk.PiecewiseLinear([0.0, 1.5, -1.5, 0.9, 0.0], step=0.4), 0.9)
MADE = MADE | {
    "motion of a braced block": lambda: rk.simulate(BRACED, cycles=10),
    "branch over the period": lambda: rk.continue_orbit(rk.classify(SYSTEM).orbit, "period", (0.4, 0.41)),
    **{
        f"{kind} over the {name}": partial(function, SYSTEM, **{name.replace(" ", "_"): values}, **how)
        for kind, function, how in (
            ("points", rk.orbit_diagram, {"transient": 5, "cycles": 2}),
            ("types", rk.response_diagram, {}),
        )
        for name, values in {
            "amplitude": [4.0, 6.5, 40.0],
            "period": [0.4, 0.41],
            "frequency": [15.0, 16.0],
            "critical angle": [0.1, 0.2],
        }.items()
    },
}


def of_speed(velocities):
    return np.degrees(BLOCK.radians_per_second(velocities))


def to_hertz(frequencies):
    return np.asarray(frequencies) / (2 * math.pi * BLOCK.seconds(1.0))


def per_second(rates):
    return np.asarray(rates) / BLOCK.seconds(1.0)


def of_density(densities):
    return np.asarray(densities) * BLOCK.degrees(1.0) ** 2 * BLOCK.seconds(1.0)


def same(values):
    return values


AXES = {
    "time": (r"time $\tau = \alpha t$", "time $t$ (s)", BLOCK.seconds),
    "angle": (r"angle $\Theta = \theta/\theta_\mathrm{cr}$", r"angle $\theta$ (°)", BLOCK.degrees),
    "velocity": (
        r"velocity $\Theta' = \mathrm{d}\Theta/\mathrm{d}\tau$",
        r"velocity $\dot\theta$ (°/s)",
        of_speed,
    ),
    "initial angle": (r"initial angle $\Theta_0$", r"initial angle $\theta_0$ (°)", BLOCK.degrees),
    "initial velocity": (r"initial velocity $\Theta'_0$", r"initial velocity $\dot\theta_0$ (°/s)", of_speed),
    "speed": (r"speed after impact $|\Theta'|$", r"speed after impact $|\dot\theta|$ (°/s)", of_speed),
    "peak": (r"largest $|\Theta|$", r"largest $|\theta|$ (°)", BLOCK.degrees),
    "amplitude": ("amplitude $A$", "amplitude $a_x$ (m/s²)", BLOCK.acceleration),
    "period": ("period $T$", "period (s)", BLOCK.seconds),
    "frequency": (r"frequency $\Omega$", "frequency (Hz)", to_hertz),
    "pulse": (r"frequency of the pulse $\Omega = \omega/\alpha$", "frequency of the pulse (Hz)", to_hertz),
    "multiple": (r"frequency (cycles per unit of $\tau$)", "frequency (Hz)", per_second),
    "density": (
        r"power spectral density $S_\Theta$",
        r"power spectral density $S_\theta$ (°²/Hz)",
        of_density,
    ),
    "exponent": (r"exponent $\lambda_1$ per $\tau$", r"exponent $\lambda_1$ (1/s)", per_second),
    "phase": (*2 * [r"forcing phase $\psi$ (rad)"], same),
    "critical angle": (*2 * [r"critical angle $\theta_\mathrm{cr}$ (rad)"], same),
    "cycles": (*2 * ["cycles averaged over"], same),
    "safe": (*2 * ["safe fraction (%)"], same),
    "rotation": (*2 * ["rotation number\n(impacts per cycle)"], same),
    "amplitude below": ("", "", BLOCK.acceleration),
}
"""Label in normalised units, label in SI, and conversion."""
DRAWN = {
    "time_history": ("motion", "time", "angle"),
    "time_history, braced": ("motion of a braced block", "time", "angle"),
    "phase_portrait": ("motion", "angle", "velocity"),
    "section": ("motion", "angle", "velocity"),
    "impact_section": ("motion", "phase", "speed"),
    "manifolds": ("manifolds", "angle", "velocity"),
    "convergence": ("exponents", "cycles", "exponent"),
    "spectrum": ("spectrum", "multiple", "density"),
    "branch": ("branch", "amplitude", "peak"),
    "branch, period": ("branch over the period", "period", "peak"),
    "bifurcation_curve": ("curve", "period", "amplitude"),
    "frequency_response": ("frequency response", "period", "peak"),
    "orbit_diagram": ("points over the amplitude", "amplitude", "angle"),
    "orbit_diagram, period": ("points over the period", "period", "angle"),
    "orbit_diagram, frequency": ("points over the frequency", "frequency", "angle"),
    "orbit_diagram, critical angle": ("points over the critical angle", "critical angle", "angle"),
    "response_diagram 1": ("types over the amplitude", "amplitude below", "exponent"),
    "response_diagram 2": ("types over the amplitude", "amplitude", "rotation"),
    "response_diagram 2, period": ("types over the period", "period", "rotation"),
    "response_diagram 2, frequency": ("types over the frequency", "frequency", "rotation"),
    "response_diagram 2, critical angle": ("types over the critical angle", "critical angle", "rotation"),
    "basins": ("basins", "initial angle", "initial velocity"),
    "safe_basin": ("safe basin", "amplitude", "safe"),
    "overturning": ("overturning", "period", "amplitude"),
    "parametric_map": ("map", "period", "amplitude"),
    "overturning_spectrum": ("overturning spectrum", "pulse", "amplitude"),
    "modes": ((1.0, 0.8), "amplitude", "speed"),
    "heteroclinic": ((), "angle", "velocity"),
    "thresholds": (([1.0, 1.5, 2.0], {"bound": [1.0, 2.0, 3.0]}), "period", "amplitude"),
}
"""The result that a function draws, or its arguments, and the axes."""
FUNCTIONS = [name for name in DRAWN if "," not in name and " " not in name]


def result(name):
    return MADE[name]() if " over " in name or "braced" in name else made(name)


def axes_of(name, **how):
    """Draw a figure and return its axes."""
    word, _, panel = name.partition(",")[0].partition(" ")
    given = DRAWN[name][0]
    drawn = getattr(rk.plot, word)(*(given if isinstance(given, tuple) else (result(given),)), **how)
    return drawn.axes[int(panel)] if panel else drawn


@pytest.mark.parametrize("name", DRAWN)
def test_block_gives_si_axes_and_every_line_in_their_units(name):
    plain, in_si = axes_of(name, block=None), axes_of(name, block=BLOCK)
    axes = [AXES[axis] for axis in DRAWN[name][1:]]
    for ax, place in ((plain, 0), (in_si, 1)):
        assert [ax.get_xlabel(), ax.get_ylabel()] == [axis[place] for axis in axes]
    for line, converted in zip(plain.lines, in_si.lines, strict=True):
        in_data = line.get_transform().contains_branch_seperately(plain.transData)
        for given, shown, axis, is_data in zip(
            line.get_data(), converted.get_data(), axes, in_data, strict=True
        ):
            expected = (axis[2] if is_data else same)(np.asarray(given, float))
            np.testing.assert_allclose(np.asarray(shown, float), expected, rtol=1e-15, atol=0)
    limits = zip(
        (plain.get_xlim(), plain.get_ylim()), (in_si.get_xlim(), in_si.get_ylim()), axes, strict=True
    )
    for given, shown, axis in limits:
        assert shown == pytest.approx(axis[2](np.array(given)), rel=1e-9)


@pytest.mark.parametrize(
    "name", ["safe_basin", "overturning", "basins", "parametric_map", "overturning_spectrum"]
)
def test_survey_in_the_units_of_a_block_has_its_name(name):
    assert axes_of(name, block=BLOCK).get_title(loc="left") == "block 2 m × 0.5 m"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_axes_given_are_drawn_into_and_returned(name):
    _, (left, right) = rk.plot.panels(columns=2)
    assert axes_of(name, ax=right) is right
    assert right.has_data()
    assert not left.has_data()
    for argument, message in {"ax": "an? Axes; got 3$", "block": "a Block; got 3 "}.items():
        with pytest.raises(TypeError, match=f"^{argument} must be {message}"):
            axes_of(name, **{argument: 3})


KINDS = {
    **dict.fromkeys(("time_history", "phase_portrait", "overview", "animation"), "a Motion"),
    "section": "a Motion or points of shape (n, 2), one at least",
    "impact_section": "a Motion or what impact_section gives",
    "manifolds": "a SaddleManifolds",
    "convergence": "a LyapunovSpectrum",
    "spectrum": "a SpectralDensity",
    "branch": "a Branch or a sequence of them",
    "bifurcation_curve": "a BifurcationCurve or a sequence of them",
    "frequency_response": "a FrequencyResponse",
    "orbit_diagram": "an OrbitDiagram",
    "response_diagram": "a ResponseDiagram",
    "basins": "a BasinMap",
    "safe_basin": "a SafeBasin",
    "overturning": "an OverturningCurve",
    "parametric_map": "a map over two axes, as parametric_map gives it, or the folder of its store",
    "overturning_spectrum": "an overturning spectrum, as rocking.overturning_spectrum gives it",
    "rocking_spectrum": "a rocking spectrum, as rocking.rocking_spectrum gives it",
    "fragility": "a Fragility",
    "incremental_dynamic_analysis": "an IncrementalDynamicAnalysis",
    "overturning_set": "an OverturningSet",
    "chaos_share": "a ChaosShare",
    "repeatability": "a Repeatability",
    "restitution_fit": "a RestitutionFit",
    "slip": "a Slip",
    "repeatability_map": "a RepeatabilityMap",
    "correlation_dimension": "a CorrelationDimension",
    "verdict": "a Verdict",
}


@pytest.mark.parametrize("name", KINDS)
def test_other_than_the_result_of_its_function_is_refused(name):
    path = ["a.gif"] if name == "animation" else []
    for wrong in (3, made("rotation number")):
        with pytest.raises((TypeError, ValueError), match=f"^result must be {re.escape(KINDS[name])}; got "):
            getattr(rk.plot, name)(wrong, *path)


def film(name="a.gif", **how):
    return rk.plot.animation(made("motion"), name, **how)


def history(cycles):
    return rk.plot.time_history(made("motion"), cycles=cycles)


def map_over(name):
    return made("map").dataset.rename(period=name).drop_attrs()


POINTS = "result must be a Motion or points of shape (n, 2), one at least; got …"
MAP = "result must be a map over two axes, as parametric_map gives it…"
NO_CYCLES = "cycles must be omitted for a base motion of finite length…"
NO_PERIOD = "system must have a periodic base motion, rk.Harmonic…"
WRONG_TYPES = [
    ("path must be the name of a file that ends in .gif, .mp4; got 3", lambda: film(3)),
    ("block must be a Block; got 3 …", lambda: film(block=3)),
    ("block must be a Block; got 0 …", lambda: film(block=0)),
    ("figure must be a matplotlib Figure or Axes; got 3", lambda: rk.plot.save(3, "a.png")),
    (
        "path must be the name of a file that ends in .png, .svg, .pdf; got 3",
        lambda: rk.plot.save(Figure(), 3),
    ),
    ("dpi must be a real number in [10, 2400]; got 'fine'", lambda: rk.plot.save(Figure(), "a.png", "fine")),
    ("block must be a Block; got 3 …", lambda: rk.plot.schematic(block=3)),
    ("ax must be an Axes; got 3", lambda: rk.plot.schematic(ax=3)),
    ("lean must be a real number in [-1, 1]; got 'x'", lambda: rk.plot.schematic(lean="x")),
    ("cycles must be a pair (first, last); got 10", lambda: history(10)),
    ("cycles must be a real number…", lambda: history(("a", 2))),
    (NO_PERIOD, lambda: rk.plot.section(rk.simulate(SHAKEN))),
    (NO_PERIOD, lambda: rk.spectral_density(rk.simulate(SHAKEN))),
    ("phase must be a real number in [-1000, 1000]; got 'a'", lambda: rk.plot.section([[1, 2]], phase="a")),
    *((POINTS, lambda wrong=wrong: rk.plot.section(wrong)) for wrong in (None, "abc", [[1, 2], [3]])),
    (
        "result must be a Motion or what impact_section gives; got …",
        lambda: rk.plot.impact_section(np.zeros((3, 2))),
    ),
    ("result must be a Branch or a sequence of them; got []", lambda: rk.plot.branch([])),
    (
        "branches must be a sequence of branches from continue…",
        lambda: axes_of("orbit_diagram", branches=[3]),
    ),
    ("block must be a Block; got 2.0 (make one: …", lambda: axes_of("response_diagram 2", block=2.0)),
    ("block must be a Block; got 3 …", lambda: rk.plot.overview(made("motion"), 3)),
    ("block must be a Block; got 3 …", lambda: rk.plot.verdict(made("verdict"), 3)),
    (
        "result must be an overturning spectrum, as rocking.overturning_spectrum gives it…",
        lambda: rk.plot.overturning_spectrum(made("overturning spectrum").dataset.drop_vars("margin")),
    ),
    *((MAP, lambda wrong=wrong: rk.plot.parametric_map(wrong)) for wrong in (xr.Dataset(),)),
]
WRONG_VALUES = [
    ("path must end in .gif, .mp4; got '…a.avi'", lambda: film("a.avi")),
    ("seconds must lie in [0.1, 600]; got 0", lambda: film(seconds=0)),
    ("fps must lie in [1, 100]; got 1000", lambda: film(fps=1000)),
    ("cycles must lie in [0, 20]; got 30", lambda: film(cycles=(3, 30))),
    ("path must end in .png, .svg, .pdf; got '…a.jpg'", lambda: rk.plot.save(Figure(), "a.jpg")),
    ("cycles must lie in [0, 20]; got 31", lambda: history((5, 31))),
    ("cycles must lie in [0, 20]; got -1", lambda: history((-1, 3))),
    ("cycles must lie in [0, 20]; got nan", lambda: history((math.nan, 5))),
    ("cycles must be a pair (first, last) with first < last; got (5, 5)", lambda: history((5, 5))),
    ("record must be 'all'…", lambda: rk.plot.time_history(made("section"))),
    (NO_CYCLES, lambda: rk.plot.time_history(rk.simulate(SHAKEN), cycles=(0, 1))),
    (NO_CYCLES, lambda: rk.plot.phase_portrait(rk.simulate(SHAKEN), cycles=(0, 1))),
    *(
        (
            f"transient must be a whole number in [0, 20]; got {wrong}",
            lambda wrong=wrong: axes_of("section", transient=wrong),
        )
        for wrong in (21, -1, 1.5, math.nan)
    ),
    *(
        (POINTS, lambda wrong=wrong: rk.plot.section(wrong))
        for wrong in ([], [1, 2], [[1, 2, 3]], np.empty((0, 2)))
    ),
    (
        "result must hold an impact after the transient; got 0",
        lambda: rk.plot.impact_section(rk.impact_section(SYSTEM, cycles=20)[:0]),
    ),
    (
        "transient must be a whole number in [0, 18]; got 19",
        lambda: rk.plot.impact_section(rk.impact_section(SYSTEM, cycles=20), transient=19),
    ),
    *(
        (
            "exponent must be a whole number in [1, 2]; got …",
            lambda wrong=wrong: axes_of("convergence", exponent=wrong),
        )
        for wrong in (0, 3, math.nan)
    ),
    (
        "result must hold pairs that scale; got '2 isolated points'",
        lambda: rk.plot.correlation_dimension(
            rk.correlation_dimension(np.resize([[0.0, 1.0], [1.0, 0.0]], (1_000, 2)))
        ),
    ),
    ("highest must lie in [0.1, 1000]; got 0.0", lambda: axes_of("spectrum", highest=0.0)),
    ("names must be a whole number in [0, 100]; got 1.5", lambda: axes_of("spectrum", names=1.5)),
    (
        "result must hold branches over one parameter, amplitude; got 'period'",
        lambda: rk.plot.branch([result("branch"), result("branch over the period")]),
    ),
    ("quantity must be one of 'angle', …", lambda: axes_of("branch", quantity="speed")),
    ("phase must lie in…", lambda: axes_of("branch", phase=math.nan)),
    (
        "quantity must be one of 'angle', 'velocity', 'peak'…",
        lambda: axes_of("orbit_diagram", quantity="speed"),
    ),
    (
        "branches must run over amplitude, as the diagram does; got 'period'",
        lambda: axes_of("orbit_diagram", branches=[result("branch over the period")]),
    ),
    (MAP, lambda: rk.plot.parametric_map([])),
    (MAP, lambda: rk.plot.parametric_map(map_over("angle").isel(angle=0))),
    ("curves must be …got 'A_M'", lambda: axes_of("parametric_map", curves=["A_M"])),
    (
        "symbols must be one of 'kinds', '10', '11', '13b'; got '12'",
        lambda: axes_of("parametric_map", symbols="12"),
    ),
    (
        "curves must lie over a map of the amplitude and …; got 'amplitude and angle'",
        lambda: rk.plot.parametric_map(map_over("angle"), curves=["melnikov"]),
    ),
    ("result must be the folder of a map's store…", lambda: rk.plot.parametric_map(Path())),
    (
        "result must vary over one quantity to be drawn…",
        lambda: rk.plot.overturning(
            rk.overturning_amplitude(
                SYSTEM, period=[1.2, 2.2], restitution=[0.8, 0.9], amplitude=[1.0, 3.0], phases=1
            )
        ),
    ),
    (
        "fractiles must hold 1 to 3 fractions…",
        lambda: made("incremental dynamic analysis").plot(fractiles=[0.1, 0.2, 0.3, 0.4]),
    ),
    (
        "result must have at most 3 limits to be drawn; got 4",
        lambda: rk.fragility(RECORDS, BLOCK, [1.0, 5.0], limits=[0.1, 0.2, 0.3, 0.4], model="slender").plot(),
    ),
    (
        "result must vary over records, size and slenderness alone; got 'polarity' (select one value first, such…",
        lambda: rk.plot.rocking_spectrum(made("rocking spectrum").dataset.expand_dims(polarity=[1.0])),
    ),
    (
        "result must vary over size or slenderness; got ('record',)…",
        lambda: rk.plot.rocking_spectrum(made("rocking spectrum").dataset.isel(size=0, slenderness=0)),
    ),
    (
        "result must hold one record to be a map; got '3 records' (select one first, such as result.dataset.isel(record=0))",
        lambda: rk.rocking_spectrum(
            RECORDS, size=[1.0, 2.0], slenderness=np.linspace(0.1, 0.2, 7), model="slender"
        ).plot(),
    ),
    (
        "across must be one of 'size', 'frequency-parameter'…",
        lambda: made("rocking spectrum").plot(across="R"),
    ),
    (
        "unit must be one of 'critical', 'degrees'; got 'rad'",
        lambda: made("rocking spectrum").plot(unit="rad"),
    ),
    ("n must be an odd whole number…", lambda: rk.plot.modes(1.0, 0.8, 2)),
    (
        "quantity must be one of 'velocity', 'phase'; got 'speed'",
        lambda: rk.plot.modes(1.0, 0.8, quantity="speed"),
    ),
    ("restitution must lie in (0, 1] for symmetric modes…", lambda: rk.plot.modes(1.0, 0.0)),
    ("curves must hold 1 to 6 of them; got 0", lambda: rk.plot.thresholds([1, 2], {})),
    (
        "curves must have one amplitude per period, 2; got 'a: 1'",
        lambda: rk.plot.thresholds([1, 2], {"a": [1]}),
    ),
]


@pytest.mark.parametrize(
    "error, message, call",
    [
        *((TypeError, *row) for row in WRONG_TYPES),
        *((ValueError, *row) for row in WRONG_VALUES),
        (
            FileNotFoundError,
            "path must lie in an existing folder…",
            lambda: rk.plot.save(Figure(), "nowhere/a.png"),
        ),
    ],
)
def test_what_cannot_be_drawn_is_refused_in_one_line_and_leaves_no_file(
    tmp_path, monkeypatch, error, message, call
):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(error) as refused:
        call()
    told, (start, more, end) = str(refused.value), message.partition("…")
    assert told.startswith(start) and told.endswith(end) if more else told == message
    assert "\n" not in told
    assert not list(tmp_path.iterdir())
