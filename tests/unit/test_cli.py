"""`rocking simulate` and common behaviour of the commands: output, files, error messages and exit codes."""

import csv
import errno
import json
import logging
import os
import re
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import rocking as rk
from rocking.cli.main import main
from rocking.model import ordinal
from rocking.papers.report.claim import Chapter, Finding
from rocking.papers.yim_lin_1991 import reproduce

NORMALISED = "--amplitude 2 --period 1 --restitution 0.925"
SI = "--height 2 --width 0.5 --acceleration 2.9 --frequency-hz 1.8"
COMMAND = [sys.executable, "-m", "rocking"]


def test_summary_tells_outcome_counts_and_final_state(rocking):
    code, message, out = rocking(f"simulate {NORMALISED} --cycles 50")
    motion = rk.simulate(rk.System(rk.Harmonic(2.0, period=1.0), 0.925), cycles=50)
    assert (code, message) == (0, "")
    assert out.startswith("bounded over 50 cycles")
    for shown in (
        f"impacts {motion.impacts}",
        f"Θ = {motion.final.angle:.6g}, Θ' = {motion.final.velocity:.6g}",
    ):
        assert shown in " ".join(out.split())


def test_frequency_says_the_same_as_period(rocking):
    by_period = rocking(f"simulate {NORMALISED} --json --cycles 5")[2]
    by_frequency = rocking(
        f"simulate --amplitude 2 --frequency {2 * np.pi} --restitution 0.925 --json --cycles 5"
    )[2]
    assert by_period == by_frequency


def test_summary_in_si_shows_both_units_housners_restitution_and_validity(rocking):
    code, _, out = rocking(f"simulate {SI} --cycles 50")
    assert code == 0
    text = " ".join(out.split())
    assert "amplitude A = 1.20712 2.9 m/s²" in text
    assert "period T = 1.48401 0.5556 s" in text
    assert "restitution e = 0.911765 Housner's value for this block" in text
    assert "least coefficient of friction without sliding" in text
    assert "restitution e = 0.5 as given" in " ".join(rocking(f"simulate {SI} --restitution 0.5")[2].split())


def test_warning_of_the_validity_report_is_shown(rocking):
    out = rocking("simulate --height 1 --width 0.9 --acceleration 12 --period-s 0.3 --cycles 5")[2]
    assert any(line.startswith("warning: ") for line in out.splitlines())


@pytest.mark.parametrize(
    ("same", "as_acceleration"),
    [
        ("--acceleration-g 0.3 --period-s 0.8", 0.3 * 9.80665),
        ("--displacement 0.05 --frequency-hz 1.25", 0.05 * (2 * np.pi * 1.25) ** 2),
    ],
)
def test_base_motion_may_be_given_in_other_units(rocking, same, as_acceleration):
    other = json.loads(rocking(f"simulate --height 2 --width 0.5 {same} --cycles 3 --json")[2])
    line = f"simulate --height 2 --width 0.5 --acceleration {as_acceleration!r} --frequency-hz 1.25 --cycles 3 --json"
    assert other["amplitude"] == pytest.approx(json.loads(rocking(line)[2])["amplitude"], rel=1e-14, abs=0)
    assert other["period"] == pytest.approx(rk.Block(2, 0.5).time(0.8), rel=1e-14, abs=0)


def test_overturning_is_told_with_its_time(rocking):
    motion = rk.simulate(rk.System(rk.Harmonic(1.75, period=2.0), 0.95))
    code, _, out = rocking("simulate --amplitude 1.75 --period 2 --restitution 0.95")
    assert code == 0
    assert out.startswith(f"overturned (proved at τ = {motion.overturning.time:.6g}, in the 6th cycle)\n")


@pytest.mark.parametrize("number", [*range(1, 25), 101, 111, 112, 113, 122, 1003])
def test_ordinals_are_those_of_english(number):
    ends = {1: "st", 2: "nd", 3: "rd"} if number // 10 % 10 != 1 else {}
    assert ordinal(number) == f"{number}{ends.get(number % 10, 'th')}"


