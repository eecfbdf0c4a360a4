"""`rocking simulate` and `rocking paper`; the terminal, pipes, memory and Ctrl-C."""

import csv
import errno
import json
import logging
import os
import re
import resource
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import rocking as rk
from rocking.cli.main import NO_MEMORY, main, refused
from rocking.model.text import ordinal
from rocking.papers.report.claim import Chapter, Finding
from rocking.papers.report.paper import Paper

NORMALISED = "--amplitude 2 --period 1 --restitution 0.925"
SI = "--height 2 --width 0.5 --acceleration 2.9 --frequency-hz 1.8"
COMMAND = [sys.executable, "-m", "rocking"]


def test_frequency_says_the_same_as_period(rocking):
    by_period = rocking(f"simulate {NORMALISED} --json --cycles 5")[2]
    by_frequency = rocking(
        f"simulate --amplitude 2 --frequency {2 * np.pi} --restitution 0.925 --json --cycles 5"
    )[2]
    assert by_period == by_frequency


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
    key = "acceleration_m_per_s2"
    assert other[key] == pytest.approx(json.loads(rocking(line)[2])[key], rel=1e-14, abs=0)
    assert other["period_s"] == pytest.approx(0.8, rel=1e-14, abs=0)


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


def test_no_number_is_cut_or_split_however_narrow_the_terminal(rocking, monkeypatch):
    line = f"simulate {SI} --cycles 50 --brace-angle 0.123456 --brace-restitution 0.654321"
    monkeypatch.setenv("COLUMNS", "20")
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
    assert "equation of motion" not in rocking(f"simulate {SI}")[2]


@pytest.mark.parametrize(
    ("variables", "bold"), [({"TERM": "xterm"}, True), ({"TERM": "dumb"}, False), ({"NO_COLOR": "1"}, False)]
)
def test_first_line_is_bold_on_a_terminal_with_colours(rocking, monkeypatch, variables, bold):
    monkeypatch.delenv("NO_COLOR", raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(type(sys.stdout), "isatty", lambda stream: stream is sys.stdout)
    first = rocking(f"simulate {NORMALISED}")[2].splitlines()[0]
    assert first.startswith("\x1b[1mbounded") == first.endswith("\x1b[0m") == bold


def test_rest_is_told(rocking):
    assert rocking("simulate --amplitude 0.5 --period 1 --restitution 0.9")[2].startswith("at rest")


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
        "time [s]": np.arange(701) / 180,
        "angle [rad]": angle * np.arctan(0.25),
        "velocity [rad/s]": velocity * np.arctan(0.25) * block.frequency_parameter,
        "top_displacement [m]": 2.0 * np.sin(angle * np.arctan(0.25)),
    }
    assert list(table) == list(expected)
    for name, values in expected.items():
        np.testing.assert_allclose(table[name], values, rtol=1e-12, atol=1e-13)


def test_csv_of_a_normalised_system_has_three_columns(rocking, tmp_path, monkeypatch):
    monkeypatch.setattr("rocking.cli.reports_motion.ROWS_AT_ONCE", 1_000)
    assert rocking(f"simulate {NORMALISED} --cycles 25 --csv motion.csv")[0] == 0
    table = np.loadtxt(tmp_path / "motion.csv", delimiter=",", skiprows=1)
    assert table.shape == (2_501, 3)
    # The steps stay even where the table goes on in a new batch of rows: 1e-2, but for the rounding of 25.
    np.testing.assert_allclose(np.diff(table[:, 0]), 0.01, rtol=0, atol=1e-14)


def test_netcdf_is_the_dataset_of_the_motion(rocking, tmp_path):
    import xarray as xr

    assert rocking(f"simulate {NORMALISED} --cycles 7 --netcdf motion.nc")[0] == 0
    motion = rk.simulate(rk.System(rk.Harmonic(2.0, period=1.0), 0.925), cycles=7)
    with xr.open_dataset(tmp_path / "motion.nc", engine="h5netcdf") as written:
        xr.testing.assert_allclose(written.load(), motion.to_xarray(), rtol=1e-15)


