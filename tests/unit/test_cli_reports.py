"""What the commands print, apart from what tests/golden holds: notes and warnings, rows of records, and tables in files."""

import csv
import json
import math
import re
import sys
from pathlib import Path
from types import SimpleNamespace

import attrs
import numpy as np
import pytest
import xarray as xr

import record_files as write
import rocking as rk
from rocking.cli.reports_motion import margin_text, record_figure, record_outcome, undecided
from rocking.cli.reports_records import few_records
from rocking.model.quantity import IN_SI
from rocking.records.read import FILE as EXAMPLE_FILE

BLOCK = rk.Block(2.0, 0.5)
SIZE = "--height 2 --width 0.5"
SI = f"{SIZE} --acceleration 2.9 --frequency-hz 1.8"
NORMALISED = "--amplitude 2 --period 1 --restitution 0.925"
CHATTER = "--amplitude 0 --period 1 --restitution 0.9 --angle 0.5"
pytestmark = [
    pytest.mark.usefixtures("records"),
    pytest.mark.filterwarnings("ignore:.*each copy counts"),
]


def printed(rocking, line):
    code, message, out = rocking(line)
    assert (code, message) == (0, "")
    return out


def told(rocking, line):
    """Return the first line, and all that is printed on one line."""
    out = printed(rocking, line)
    return out.splitlines()[0], " ".join(out.split())


def read(rocking, line):
    return json.loads(printed(rocking, f"{line} --json"), parse_constant=pytest.fail)