def test_one_cycle_and_the_hits_on_the_braces_are_told_apart_from_the_impacts(rocking):
    out = rocking("simulate --amplitude 15 --period 2 --restitution 0.925 --brace-angle 1 --cycles 1")[2]
    motion = rk.simulate(rk.System(rk.Harmonic(15, period=2), 0.925, rk.Braces(1)), cycles=1)
    text = " ".join(out.split())
    assert "bounded over 1 cycle (" in text
    assert "simulated 1 cycle, τ = 2 " in text
    assert f"impacts {motion.impacts} brace impacts {motion.brace_hits} largest" in text


CHATTER = "--amplitude 0 --period 1 --restitution 0.9 --angle 0.5"


def counted(rocking, line):
    return json.loads(rocking(f"simulate {line} --json")[2])


@pytest.mark.parametrize("line", [CHATTER, f"{SI} --restitution 0.5"])
def test_what_is_told_does_not_depend_on_the_files_asked_for(rocking, line):
    bare = counted(rocking, line)
    written = counted(rocking, f"{line} --csv a.csv")
    assert bare == written | {"files": []}
    assert not bare["impacts_cut_short"]


def test_longest_run_that_is_kept_counts_every_impact_and_a_longer_one_says_that_it_does_not(rocking):
    every = len(rk.simulate(rk.System(rk.Harmonic(0.0, period=1.0), 0.9), rk.State(0.5), cycles=200).events)
    kept = counted(rocking, f"{CHATTER} --cycles 100000")
    assert (kept["impacts"] + 1, kept["impacts_cut_short"]) == (every, False)  # and that it comes to rest
    longer = counted(rocking, f"{CHATTER} --cycles 100001")
    assert longer["impacts"] < kept["impacts"]
    assert longer["impacts_cut_short"]
    assert (
        "(without the last ones of chattering before rest)"
        in rocking(f"simulate {CHATTER} --cycles 100001")[2]
    )
    assert "chattering" not in rocking(f"simulate {CHATTER}")[2]


def test_more_events_than_are_kept_are_counted_and_refused_only_to_a_file(rocking, monkeypatch):
    monkeypatch.setattr("rocking.motion.march_loop.MAX_RECORDED", 30)
    code, message, out = rocking(f"simulate {SI} --cycles 50")
    assert (code, message) == (0, "")
    assert "warning: sliding and jumping of the block were not checked: too many events to keep" in out
    assert rocking(f"simulate {SI} --cycles 50 --csv a.csv --plot a.png")[:2] == (
        2,
        "too many events for --plot, --csv: reduce --cycles, or omit --plot, --csv",
    )


def test_run_too_long_to_judge_names_the_limit_and_one_that_overturns_early_is_judged(rocking):
    line = "simulate --height 2 --width 0.5 --frequency-hz 1.2 --cycles 1000000 --acceleration"
    said = "warning: sliding and jumping of the block were not checked: more than 100,000 cycles"
    assert said in rocking(f"{line} 0.1")[2]
    early = rocking(f"{line} 3")[2]
    assert early == rocking(f"{line} 3".replace("1000000", "200"))[2]
    assert "assessed up to τ = 15.5003, where overturning is proved\n" in early


@pytest.mark.parametrize("columns", ["20", "80", "200"])
def test_no_number_is_cut_or_split_however_narrow_the_terminal(rocking, monkeypatch, columns):
    line = f"simulate {SI} --cycles 50 --brace-angle 0.123456 --brace-restitution 0.654321"
    monkeypatch.setenv("COLUMNS", columns)
    told = rocking(line)[2]
    monkeypatch.setenv("COLUMNS", "1000")
    assert told == rocking(line)[2]
    assert "…" not in told
    assert any(text.startswith("final state ") and text.endswith("°/s") for text in told.splitlines())