@pytest.mark.parametrize("suffix", [".gif", ".mp4"])
def test_suffix_of_a_film_chooses_an_animation(rocking, monkeypatch, suffix):
    filmed = []
    monkeypatch.setattr(rk.plot, "animation", lambda *given: filmed.append(given))
    assert rocking(f"simulate {SI} --cycles 3 --plot a{suffix}")[:2] == (0, "")
    ((motion, path, block),) = filmed
    assert (motion.cycles, path.name, block) == (3, f"a{suffix}", rk.Block(2.0, 0.5))


def test_report_is_written_to_the_folder_of_its_name(rocking, tmp_path):
    assert rocking("paper yim-lin-1991 1")[:2] == (0, "")
    folder = tmp_path / "results/yim-lin-1991"
    assert sorted(path.name for path in folder.iterdir()) == ["figure-01.png", "figure-01.svg"]


def three_claims():
    chapter = Chapter("of three")
    chapter.claim("first")(lambda: Finding(True, "1"))
    chapter.claim("second")(lambda: Finding(True, "2"))
    chapter.claim("third", error="3")(lambda: Finding(False, "3", explained=True))
    return (chapter,)


@pytest.mark.parametrize(
    "figures, last",
    [
        ("claims", "3 claims of the paper: confirmed (2), error in the paper (1)"),
        ("1", "wrote made/figure-01.svg"),
    ],
)
def test_paper_ends_with_how_its_claims_stand(rocking, monkeypatch, figures, last):
    monkeypatch.setattr(Paper, "chapters", three_claims())
    assert rocking(f"paper {figures} --output made")[2].splitlines()[-1] == last


def test_whole_paper_ends_with_the_page_to_open(rocking, monkeypatch):
    def nothing(paper, folder, figures, progress, summary):
        summary("3 claims of the paper: confirmed (3)")
        return [folder / "index.html"]

    monkeypatch.setattr("rocking.papers.report.reproduce.reproduce", nothing)
    told = ["wrote 1 file into made", "3 claims of the paper: confirmed (3); open made/index.html"]
    assert rocking("paper --output made")[2].splitlines() == told


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

    monkeypatch.setattr("rocking.cli.output.write_csv", fail)
    code, message, out = rocking(f"simulate {NORMALISED} --csv a.csv")
    assert (code, out) == (2, "")
    assert message == (
        f"the memory or the threads that this process may use do not suffice: {why} (reduce the numbers of points, samples or "
        "cycles, or raise the limits, such as those of ulimit -v and ulimit -u)"
    )
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("limit", [1 << 30, resource.RLIM_INFINITY])
def test_library_that_fails_without_a_reason_lacks_memory_only_if_that_is_limited(monkeypatch, limit):
    monkeypatch.setattr(resource, "getrlimit", lambda _: (limit, limit))
    code, message = refused(SystemError("error return without exception set"))
    assert (code, message == NO_MEMORY) == ((1, False) if limit == resource.RLIM_INFINITY else (2, True))


def test_command_without_memory_for_its_message_prints_one(rocking, monkeypatch):
    def fail(*_, **__):
        raise MemoryError

    monkeypatch.setattr("rocking.cli.output.write_csv", fail)
    monkeypatch.setattr("rocking.cli.main.lacking", fail)
    assert rocking(f"simulate {NORMALISED} --csv a.csv")[:2] == (2, NO_MEMORY)


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


def test_piped_output_has_no_colours_and_no_greek_letters_in_ascii_and_errors_go_to_stderr():
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    done = subprocess.run(
        [*COMMAND, "simulate", *SI.split()], capture_output=True, env=environment, check=True
    )
    assert b"\x1b" not in done.stdout
    assert b"m/s?" in done.stdout
    assert done.stderr == b""
    done = subprocess.run(
        [*COMMAND, "simulate", "--amplitude", "2"], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("rocking: missing --period and --restitution")
    assert len(done.stderr.splitlines()) == 1


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