def rows_of(rocking, line):
    printed(rocking, f"{line} --csv a.csv")
    with Path("a.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def table_of(rocking, line):
    rows = rows_of(rocking, line)
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def simulated(name, scale=1.0):
    return rk.simulate(BLOCK.system(rk.read_ground_motion(name).scaled(scale), model="slender"))


# Motions.


@pytest.mark.parametrize("line", [CHATTER, f"{SI} --restitution 0.5"])
def test_what_is_told_does_not_depend_on_the_files_asked_for(rocking, line):
    bare, written = read(rocking, f"simulate {line}"), read(rocking, f"simulate {line} --csv a.csv")
    assert bare == written | {"files": []}
    assert not bare["impacts_cut_short"]


def test_longest_run_that_is_kept_counts_every_impact_and_a_longer_one_says_that_it_does_not(rocking):
    every = len(rk.simulate(rk.System(rk.Harmonic(0.0, period=1.0), 0.9), rk.State(0.5), cycles=200).events)
    kept = read(rocking, f"simulate {CHATTER} --cycles 100000")
    assert (kept["impacts"] + 1, kept["impacts_cut_short"]) == (every, False)  # and that it comes to rest
    longer = read(rocking, f"simulate {CHATTER} --cycles 100001")
    assert longer["impacts"] < kept["impacts"]
    assert longer["impacts_cut_short"]
    note = "(without the last ones of chattering before rest)"
    assert note in printed(rocking, f"simulate {CHATTER} --cycles 100001")
    assert "chattering" not in printed(rocking, f"simulate {CHATTER}")


@pytest.mark.parametrize(
    "line, files, shorter",
    [
        (f"simulate {SI} --cycles 50", "--plot, --csv", "reduce --cycles, or "),
        (f"record pulse.csv {SIZE}", "--csv", ""),
    ],
)
def test_more_events_than_are_kept_are_counted_and_refused_only_to_a_file(
    rocking, monkeypatch, line, files, shorter
):
    monkeypatch.setattr("rocking.motion.march_loop.MAX_RECORDED", 10)
    unchecked = "warning: sliding and jumping of the block were not checked: too many events to keep"
    assert unchecked in printed(rocking, line)
    assert ("at rest permanently" in told(rocking, line)[0]) == line.startswith("record")
    typed = " ".join(f"{name} a.{'png' if name == '--plot' else 'csv'}" for name in files.split(", "))
    message = f"too many events for {files}: {shorter}omit {files}"
    assert rocking(f"{line} {typed}")[:2] == (2, message)


def test_no_number_is_cut_or_split_however_narrow_the_terminal(rocking, monkeypatch):
    line = f"simulate {SI} --cycles 50 --brace-angle 0.123456 --brace-restitution 0.654321"
    monkeypatch.setenv("COLUMNS", "20")
    narrow = printed(rocking, line)
    monkeypatch.setenv("COLUMNS", "1000")
    assert narrow == printed(rocking, line)
    assert "…" not in narrow
    assert any(text.startswith("final state ") and text.endswith("°/s") for text in narrow.splitlines())


@pytest.mark.parametrize(
    ("variables", "bold"), [({"TERM": "xterm"}, True), ({"TERM": "dumb"}, False), ({"NO_COLOR": "1"}, False)]
)
def test_first_line_is_bold_on_a_terminal_with_colours(rocking, monkeypatch, variables, bold):
    monkeypatch.delenv("NO_COLOR", raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(type(sys.stdout), "isatty", lambda stream: stream is sys.stdout)
    first = printed(rocking, f"simulate {NORMALISED}").splitlines()[0]
    assert first.startswith("\x1b[1mbounded") == first.endswith("\x1b[0m") == bold


def test_csv_holds_the_motion_at_a_hundred_steps_a_cycle(rocking):
    table = table_of(rocking, f"simulate {SI} --cycles 7")
    system = BLOCK.system(acceleration=2.9, frequency_hz=1.8)
    motion = rk.simulate(system, cycles=7)
    times = np.arange(701) * system.forcing.period / 100
    angle, velocity = motion.at(np.minimum(times, motion.duration))
    expected = {
        "time [s]": np.arange(701) / 180,
        "angle [rad]": angle * np.arctan(0.25),
        "velocity [rad/s]": velocity * np.arctan(0.25) * BLOCK.frequency_parameter,
        "top_displacement [m]": 2.0 * np.sin(angle * np.arctan(0.25)),
    }
    assert list(table) == list(expected)
    for name, values in expected.items():
        np.testing.assert_allclose(table[name], values, rtol=1e-12, atol=1e-13)


def test_csv_of_a_long_motion_goes_on_in_even_steps(rocking, monkeypatch):
    monkeypatch.setattr("rocking.cli.reports_motion.ROWS_AT_ONCE", 1_000)
    table = table_of(rocking, f"simulate {NORMALISED} --cycles 25")
    assert [len(column) for column in table.values()] == [2_501] * 3
    # The steps stay even where the table goes on in a new batch of rows: 1e-2, but for the rounding of 25.
    np.testing.assert_allclose(np.diff(next(iter(table.values()))), 0.01, rtol=0, atol=1e-14)


# Records.


def test_csv_has_a_row_per_sample_of_the_record_at_least(rocking):
    table = table_of(rocking, f"record example {SIZE} --pga-g 0.5 --model slender")
    motion = rk.simulate(BLOCK.system(rk.example_ground_motion().scaled(pga=0.5 * 9.80665), model="slender"))
    np.testing.assert_allclose(table["time [s]"], 0.005 * np.arange(6001), rtol=0, atol=1e-9)
    angle, _ = motion.at(np.minimum(BLOCK.time(table["time [s]"]), motion.duration))
    np.testing.assert_allclose(table["angle [rad]"], BLOCK.radians(angle), rtol=1e-9, atol=1e-12)
    assert not any("cycle" in name for name in table)
    # coarse samples are divided into whole parts
    step = table_of(rocking, f"record pulse.csv {SIZE}")["time [s]"][1]
    assert step <= BLOCK.seconds(1 / 32)
    assert 0.2 / step == pytest.approx(round(0.2 / step), abs=1e-9)


def test_margin_has_the_sign_of_what_it_says(rocking):
    for motion in (simulated("pulse.csv", scale) for scale in (1.0, 3.0)):
        said = margin_text(motion, BLOCK)
        assert ("lacked" in said) == (motion.margin < 0)
        assert f"{math.degrees(BLOCK.radians_per_second(abs(motion.margin))):.4g}°/s" in said
    early = attrs.evolve(simulated("push.csv"), margin=-0.1)
    assert margin_text(early, BLOCK).endswith("°/s to overturn, but overturned later")
    assert margin_text(attrs.evolve(early, outcome=rk.Outcome.BOUNDED), BLOCK).endswith("°/s to overturn")
    assert "the block had" in told(rocking, f"record push.csv {SIZE} --model slender")[1]


def test_block_that_moves_may_have_no_margin(rocking):
    tied = "--restrainer-stiffness 2e5 --restrainer-prestress 1500 --mass 600"
    text = told(rocking, f"record example --height 2 --width 0.6 {tied} --pga-g 0.8")[1]
    assert "largest |θ| 4.554°" in text
    assert "margin K none was found" in text


def test_motion_without_losses_is_followed_for_the_length_of_the_record(rocking):
    line = f"record pulse.csv {SIZE} --restitution 1"
    first, text = told(rocking, f"{line} --brace-angle 0.5 --model slender")
    assert first == "bounded over 0.8 s (neither rest nor overturning was proved)"
    assert "restitution e = 1, as given" in text
    assert "braces 7.018°, r = 1" in text
    assert "margin K₊ undefined between braces" in text
    error = 100 * (1 - BLOCK.critical_angle / math.tan(BLOCK.critical_angle))  # upright: at θ = θcr
    assert f"small angles; a/(g tan θcr), moments wrong by up to {error:.1f} % time unit" in text
    _, text = told(rocking, f"{line} --model slender --normalised-by angle")
    error = 100 * (1 / math.cos(BLOCK.critical_angle) - 1)
    assert (
        f"small angles; moments overestimated by up to {error:.1f} % (--model full avoids this) time unit"
        in text
    )
    assert (
        told(rocking, f"{line} --model full")[0]
        == "bounded over 0.8 s (neither rest nor overturning was proved)"
    )


def test_undecided_outcome_is_said_in_the_first_line_and_in_a_warning():
    motion = simulated("gentle.csv")
    doubtful = attrs.evolve(motion, certified=False)
    assert (
        record_outcome(doubtful, BLOCK) == f"{record_outcome(motion, BLOCK)} (undecided in double precision)"
    )
    assert list(undecided(motion)) == []
    assert len(list(undecided(doubtful))) == 1


def test_header_that_contradicts_its_samples_is_a_warning(rocking):
    text = EXAMPLE_FILE.read_text(encoding="latin-1")
    Path("other.smc").write_text(text.replace("0.1044078E+03", "0.2222222E+03"), encoding="latin-1")
    _, said = told(rocking, f"record other.smc {SIZE}")
    assert "PGA in the header 2.222 m/s², differs from the samples, 1.044 m/s²" in said
    warning = "other.smc: the samples have a PGA of 1.0441 m/s², the header states 2.2222 m/s²"
    assert f"warning: {warning}" in said
    assert read(rocking, "spectrum other.smc --size 0.3:3:4 --slenderness-deg 10")["warnings"] == [warning]


def test_vertical_channel_is_a_warning(rocking):
    lines = "\n".join(write.csmip_v1([0.3 * np.sin(np.arange(60))] * 3)).replace("270 Deg", "Up")
    Path("three.v1").write_text(lines, encoding="utf-8")
    said = "warning: the component Up is vertical, and the base moves horizontally: choose a horizontal component"
    assert said in told(rocking, f"record three.v1 --channel 3 {SIZE}")[1]
    assert "vertical" not in told(rocking, f"record three.v1 --channel 2 {SIZE}")[1]


def test_drift_is_a_warning_with_the_baseline_as_remedy(rocking):
    shaken = rk.synthetic_ground_motions(1, seed=3, duration=59.99)[0].acceleration
    rows = map("{:.2f}, {:.6f}".format, 0.01 * np.arange(6_000), shaken + 0.05)
    Path("drift.csv").write_text("\n".join(["time (s), acceleration (m/s²)", *rows]), encoding="utf-8")
    drift = "the PGV and PGD are those of a drift, because "
    text = told(rocking, f"record drift.csv {SIZE}")[1]
    assert f"warning: {drift}no baseline is removed and the velocity at" in text
    assert "for example --baseline='linear'" in text
    assert "drift of" not in told(rocking, f"record drift.csv {SIZE} --baseline linear")[1]
    assert "those of a drift" not in told(rocking, f"record example {SIZE}")[1]
    for level, ends in (
        ("pgv 0.1:1:4", ["or for example --baseline='linear'"]),
        ("pgv 0.1:1:4 --baseline linear", ["or for example --baseline='quadratic'"]),
        ("pga 1:5:4", []),
    ):
        found = read(rocking, f"fragility push.csv {SIZE} --{level}")["warnings"]
        found = [each for each in found if drift in each]
        assert [each.startswith(f"push.csv: {drift}") for each in found] == [True] * len(ends)
        assert [each.partition(": use a corrected record, ")[2] for each in found] == ends


def test_fewer_than_ten_records_are_warned_of():
    assert list(few_records(10)) == []
    assert list(few_records(9)) == ["9 records can hardly say how much records differ: use 10 or more"]


def test_file_named_like_an_option_keeps_its_name(rocking):
    Path("step.txt").write_text("0\n1\n", encoding="utf-8")
    assert rocking(f"record step.txt {SIZE}")[1].startswith("step.txt: the file does not state the unit")


def test_fit_and_limits_of_several_records_are_those_of_the_function(rocking):
    found = rk.fragility(
        rk.read_record_set(["set/a.AT2", EXAMPLE_FILE]),
        BLOCK,
        np.linspace(0.2, 1.4, 13),
        intensity="pga-g",
        limits=0.5,
        model="slender",
        normalised_by="angle",
    )
    out = printed(
        rocking,
        f"fragility set/a.AT2 example {SIZE} --pga-g 0.2:1.4:13 --limit 0.5 --model slender --normalised-by angle",
    )
    title, heading, *_, median, dispersion, _, _ = out.splitlines()
    fit = found.fit()
    assert title == str(found)
    assert [each.strip() for each in heading.split("   ") if each][:2] == ["PGA (g)", "|θ| > 7.02° = 0.5 θcr"]
    assert median.endswith(f"{fit.median:.3g} ({fit.median_low:.3g}–{fit.median_high:.3g})")
    assert dispersion.endswith(f"{fit.dispersion:.3g} ({fit.dispersion_low:.3g}–∞)")


def test_hazard_adds_the_rates_of_the_function(rocking):
    Path("hazard.csv").write_text("PGA (g),annual rate\n0.1,0.02\n0.3,0.003\n0.9,0.0002\n", encoding="utf-8")
    found = rk.fragility(
        rk.read_record_set(["set/a.AT2", EXAMPLE_FILE]),
        BLOCK,
        np.linspace(0.2, 1.4, 13),
        intensity="pga-g",
        limits=0.5,
        replicates=200,
        seed=3,
        model="slender",
        normalised_by="angle",
    )
    how = "--model slender --normalised-by angle --limit 0.5 --replicates 200 --seed 3"
    line = f"fragility set/a.AT2 example {SIZE} --pga-g 0.2:1.4:13 {how}"
    hazard = ([0.1, 0.3, 0.9], [0.02, 0.003, 2e-4])
    rates = [rk.overturning_rate(found, hazard, limit=k, replicates=200, seed=3) for k in (0.5, math.inf)]
    lines = printed(rocking, f"{line} --hazard hazard.csv").splitlines()
    assert [each for each in lines if "annual rate" in each] == list(map(str, rates))
    told_rates = read(rocking, f"{line} --hazard hazard.csv")["rates"]
    assert [each["rate"] for each in told_rates] == [each.rate for each in rates]
    assert "rates" not in read(rocking, line)
    none = read(rocking, f"fragility set/a.AT2 example {SIZE} --pga 0.1:0.2:2 --hazard hazard.csv")
    assert none["rates"] == []
    reason = "no annual rate: no fit for overturning: no run shows overturning: add higher levels"
    assert reason in none["warnings"]


def test_table_of_a_hazard_is_read_before_the_runs(rocking):
    Path("hazard.csv").write_text("PGA (g),annual rate\n0.1,0.02\n0.3,0.003\n", encoding="utf-8")
    line = f"fragility example {SIZE} --pgv 0.1:1:4 --hazard"
    units = "hazard.csv, line 1: the levels are in g; those of the fragility are in m/s"
    assert rocking(f"{line} hazard.csv")[:2] == (2, units)
    assert rocking(f"{line} none.csv")[1].startswith("none.csv: cannot be read: No such file")
    over = "--csv must not overwrite the table of the hazard; got 'hazard.csv'"
    assert rocking(f"{line} hazard.csv --csv hazard.csv")[:2] == (2, over)


def test_one_level_gives_the_probability_under_the_records_as_they_are(rocking):
    fell = [
        rk.simulate(BLOCK.system(motion, model="slender")).outcome == "overturned"
        for motion in rk.read_record_set("set")
    ]
    assert f"{100 * np.mean(fell):g} % (" in printed(rocking, f"fragility set {SIZE} --scale 1")
    found = rk.fragility(
        rk.read_record_set("set"), BLOCK, [1.0], intensity="scale", limits=(), model="slender"
    )
    with pytest.raises(rk.TooShort, match="give two levels or more"):
        found.fit()


def test_spectrum_of_several_records_states_their_range(rocking):
    found = rk.rocking_spectrum(
        rk.read_record_set("set"),
        size=np.linspace(0.3, 3, 10),
        slenderness=np.radians(10),
        model="slender",
    ).dataset
    text = told(rocking, "spectrum set --size 0.3:3:10 --slenderness-deg 10 --model slender")[1]
    stands = found.peak.values[np.isfinite(found.peak)].max()
    pga = sorted(motion.pga for motion in rk.read_record_set("set"))
    for shown in (
        "rocking spectrum, 20 runs records 2: a.AT2, 180, b.AT2, 180",
        f"PGA {pga[0]:.6g} to {pga[1]:.6g} (2) m/s², times 1",
        f"overturned {5 * int(np.isinf(found.peak).sum()):.1f} %",
        f"largest |θ| of blocks that stand {10 * stands:.4g}°, {stands:.4g} θcr",
        f"largest R that overturns {found['size'].values[np.isinf(found.peak).any('record')].max():.6g} m",
    ):
        assert shown in text


def test_table_of_a_spectrum_has_the_largest_angle_also_in_rad(rocking):
    rows = rows_of(rocking, "spectrum set --size 0.3:3:4 --slenderness-deg 8:10:2 --model slender")
    assert list(rows[0])[:6] == ["record", "name", "size [m]", "slenderness [rad]", "outcome", "certified"]
    found = rk.rocking_spectrum(
        rk.read_record_set("set"),
        size=np.linspace(0.3, 3, 4),
        slenderness=np.radians(np.linspace(8, 10, 2)),
        model="slender",
    ).dataset
    for heading, values in (
        ("peak [theta_cr]", found.peak.values),
        ("margin [alpha theta_cr]", found.margin.values),
        ("peak [rad]", found.peak.values * found.slenderness.values),
    ):
        np.testing.assert_array_equal([float(row[heading]) for row in rows], values.ravel())
    assert {row["name"] for row in rows} == {"a.AT2, 180", "b.AT2, 180"}
    assert np.isinf(found.peak).any()
    for row in rows_of(rocking, "spectrum set --size 0.3:3:4 --slenderness-deg 8"):
        assert float(row["peak [rad]"]) == pytest.approx(np.radians(8) * float(row["peak [theta_cr]"]))


# Responses and orbits.


def test_way_out_is_named_as_it_is_typed(rocking):
    line = "--amplitude 10.103037 --period 1.721328 --restitution 0.8 --max-cycles 500"
    first, text = told(rocking, f"classify {line}")
    assert first.startswith(
        "undetermined: no orbit of period up to 64 was reached, and 500 cycles are too few"
    )
    assert "Evidence: none, after 500 cycles; increase --max-cycles to 10,000 or more." in text
    assert "max_cycles" not in text


def test_special_points_are_printed_to_ten_digits(rocking):
    out = printed(rocking, "continue --amplitude 7:0.1 --period 1.721328 --restitution 0.8")
    (fold,) = (line.split()[-1] for line in out.splitlines() if line.startswith("fold "))
    assert float(fold) == pytest.approx(rk.theory.existence_amplitude(1.721328, 0.8, 1), abs=1e-9)


def test_orbit_is_found_where_asked_and_followed_both_ways(rocking):
    found = read(rocking, "continue --amplitude 10:30 --at 15 --period 1 --restitution 0.9 --step 0.05")
    assert (found["orbit"]["amplitude"], found["period"]) == (15.0, 1.0)
    assert [each["amplitude"] for each in found["end"]] == [10.0, 30.0]
    (special,) = found["special"]
    closed_form = rk.theory.symmetry_breaking_amplitude(1.0, 0.9, 1)
    assert special["kind"] == "symmetry-breaking"
    assert special["amplitude"] == pytest.approx(closed_form, abs=1e-9)


def test_response_period_finds_an_unstable_orbit_near_the_initial_state(rocking):
    line = "continue --amplitude 5:6.5 --at 5.5 --period 0.5 --restitution 0.925 --angle 0.064 --velocity 0.054 --step 0.05"
    found = read(rocking, f"{line} --response-period 3")
    orbit = rk.find_orbit(rk.System(rk.Harmonic(5.5, period=0.5), 0.925), rk.State(0.064, 0.054), 3)
    assert found["orbit"] == json.loads(json.dumps(orbit.to_dict()))
    assert (found["orbit_period"], found["orbit"]["stability"]) == (3, "unstable")
    assert read(rocking, line)["orbit"]["stability"] == "stable"


def test_long_list_of_orbits_is_cut_in_the_text_alone(rocking, monkeypatch):
    monkeypatch.setattr("rocking.cli.reports_orbits.MAX_ROWS", 1)
    line = "orbits --amplitude 5.5 --period 0.5 --restitution 0.925 --max-period 1"
    listed = printed(rocking, line).partition("\n\n")[2].splitlines()
    assert len(read(rocking, line)["orbit"]) == 3
    assert listed[2:] == ["and 2 more (all of them with --json, --csv or --netcdf)"]


def test_modes_in_json_agree_with_the_closed_forms(rocking):
    found = read(rocking, "modes --amplitude 6.5 --period 0.4 --restitution 0.925 -n 3")
    (given,), (mode,) = found["mode"], rk.theory.symmetric_modes(6.5, 0.4, 0.925, 3)
    for name in ("velocity", "phase", "trace", "admissible", "peak", "stability"):
        assert given[name] == getattr(mode, name)
    for number, value in enumerate(mode.multipliers, 1):
        assert complex(given[f"multiplier_{number}_real"], given[f"multiplier_{number}_imag"]) == value
    assert (found["n"], found["heteroclinic_amplitude"]) == (
        3,
        rk.theory.heteroclinic_amplitude(0.4, 0.925),
    )


# Surveys of systems.


def test_basins_above_the_tangency_are_not_called_smooth(rocking):
    """A = 3.7 lies above A* = 3.6878, from which on the boundary of overturning is fractal, exactly."""
    line = "basins --period 1 --restitution 0.8 --angle=-1:1:40 --velocity=-1:1:40 --amplitude"
    out = printed(rocking, f"{line} 3.7 --boundary-runs 20000")
    (boundary,) = (each for each in out.splitlines() if each.strip().startswith("boundary of overturning"))
    assert "smooth" not in boundary
    assert "undecided: 0.72–1.13 contains 1" in boundary
    assert "fractal above A* = 3.68781" in out
    below = printed(rocking, f"{line.replace('40', '5')} 3.6 --boundary-runs 0")
    assert "theoretical boundary" not in below


@pytest.mark.parametrize(("kind", "known"), [("", True), ("--offset 0.01", False), ("--model full", False)])
def test_tangency_is_that_of_the_slender_symmetric_block_alone(rocking, kind, known):
    block = "--height 2 --width 0.6 --acceleration-g 0.25 --period-s 0.8"
    out = printed(rocking, f"basins {block} --samples 5 --boundary-runs 0 {kind}")
    assert ("theoretical boundary" in out) is known


def test_absent_counts_are_nan_and_infinitely_many_are_inf(rocking):
    """The dataset has integers there: 0 for no period, -1 for no number of impacts or infinitely many."""
    rows = rows_of(rocking, "map --amplitude 0.5:1.05:2 --period 3:6:2 --restitution 0.5 --max-cycles 300")
    assert [row["kind"] for row in rows] == ["rest", "rest", "periodic", "periodic"]
    counts = [(row["response_period [cycles]"], row["impacts_per_period"]) for row in rows]
    assert counts == [("nan", "nan"), ("nan", "nan"), ("1", "inf"), ("1", "inf")]
    starts = "--angle=-1:1:3 --velocity=-1:1:3 --boundary-runs 0"
    rows = rows_of(rocking, f"basins --amplitude 2 --period 1 --restitution 0.9 {starts}")
    names = ("response_period [cycles]", "impacts_per_period", "brace_hits_per_period")
    assert {row[name] for row in rows if row["kind"] == "overturned" for name in names} == {"nan"}


def test_quantities_given_in_si_are_written_as_they_were_given(rocking):
    """Normalised and converted back, 3 m/s² is 2.9999999999999996, and 2 Hz is 1.9999999999999998."""
    rows = rows_of(rocking, f"map {SIZE} --acceleration 1:6:11 --frequency-hz 1:3:9 --max-cycles 20")
    for heading, values in (
        ("acceleration [m/s^2]", np.linspace(1, 6, 11)),
        ("frequency [Hz]", np.linspace(1, 3, 9)),
    ):
        assert list(dict.fromkeys(row[heading] for row in rows)) == [str(value) for value in values.tolist()]
    found = read(rocking, f"simulate {SIZE} --acceleration 3 --period-s 0.7 --cycles 2")
    assert (found["acceleration_m_per_s2"], found["period_s"]) == (3.0, 0.7)


def test_conversion_to_si_changes_no_number_by_more_than_rounding():
    amplitudes = np.append(np.random.default_rng(5).uniform(0, 20, 2_000), [np.nan, np.inf, 0.0])
    found, plain = IN_SI["amplitude"].of(BLOCK, amplitudes), BLOCK.acceleration(amplitudes)
    np.testing.assert_allclose(found, plain, rtol=1e-15)
    assert 1_000 < (found == plain).sum() < 2_000
    assert isinstance(IN_SI["amplitude"].of(BLOCK, 1.5), float)
    assert IN_SI["period"].of(BLOCK, np.empty((0, 2))).shape == (0, 2)


# Figures, tiles and stores.


def test_picture_of_modes_has_one_legend_for_both_panels(rocking, monkeypatch):
    figures = []
    monkeypatch.setattr(rk.plot, "save", lambda figure, path: figures.append(figure))
    printed(rocking, "modes --amplitude 2 --period 1 --restitution 0.925 --plot a.png")
    assert [ax.get_legend() is None for ax in figures[0].axes] == [True, False]


@pytest.mark.parametrize("suffix", [".gif", ".mp4"])
def test_suffix_of_a_film_chooses_an_animation(rocking, monkeypatch, suffix):
    filmed = []
    monkeypatch.setattr(rk.plot, "animation", lambda *given: filmed.append(given))
    printed(rocking, f"simulate {SI} --cycles 3 --plot a{suffix}")
    ((motion, path, block),) = filmed
    assert (motion.cycles, path.name, block) == (3, f"a{suffix}", BLOCK)


MAP = "map --amplitude 0:16:20 --period 0.2:3:18 --restitution 0.9 --max-cycles 100"


def test_curves_and_symbols_are_drawn_into_the_picture(rocking, monkeypatch):
    calls = []
    monkeypatch.setattr(rk.plot, "parametric_map", lambda *_, **how: calls.append(how))
    monkeypatch.setattr(rk.plot, "save", lambda *_: None)
    printed(rocking, f"{MAP} --curves melnikov,existence-1 --symbols 11 --plot a.png")
    Path("study.toml").write_text('curves = ["melnikov", "existence-1"]\nsymbols = "11"\nplot = "a.png"\n')
    printed(rocking, f"{MAP} --study study.toml")
    assert calls == [{"block": None, "curves": ("melnikov", "existence-1"), "symbols": "11"}] * 2


def test_squat_block_with_a_restitution_is_mapped_in_its_units(rocking):
    line = (
        "map --height 0.6 --width 1.8 --acceleration 1:8:2 --frequency-hz 1:3:2 --max-cycles 5 --plot map.png"
    )
    for restitution in ("0.5", "0.5:0.6:2 --frequency-hz 1"):
        Path("map.png").unlink(missing_ok=True)
        assert "θcr = 1.25 rad = 71.6°" in printed(rocking, f"{line} --restitution {restitution}")
        assert Path("map.png").stat().st_size > 0


def test_store_and_tiles_are_those_of_the_map_in_its_units(rocking):
    found = rk.parametric_map(
        rk.System(rk.Harmonic(1.0, period=1.0), 0.9),
        amplitude=np.linspace(0.0, 16.0, 20),
        period=np.linspace(0.2, 3.0, 18),
        max_cycles=100,
    ).dataset
    for _ in range(2):
        out = printed(rocking, f"{MAP} --store map.zarr --tiles look")
        assert out.endswith("wrote map.zarr\nwrote look/index.html\n")
    assert xr.open_zarr("map.zarr", group="level-0", chunks=None, consolidated=False).load().equals(found)
    rk.plot.tiles(found, "expected")
    for path in Path("expected").rglob("*.*"):
        assert path.read_bytes() == Path("look", path.relative_to("expected")).read_bytes()
    printed(rocking, f"map {SIZE} --acceleration 1:8:4 --frequency-hz 0.5:3:5 --max-cycles 20 --tiles si")
    page = Path("si/index.html").read_text(encoding="utf-8")
    assert '"name": "frequency (Hz)"' in page
    assert "2 m × 0.5 m" in page


def test_store_of_another_survey_is_refused_by_the_names_of_options(rocking):
    """A path is told as it was typed."""
    line = "map --amplitude 1:2:3 --period 1:2:3 --restitution 0.9 --max-cycles 20 --store phase/period.zarr"
    printed(rocking, line)
    message = (
        "--store 'phase/period.zarr' holds a different survey: --restitution is 0.9 there and 0.8 here; --max-cycles is 20 there "
        "and 50 here (give another folder, or the same values)"
    )
    assert rocking(f"{line} --restitution 0.8 --max-cycles 50")[:2] == (2, message)
    chunk = Path("phase/period.zarr/level-0/cycles/c/0/0")
    chunk.write_bytes(chunk.read_bytes()[:-1])
    code, message, _ = rocking(line)
    assert code == 2
    assert f"is damaged at '{chunk}' (recompute these tiles with --repair)" in message


def test_store_of_another_block_is_refused_by_what_follows_from_the_block(rocking):
    line = "map --height 2 --acceleration 1:8:2 --frequency-hz 1:3:2 --max-cycles 5 --store map.zarr"
    printed(rocking, f"{line} --width 0.6")
    start = "--store 'map.zarr' holds a different survey: restitution, which follows from the block, is 0.876147 there and "
    message = f"{start}0.911765 here (give another folder, or the same values)"
    assert rocking(f"{line} --width 0.5")[:2] == (2, message)
    given = rocking(f"{line} --width 0.5 --restitution 0.9")[1]
    assert "--restitution is 0.876147 there and 0.9 here" in given


OF_THE_RECORD = f"example {SIZE} --pga-g 0.5:1.5:30"
STORED = {
    "basins": "--amplitude 5.5 --period 1 --restitution 0.8 --samples 50 --boundary-runs 0 --max-cycles 40",
    "safe-basin": "--amplitude 2:9:5 --period 1 --restitution 0.8 --samples 50 --max-cycles 40",
    "fragility": OF_THE_RECORD,
    "sensitivity": OF_THE_RECORD,
    "overturning-set": OF_THE_RECORD,
    "ida": OF_THE_RECORD,
    "overturning-spectrum": "--pulse one-sine --amplitude 1:10:9 --frequency 1:8:7 --restitution 0.9",
    "spectrum": "wave.txt --units g --step 0.01 --size 0.5:1:5 --slenderness-deg 8:10:2",
}


@pytest.mark.parametrize("command", STORED)
def test_a_command_with_a_store_reads_and_repairs_its_results(rocking, command):
    line = f"{command} {STORED[command]}"
    stored = f"{printed(rocking, line)}wrote kept.zarr\n"
    assert rocking(f"{line} --store kept.zarr") == (0, "", stored)
    digests = next(path for path in Path("kept.zarr").glob("level-0/*/digests/**/*") if path.is_file())
    Path(str(digests).replace("digests", "c")).write_bytes(b"")
    assert "(recompute these tiles with --repair)" in rocking(f"{line} --store kept.zarr")[1]
    assert rocking(f"{line} --store kept.zarr --repair")[2] == stored


BLOCK_ON_RECORD = "--height 2 --width 0.6 --offset 0.08 --scale 3"


def components(path, count, step=0.1, heads=("NS", "UP", "EW"), start=0):
    """Write a file of three components."""
    rows = [
        [
            place * step,
            *(2.0 * math.sin((1.0 + 0.4 * (column + start)) * place) for column in range(len(heads))),
        ]
        for place in range(count)
    ]
    lines = [",".join(["time (s)", *(f"{head} (m/s2)" for head in heads)])]
    lines += [",".join(f"{value:.6g}" for value in row) for row in rows]
    path.write_text("\n".join(lines) + "\n")


def test_vertical_component_is_not_turned(rocking, tmp_path):
    components(tmp_path / "three.csv", 30)
    line = f"record {tmp_path / 'three.csv'} {BLOCK_ON_RECORD} --azimuth-deg 30"
    assert rocking(f"{line} --channel 2")[:2] == (
        2,
        "--azimuth-deg needs a horizontal component; channel 2 of the file, 'UP', is vertical (give another --channel)",
    )
    assert rocking(f"{line} --channel 3")[0] == 0


def test_component_that_does_not_say_that_it_is_vertical_is_told(rocking, tmp_path):
    for name, head in (("push", "NS"), ("up", "UP"), ("across", "EW")):
        components(tmp_path / f"{name}.csv", 30, heads=(head,))
    line = f"record {tmp_path / 'push.csv'} {BLOCK_ON_RECORD} --scale 0.1 --json --vertical"
    sentence = "the component EW does not say that it is vertical: --vertical takes it as vertical"
    for name, told in (("up", False), ("across", True)):
        code, _, out = rocking(f"{line} {tmp_path / name}.csv")
        assert code == 0
        assert (sentence in json.loads(out)["warnings"]) is told


def test_components_of_different_length_end_together(rocking, tmp_path):
    for name, count in (("long", 40), ("short", 30), ("same", 30)):
        components(tmp_path / f"{name}.csv", count, heads=("NS",), start=name != "long")
    components(tmp_path / "cut.csv", 30, heads=("NS",))
    components(tmp_path / "coarse.csv", 30, step=0.2, heads=("NS",))
    found = {}
    for first, second in (("long", "short"), ("cut", "same")):
        files = f"{tmp_path / f'{first}.csv'} --second {tmp_path / f'{second}.csv'}"
        code, told, out = rocking(f"record {files} {BLOCK_ON_RECORD} --azimuth-deg 30 --json")
        assert (code, told) == (0, "")
        found[first] = json.loads(out)
    assert "the two components have 40 and 30 samples: both end at 2.9 s" in found["long"]["warnings"]
    assert not any("two components" in each for each in found["cut"]["warnings"])
    assert found["long"]["peak_rad"] == found["cut"]["peak_rad"] > 0
    files = f"{tmp_path / 'long.csv'} --second {tmp_path / 'coarse.csv'}"
    code, told, _ = rocking(f"record {files} {BLOCK_ON_RECORD} --azimuth-deg 30")
    assert (code, told) == (
        2,
        "--azimuth-deg needs two components with the same step; got 0.1 s and 0.2 s (resample one of them in Python, by .resampled(0.1))",
    )


def test_record_of_zeros_has_no_peak_to_scale(rocking, tmp_path):
    zeros = tmp_path / "zeros.txt"
    zeros.write_text("0\n" * 50)
    code, told, _ = rocking(f"record {zeros} --step 0.01 --units g {SIZE} --pga-g 0.5")
    assert (code, told) == (2, "--pga-g must be omitted for a record whose samples are all 0; got 0.5")


def test_record_tells_which_direction_is_the_worse_one(rocking):
    line = "record example --height 2 --width 0.6 --offset 0.08 --pga-g 0.5"
    peaks = {each: json.loads(rocking(f"{line} --polarity={each} --json")[2])["peak_rad"] for each in "+-"}
    worse = max(peaks, key=peaks.get)
    told = {"+": "worse direction +, as recorded", "-": "worse direction -, opposite to that recorded"}
    assert peaks["+"] != peaks["-"]
    assert told[worse] in re.sub(" +", " ", rocking(f"{line} --polarity worse")[2])
    other = {"+": "-", "-": "+"}[worse]
    turned = line.replace("--pga-g 0.5", "--scale=-4.69622")
    assert told[other] in re.sub(" +", " ", rocking(f"{turned} --polarity worse")[2])
    assert (
        json.loads(rocking(f"{line} --polarity worse --json")[2])["ground_motion"]["worse_direction"] == worse
    )
    assert "worse direction" not in rocking(line)[2]


def test_figure_of_a_block_that_slides_says_that_it_is_no_verdict():
    block, ground = rk.Block(2.0, 0.5), rk.example_ground_motion().scaled(pga=6.0)
    motion = rk.simulate(block.system(ground))
    for friction, slides in ((0.2, True), (0.6, False), (None, False)):
        request = SimpleNamespace(block=block, records=ground, options={"friction": friction})
        title = record_figure(rk.plot, motion, request).get_suptitle()
        assert ("no rocking verdict with a friction of 0.2" in title) == slides