def test_full_equation_of_motion_is_named_and_its_doubt_is_said(rocking):
    line = "simulate --pulse one-sine --amplitude 4 --period 2.5 --restitution 0.9 --critical-angle 0.25"
    first, *rows = rocking(line)[2].splitlines()
    doubt = "(proved for the computed motion; its rounding errors are not assessed)"
    assert re.fullmatch(rf"overturned from τ = \S+ {re.escape(doubt)}", first)
    assert rows[0].split("   ", 1)[0] == "critical angle"
    assert rows[0].endswith(" θcr = 0.25 rad, full equation of motion")
    assert any(row.startswith("state when overturning was proved ") for row in rows)
    for command in ("simulate", "classify"):
        full = rocking(f"{command} {SI} --model full")[2]
        assert re.search(r"^equation of motion +full$", full, re.MULTILINE)
        assert "equation of motion" not in rocking(f"{command} {SI}")[2]


def test_size_in_centimetres_is_a_warning(rocking):
    large = SI.replace("--height 2 --width 0.5", "--height 190 --width 55")
    assert large != SI
    for line in (f"simulate {large}", f"classify {large}", f"simulate {large} --model full"):
        assert "warning: height 190 m is unusual: sizes are in metres" in rocking(line)[2]


def test_rest_is_told(rocking):
    assert rocking("simulate --amplitude 0.5 --period 1 --restitution 0.9")[2].startswith("at rest")


def test_json_agrees_with_the_motion_and_is_strict(rocking):
    line = "--phase 1.8 --velocity 0.15 --cycles 20 --brace-angle 1 --brace-restitution 0.5"
    code, _, out = rocking(f"simulate --amplitude 5.5 --period 0.5 --restitution 0.925 {line} --json")
    system = rk.System(rk.Harmonic(5.5, period=0.5, phase=1.8), 0.925, rk.Braces(1.0, 0.5))
    motion = rk.simulate(system, rk.State(velocity=0.15), cycles=20)
    told = json.loads(out, parse_constant=pytest.fail)
    assert code == 0
    assert (told["outcome"], told["impacts"], told["cycles"]) == ("bounded", motion.impacts, 20)
    assert told["final"] == pytest.approx(
        {"angle": motion.final.angle, "velocity": motion.final.velocity}, rel=1e-12, abs=0
    )
    assert told["braces"] == {"angle": 1.0, "restitution": 0.5}


def test_json_in_si_has_null_where_no_friction_suffices(rocking):
    # A block that is thrown so fast that the base would have to pull at it.
    _, _, out = rocking(f"simulate {SI} --velocity 30 --cycles 2 --json")
    assert json.loads(out, parse_constant=pytest.fail)["validity"]["friction"] is None


def test_json_in_si_has_null_where_nothing_is_judged(rocking):
    line = "simulate --height 2 --width 0.5 --acceleration 0 --period-s 1 --angle 1.2 --json"
    judged = json.loads(rocking(line)[2])["validity"]
    assert [judged[name] for name in ("friction", "friction_source", "friction_time", "reaction")] == [
        None
    ] * 4
    assert (judged["until"], judged["overturned"]) == (0.0, True)
    assert len(judged["warnings"]) == 1


def test_csv_holds_the_motion_at_a_hundred_steps_a_cycle(rocking, tmp_path):
    assert rocking(f"simulate {SI} --cycles 7 --csv motion.csv")[0] == 0
    with (tmp_path / "motion.csv").open(encoding="utf-8") as file:
        heading, *rows = csv.reader(file)
    table = dict(zip(heading, np.array(rows, float).T, strict=True))
    block = rk.Block(2.0, 0.5)
    system = block.system(acceleration=2.9, frequency_hz=1.8)
    motion = rk.simulate(system, cycles=7)
    times = np.arange(701) * system.forcing.period / 100
    angle, velocity = motion.at(np.minimum(times, motion.duration))
    expected = {
        "time [1/alpha]": times,
        "angle [theta_cr]": angle,
        "velocity [alpha theta_cr]": velocity,
        "time [s]": np.arange(701) / 180,
        "angle [rad]": angle * np.arctan(0.25),
        "velocity [rad/s]": velocity * np.arctan(0.25) * block.frequency_parameter,
        "top_displacement [m]": 2.0 * np.sin(angle * np.arctan(0.25)),
    }
    assert list(table) == list(expected)
    for name, values in expected.items():
        np.testing.assert_allclose(table[name], values, rtol=1e-12, atol=1e-13)


def test_csv_of_a_normalised_system_has_three_columns(rocking, tmp_path):
    assert rocking(f"simulate {NORMALISED} --cycles 1001 --csv motion.csv")[0] == 0
    table = np.loadtxt(tmp_path / "motion.csv", delimiter=",", skiprows=1)
    assert table.shape == (100_101, 3)
    # The steps stay even where the table goes on in a new batch of cycles: 1e-2, but for the rounding of 1001.
    np.testing.assert_allclose(np.diff(table[:, 0]), 0.01, rtol=0, atol=3e-13)


def test_netcdf_is_the_dataset_of_the_motion(rocking, tmp_path):
    import xarray as xr

    assert rocking(f"simulate {NORMALISED} --cycles 7 --netcdf motion.nc")[0] == 0
    motion = rk.simulate(rk.System(rk.Harmonic(2.0, period=1.0), 0.925), cycles=7)
    with xr.open_dataset(tmp_path / "motion.nc", engine="h5netcdf") as written:
        xr.testing.assert_allclose(written.load(), motion.to_xarray(), rtol=1e-15)


@pytest.mark.parametrize(
    ("name", "start"),
    [
        ("a.png", b"\x89PNG"),
        ("a.svg", b"<?xml"),
        ("a.pdf", b"%PDF"),
        ("a.PNG", b"\x89PNG"),
        ("a.gif", b"GIF8"),
        ("a.mp4", b"\x00\x00\x00"),
    ],
)
def test_suffix_chooses_the_kind_of_picture_and_nothing_else_is_left(rocking, tmp_path, name, start):
    code, _, out = rocking(f"simulate {NORMALISED} --cycles 3 --plot {name}")
    assert code == 0
    assert out.endswith(f"wrote {name}\n")
    assert (tmp_path / name).read_bytes().startswith(start)
    assert [path.name for path in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize(
    "line",
    [
        "--amplitude 1.75 --period 2 --restitution 0.95",
        "--amplitude 0.5 --period 1 --restitution 0.9",
        "--amplitude 0.5 --period 1 --restitution 0.9 --angle 0.5",
        "--amplitude 15 --period 2 --restitution 0.925 --brace-angle 1",
        SI,
    ],
)
def test_every_outcome_can_be_drawn(rocking, line):
    assert rocking(f"simulate {line} --plot motion.png")[:2] == (0, "")


REFUSED = {
    "": "no system is given: give --amplitude, --period (or --frequency) and --restitution, or in SI --height, --width, "
    "--acceleration (or --acceleration-g, --displacement) and --frequency-hz (or --period-s)",
    "--amplitude 2 --height 1": "--amplitude is normalised and --height is SI: use one of the two (the SI option is --acceleration)",
    "--amplitude 2 --period 1": "missing --restitution: give --amplitude, --period (or --frequency) and --restitution",
    "--period 1": "missing --amplitude and --restitution: give --amplitude, --period (or --frequency) and --restitution",
    "--amplitude 2": "missing --period and --restitution: give --amplitude, --period (or --frequency) and --restitution",
    "--amplitude 2 --restitution 0.9": "missing --period: give --amplitude, --period (or --frequency) and --restitution",
    f"{NORMALISED} --frequency 6": "give exactly one of --period, --frequency; got --period=1.0 and --frequency=6.0",
    "--height 2 --acceleration 3": "missing --width and --frequency-hz: give --height, --width, --acceleration "
    "(or --acceleration-g, --displacement) and --frequency-hz (or --period-s)",
    "--height 2 --width 0.5 --period-s 1": "missing --acceleration: give --height, --width, --acceleration "
    "(or --acceleration-g, --displacement) and --frequency-hz (or --period-s)",
    "--height 2 --width 0.5 --acceleration 3": "missing --frequency-hz: give --height, --width, --acceleration "
    "(or --acceleration-g, --displacement) and --frequency-hz (or --period-s)",
    f"{SI} --period-s 1": "give exactly one of --frequency-hz, --period-s; got --frequency-hz=1.8 and --period-s=1",
    f"{SI} --acceleration 1e9": "--acceleration must lie in [0, 2402.42] m/s²; got 1000000000.0",
    f"{SI} --width 3": "--restitution by Housner's formula is -0.0385 for a block 2 m high and 3 m wide and must lie in "
    "[0, 1]: are --height and --width swapped? If not, give --restitution",
    f"{SI} --height 0": "--height must lie in [0.001, 1000] m; got 0",
    f"{NORMALISED} --period 0": "--period must lie in [0.00628319, 6283.19]; got 0",
    f"{NORMALISED} --period -1": "--period must lie in [0.00628319, 6283.19]; got -1",
    f"{NORMALISED} --period nan": "--period must lie in [0.00628319, 6283.19]; got nan",
    f"{NORMALISED} --amplitude -2": "--amplitude must lie in [0, 1000]; got -2 "
    "(for the opposite direction add π to --phase)",
    f"{NORMALISED} --amplitude inf": "--amplitude must lie in [0, 1000]; got inf",
    f"{NORMALISED} --amplitude two": "--amplitude must be a number without a unit, such as 0.6; got 'two'",
    f"{NORMALISED} --restitution 1.2": "--restitution must lie in [0, 1]; got 1.2",
    f"{NORMALISED} --phase 1e4": "--phase must lie in [-1000, 1000]; got 10000.0",
    f"{NORMALISED} --brace-angle 0": "--brace-angle must lie in [0.001, 1000]; got 0",
    f"{NORMALISED} --brace-angle 1 --brace-restitution 2": "--brace-restitution must lie in [0, 1]; got 2",
    f"{NORMALISED} --brace-restitution 1": "--brace-restitution needs --brace-angle",
    f"{NORMALISED} --brace-angle 0.5 --angle 0.6": "--angle must lie between the braces, in [-0.5, 0.5]; got 0.6",
    f"{NORMALISED} --velocity -inf": "--velocity must lie in [-1000, 1000]; got -inf",
    f"{NORMALISED} --angle nan": "--angle must lie in [-1000, 1000]; got nan",
    f"{NORMALISED} --velocity 1001": "--velocity must lie in [-1000, 1000]; got 1001",
    f"{NORMALISED} --cycles 0": "--cycles must be a whole number in [1, 1000000000]; got 0",
    f"{NORMALISED} --cycles 2.5": "--cycles must be a whole number in [1, 1000000000]; got 2.5",
    f"{NORMALISED} --cycles nan": "--cycles must be a whole number in [1, 1000000000]; got nan",
    f"{NORMALISED} --cycles 1e6 --csv a.csv": "--cycles must be at most 100000 with --csv; got 1000000.0",
    f"{NORMALISED} --plot a.jpeg": "--plot must end in .png, .svg, .pdf, .gif, .mp4; got 'a.jpeg'",
    f"{NORMALISED} --csv -": "--csv must be the path of a file; got '-' (files are not written to stdout: use --json for the summary)",
    f"{NORMALISED} --csv nowhere/a.csv": "--csv must lie in an existing folder; got 'nowhere/a.csv'",
    f"{NORMALISED} --csv period/phase.csv": "--csv must lie in an existing folder; got 'period/phase.csv'",
    f"{NORMALISED} --netcdf .": "--netcdf must end in .nc; got '.'",
}


@pytest.mark.parametrize("line", REFUSED)
def test_input_that_cannot_be_run_is_refused_in_one_line(rocking, tmp_path, line):
    assert rocking(f"simulate {line}") == (2, REFUSED[line], "")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "line", ["nonsense", "simulate --nonsense", "simulate extra", "simulate --amplitude", "--nonsense"]
)
def test_unknown_words_are_refused_in_one_line(rocking, line):
    code, message, out = rocking(line)
    assert (code, out) == (2, "")
    assert 0 < len(message) < 120


def test_command_alone_shows_its_help_and_is_an_error(rocking):
    code, _, out = rocking("")
    assert code == 2
    for command in ("simulate", "classify", "paper", "cite"):
        assert f"\n  {command} " in out


def test_cite_and_version(rocking):
    assert rocking("cite") == (0, "", rk.cite())
    assert rocking("--version") == (0, "", f"rocking {rk.__version__}\n")


def test_paper_writes_the_figures_asked_for(rocking, tmp_path):
    code, _, out = rocking("paper 1 --output results/new")
    assert code == 0
    assert sorted(path.name for path in (tmp_path / "results/new").iterdir()) == [
        "figure-01.png",
        "figure-01.svg",
    ]
    assert "wrote results/new/figure-01.svg" in out


def test_paper_lists_its_reports_and_takes_their_names(rocking, tmp_path):
    code, _, out = rocking("paper --list")
    assert code == 0
    assert [line.split()[0] for line in out.splitlines()] == ["yim-lin-1991", "pulses-and-earthquakes"]
    assert not list(tmp_path.iterdir())
    for name in ("yim-lin-1991", "pulses-and-earthquakes"):
        number = {"yim-lin-1991": 1, "pulses-and-earthquakes": 2}[name]
        assert rocking(f"paper {name} {number}")[0] == 0
        assert (tmp_path / "results" / name / f"figure-{number:02}.png").exists()


def test_name_of_a_report_stands_first(rocking):
    code, said, _ = rocking("paper 1 pulses-and-earthquakes")
    assert code == 2
    assert said.endswith("got 'pulses-and-earthquakes'")


def three_claims():
    chapter = Chapter("of three")
    chapter.claim("first")(lambda: Finding(True, "1"))
    chapter.claim("second")(lambda: Finding(True, "2"))
    chapter.claim("third", error="3")(lambda: Finding(False, "3", shown=True))
    return (chapter,)


@pytest.mark.parametrize(
    "figures, last",
    [
        ("claims", "3 claims of the paper: confirmed (2), error in the paper (1)"),
        ("1", "wrote made/figure-01.svg"),
    ],
)
def test_paper_ends_with_how_its_claims_stand(rocking, monkeypatch, figures, last):
    monkeypatch.setattr(sys.modules[reproduce.__module__], "_chapters", three_claims)
    assert rocking(f"paper {figures} --output made")[2].splitlines()[-1] == last


def test_whole_paper_ends_with_the_page_to_open(rocking, monkeypatch):
    def nothing(folder, figures, progress, summary):
        summary("3 claims of the paper: confirmed (3)")
        return [folder / "index.html"]

    monkeypatch.setattr("rocking.papers.yim_lin_1991.reproduce", nothing)
    told = ["wrote made/index.html", "3 claims of the paper: confirmed (3); open made/index.html"]
    assert rocking("paper --output made")[2].splitlines() == told


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("paper 99", "FIGURE must be among "),
        ("paper 1 --output taken/here", "--output must be a folder that can be written; "),
    ],
)
def test_paper_refuses_unknown_figures_and_impossible_folders(rocking, tmp_path, line, message):
    (tmp_path / "taken").write_text("")
    code, said, _ = rocking(line)
    assert code == 2
    assert said.startswith(message)
    assert (tmp_path / "taken").read_text() == ""
    assert not (tmp_path / "results").exists()


@pytest.mark.parametrize("error", [RuntimeError("so\nsad"), ValueError("bad")])
def test_failure_of_our_own_is_one_line_and_exit_code_1(rocking, tmp_path, monkeypatch, error):
    def fail(*_, **__):
        raise error

    monkeypatch.setattr("rocking.cli.output.motion_files.tables", fail)
    code, message, _ = rocking(f"simulate {NORMALISED} --csv a.csv")
    assert code == 1
    assert message == f"internal error: {type(error).__name__}: {' '.join(str(error).split())}".strip()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "error, why",
    [
        (MemoryError(), "no more memory can be allocated"),
        (MemoryError("Unable to allocate 8. TiB"), "Unable to allocate 8. TiB"),
        (OSError(errno.ENOMEM, "Cannot allocate memory"), "[Errno 12] Cannot allocate memory"),
        (RuntimeError("can't start new thread"), "can't start new thread"),
    ],
)
def test_lack_of_memory_or_of_threads_is_one_line_with_the_remedy(rocking, tmp_path, monkeypatch, error, why):
    def fail(*_, **__):
        raise error

    monkeypatch.setattr("rocking.cli.output.motion_files.tables", fail)
    code, message, out = rocking(f"simulate {NORMALISED} --csv a.csv")
    assert (code, out) == (2, "")
    assert message == (
        f"the memory or the threads that this process may use do not suffice: {why} (reduce the numbers of points, samples or "
        "cycles, or raise the limits, such as those of ulimit -v and ulimit -u)"
    )
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("megabytes", [200])
def test_limit_of_memory_that_libraries_do_not_fit_in_is_one_line_with_the_remedy(megabytes, tmp_path):
    limited = f"""
import resource
from rocking.cli.main import main

resource.setrlimit(resource.RLIMIT_AS, ({megabytes << 20}, {megabytes << 20}))
main()
"""
    line = ["map", "--amplitude", "0:6:5", "--period", "1:2:5", "--restitution", "0.9", "--max-cycles", "10"]
    done = subprocess.run(
        [sys.executable, "-c", limited, *line], capture_output=True, text=True, cwd=tmp_path, check=False
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert re.fullmatch(r"rocking: the memory or the threads [^\n]*ulimit -u\)\n", done.stderr), done.stderr


def test_piped_output_has_no_colours_and_errors_go_to_stderr(tmp_path):
    done = subprocess.run(
        [*COMMAND, "simulate", *SI.split()], capture_output=True, text=True, cwd=tmp_path, check=True
    )
    assert "\x1b" not in done.stdout
    assert done.stderr == ""
    done = subprocess.run(
        [*COMMAND, "simulate", "--amplitude", "2"], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("rocking: missing --period and --restitution")
    assert len(done.stderr.splitlines()) == 1


def test_terminal_without_greek_letters_is_served(tmp_path):
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    done = subprocess.run(
        [*COMMAND, "simulate", *SI.split()], capture_output=True, env=environment, check=True
    )
    assert b"m/s?" in done.stdout


@pytest.mark.parametrize("terminal", [True, False])
def test_logged_error_is_one_line_with_its_exception_on_a_terminal(monkeypatch, capsys, terminal):
    log = logging.getLogger("rocking")
    monkeypatch.setattr(log, "handlers", [])
    monkeypatch.setattr(log, "level", logging.NOTSET)
    monkeypatch.setattr(sys, "argv", ["rocking", "--version"])
    monkeypatch.setattr(sys.stderr, "isatty", lambda: terminal)
    monkeypatch.setattr(signal, "signal", lambda *_: None)
    with pytest.raises(SystemExit):
        main()
    log.info("not shown")
    log.warning("the job %r is slow", "read")
    log.getChild("explorer").error("the job %r failed", "read", exc_info=ValueError("so\nsad"))
    told = "rocking: the job 'read' is slow\nrocking: the job 'read' failed: ValueError: so sad\n"
    assert capsys.readouterr().err == told * terminal


def test_phase_is_told_in_degrees_too_in_which_nobody_should_type_it(rocking):
    _, _, out = rocking(f"simulate {SI} --phase 90 --cycles 1")
    assert ["phase", "φ", "=", "90", "5157°"] in [line.split() for line in out.splitlines()]


def test_reader_that_leaves_early_is_no_error_message():
    with subprocess.Popen([*COMMAND, "cite"], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.close()
        assert process.stderr.read() == b""


@pytest.mark.parametrize("closing", [">&-", "2>&-"])
def test_output_that_was_closed_before_is_no_error(closing):
    done = subprocess.run(
        ["/bin/sh", "-c", f'exec "$@" {closing}', "sh", *COMMAND, "cite"], capture_output=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert bool(done.stdout) == (closing == "2>&-")


def test_interrupted_run_says_so_and_leaves_no_file(tmp_path):
    line = f"simulate {NORMALISED} --cycles 100000 --csv motion.csv"
    process = subprocess.Popen(
        [*COMMAND, *line.split()], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    while process.poll() is None and not list(tmp_path.iterdir()):
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate()
    assert (process.returncode, out, err) == (130, b"", b"rocking: interrupted\n")
    assert not list(tmp_path.iterdir())
