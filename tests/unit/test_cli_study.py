"""Study files: forms of entries, messages about them, and files that are none."""

import json
import os
from pathlib import Path

import pytest


def test_typed_options_come_first_also_where_they_equal_the_default(rocking):
    Path("study.toml").write_text("amplitude = 2\nperiod = 1\nrestitution = 0.9\nphase = 1.5\ncycles = 7\n")
    for line in ("--study study.toml --phase 0 --cycles 3", "--phase 0 --cycles 3 --study study.toml"):
        read = json.loads(rocking(f"simulate {line} --json")[2])
        assert (read["amplitude"], read["phase"], read["cycles"]) == (2.0, 0.0, 3)


@pytest.mark.parametrize(
    ("command", "wrong", "told"),
    [
        (
            "frequency-response",
            "amplitude = 'a'\nperiod = 3\nmodes = '1'\nstep = true\nplot = 3\nseeds = 1\n",
            [
                "amplitude must be a number; got 'a'",
                "period must be an axis, START:STOP:COUNT with finite START ≠ STOP and a whole COUNT in [2, 1000000]; got 3",
                "modes must be a number; got '1' (write a number without quotation marks)",
                "step must be a number; got True",
                "plot must be a path; got 3",
                "unknown 'seeds'; keys of this command: amplitude, ",
            ],
        ),
        (
            "continue",
            "amplitude = '1:2:3'\nphase = [1]\nmodel = 2\njson = true\nstudy = 'b.toml'\n",
            [
                "amplitude must be a number or START:STOP with finite START ≠ STOP; got '1:2:3' (example: 1:3)",
                "phase must be a number; got [1]",
                "model must be one of 'slender', 'full'; got 2",
                "unknown 'json'; unknown 'study'; keys of this command: amplitude, ",
            ],
        ),
        (
            "orbits",
            "prove = 1\nfile = 'a'\n",
            ["prove must be a bool; got 1", "unknown 'file'; keys of this command: amplitude, "],
        ),
        (
            "basins",
            "samples = 0\nboundary-width = 9\nseeds = 1\n",
            [
                "samples must be a whole number in [1, 10000000]; got 0",
                "boundary-width must lie in ",
                "unknown 'seeds' (did you mean 'seed'?)",
            ],
        ),
        (
            "overturning",
            "restitution = [0.9, 0.8]\nperiod = '1:2:1'\nphases = 0\n",
            [
                "period must be a number or START:STOP:COUNT with finite START ≠ STOP and a whole COUNT in [2, 1000000]; got '1:2:1'",
                "restitution must hold two numbers or more in [0, 1], ascending; got 0.9 before 0.8 at index 1",
                "phases must be a whole number in [1, 100000]; got 0",
            ],
        ),
    ],
)
def test_all_errors_of_a_study_file_are_reported_at_once(rocking, command, wrong, told):
    Path("study.toml").write_text(wrong)
    code, message, out = rocking(f"{command} --study study.toml")
    assert (code, out) == (2, "")
    assert message.startswith("study 'study.toml': ")
    assert "\n" not in message
    for each in told:
        assert each in message
    assert message.count("; got") + message.count("unknown") == len(told) + message.count("; unknown 'study'")


def test_value_of_a_study_file_out_of_its_range_is_an_error_about_the_option(rocking):
    Path("study.toml").write_text("amplitude = 2\nperiod = 1\nrestitution = 1.5\n")
    assert rocking("orbits --study study.toml")[:2] == (
        2,
        "--restitution must lie in [0, 1]; got 1.5 (study 'study.toml' gives restitution)",
    )


@pytest.mark.parametrize(
    ("command", "typed", "message"),
    [
        (
            "simulate",
            "--frequency 3",
            "give exactly one of --period, --frequency; got --period=1.0 and --frequency=3.0 (study 'study.toml' gives period)",
        ),
        (
            "basins",
            "--frequency 3",
            "give exactly one of --period, --frequency; got --period=1.0 and --frequency=3.0 (study 'study.toml' gives period)",
        ),
        (
            "classify",
            "--height 2",
            (
                "--amplitude is normalised and --height is SI: use one of the two (the SI option is --acceleration) "
                "(study 'study.toml' gives amplitude)"
            ),
        ),
        ("orbits", "--restitution 2", "--restitution must lie in [0, 1]; got 2"),
    ],
)
def test_message_about_an_option_names_the_study_file_that_gives_it(rocking, command, typed, message):
    Path("study.toml").write_text("amplitude = 2\nperiod = 1\nrestitution = 0.9\n")
    for line in (f"{typed} --study study.toml", f"--study study.toml {typed}"):
        assert rocking(f"{command} {line}") == (2, message, "")


def test_keys_are_shown_as_they_are_written(rocking):
    Path("study.toml").write_text(
        "max-cycle = 3\nbrace_angel = 1\nbrace-restitutio = 1\nfrequencyhz = 2\nbrace-angle = 'a'\nmax_period = true\n"
    )
    message = rocking("classify --study study.toml")[1]
    assert message.removeprefix("study 'study.toml': ").split("; ") == [
        "brace-angle must be a number",
        "got 'a'",
        "max_period must be a number",
        "got True",
        "unknown 'brace_angel' (did you mean 'brace_angle'?)",
        "unknown 'brace-restitutio' (did you mean 'brace-restitution'?)",
        "unknown 'frequencyhz' (did you mean 'frequency-hz'?)",
        "unknown 'max-cycle' (did you mean 'max-cycles'?)",
    ]


OTHERS = "\nperiod = 1\nrestitution = 0.9"
WRONG = {
    # a table that is no range or no axis
    f"continue: amplitude = {{ start = 1, stop = 2, count = 3 }}{OTHERS}": "amplitude must be START:STOP, or a table of start and "
    "stop; got",
    f"continue: amplitude = {{ start = 1 }}{OTHERS}": "amplitude must be START:STOP, or a table of start and stop; got start",
    f"continue: amplitude = {{ start = 1, stop = 1 }}{OTHERS}": "start and stop of amplitude must differ; got 1 for both",
    f"continue: amplitude = {{ start = 1, stop = 'a' }}{OTHERS}": "stop of amplitude must be a number; got 'a'",
    f"orbit-diagram: amplitude = {{ start = 1, stop = inf }}{OTHERS}": "stop of amplitude must be a finite number; got inf",
    f"map: amplitude = {{ start = 1 }}{OTHERS}": "amplitude must be a number, START:STOP:COUNT, or a table of start, stop and "
    "optionally count; got start",
    f"map: amplitude = {{ start = 1, stop = 1 }}{OTHERS}": "start and stop of amplitude must differ; got 1 for both",
    f"map: amplitude = {{ start = nan, stop = 1 }}{OTHERS}": "start of amplitude must be a finite number; got nan",
    # a value of another form
    "continue: amplitude = [1, 2]": "amplitude must be a number or START:STOP; got [1, 2]",
    "continue: amplitude = true": "amplitude must be a number or START:STOP; got True",
    "safe-basin: angle = '0.1'": "angle must be a range, START:STOP with finite START ≠ STOP; got '0.1' (example",
    "orbit-diagram: phase = [1, 2]": "phase must be a number or START:STOP:COUNT; got [1, 2]",
    "frequency-response: period = [1, 2]": "period must be an axis, START:STOP:COUNT; got [1, 2]",
    "frequency-response: period = '2'": "period must be an axis, START:STOP:COUNT with finite START ≠ STOP",
    # a block of many sizes
    "map: height = '1:2:3'\nwidth = 0.5": "height must be a number; got '1:2:3'",
    "overturning: height = '1:2:3'\nwidth = 0.5": "height must be a number; got '1:2:3'",
    # numbers that are not finite
    "simulate: restitution = nan": "restitution must be a finite number; got nan",
    "map: restitution = inf": "restitution must be a finite number; got inf",
    "basins: restitution = -inf": "restitution must be a finite number; got -inf",
    "overturning: restitution = nan": "restitution must be a finite number; got nan",
    "map: height = nan\nwidth = 0.5": "height must be a finite number; got nan",
    # keys
    "simulate: [simulate]\namplitude = 2": "unknown 'simulate' (a section: write the keys of options without sections)",
    "basins: max-cycles = 5\nmax_cycles = 6": "'max-cycles' occurs twice, with hyphens and with underscores (remove one)",
}
"""Command and study file, and the beginning of the message about the file."""


@pytest.mark.parametrize("case", WRONG)
def test_wrong_entry_is_an_error_about_the_file(rocking, case):
    command, _, study = case.partition(": ")
    Path("study.toml").write_text(study)
    code, message, out = rocking(f"{command} --study study.toml")
    assert (code, out) == (2, "")
    assert message.startswith(f"study 'study.toml': {WRONG[case]}")


NO_STUDY = {
    "/dev/zero": (None, "not a regular file but a device, a pipe or a socket"),
    "long.toml": (b"#" * 1_000_001, "the file has more than 1,000,000 bytes"),
    "deep.toml": (b"a=" + b"[" * 5000 + b"]" * 5000, "the file is nested too deeply"),
    "bytes.toml": (b"\xff\xfe\x00", "the file is not text in UTF-8"),
    "other.toml": (b"amplitude 1", "Expected '=' after a key"),
}


@pytest.mark.parametrize("name", NO_STUDY)
def test_file_that_is_no_study_is_refused_with_the_reason(rocking, name):
    content, why = NO_STUDY[name]
    if content is not None:
        Path(name).write_bytes(content)
    code, message, _ = rocking(f"map --study {name}")
    assert code == 2
    assert message.startswith(f"--study must name a TOML file; got '{name}': {why}")


def test_pipe_is_refused_before_it_is_read(rocking):
    os.mkfifo("pipe")
    assert "not a regular file" in rocking("map --study pipe")[1]


TYPED = {
    "map --amplitude 1:2:3 --period 1:2:3 --max-cycles 20 --restitution 0.9": (
        "\ufeffrestitution = 0.9\n"  # a mark of the byte order; 1,000,000 bytes are not too many
        "amplitude = [1, 1.5, 2]\nperiod = { start = 1, stop = 2, count = 3 }\nmax_cycles = 20\n"
    ).ljust(999_998, "#"),
    "continue --amplitude 7:6.9 --period 1.721328 --restitution 0.8 --step 0.1": (
        "amplitude = { start = 7, stop = 6.9 }\nperiod = 1.721328\nrestitution = 0.8\nstep = 0.1"
    ),
    "safe-basin --angle=-0.5:0.25 --amplitude 3:4:2 --period 1 --restitution 0.8 --samples 9": (
        "angle = { start = -0.5, stop = 0.25 }\namplitude = '3:4:2'\nperiod = 1\nrestitution = 0.8\nsamples = 9"
    ),
    "frequency-response --amplitude 2 --period 1:1.2:3 --restitution 0.9 --modes 1 --modes 3 --step 0.1": (
        "amplitude = 2\nperiod = { start = 1, stop = 1.2, count = 3 }\nrestitution = 0.9\nmodes = [1, 3]\nstep = 0.1"
    ),
    "basins --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2 --angle=-1:1:7 --velocity=-0.5:0.5:3 "
    "--boundary-runs 0 --netcdf a.nc": (
        "height = 2\nwidth = 0.5\nacceleration = 4\nfrequency-hz = 1.2\nangle = '-1:1:7'\nvelocity = [-0.5, 0, 0.5]\n"
        "boundary-runs = 0\nnetcdf = 'a.nc'"
    ),
    "basins --amplitude 2 --period 1 --restitution 0.9 --angle=-1:1:7 --velocity=-0.5:0.5:2 --samples 50 --boundary-runs 0": (
        "amplitude = 2\nperiod = 1\nrestitution = 0.9\nangle = '-1:1:7'\nvelocity = [-0.5, 0.5]\nsamples = 50\n"
        "boundary-runs = 0"
    ),
    "fragility example --height 2 --width 0.5 --pga-g 0.2:1.4:3 --limit 0.5": (
        "height = 2\nwidth = 0.5\npga-g = [0.2, 0.8, 1.4]\nlimit = 0.5"
    ),
}


@pytest.mark.parametrize("line", TYPED)
def test_lists_and_tables_of_a_study_file_are_axes_and_ranges(rocking, line):
    Path("study.toml").write_text(TYPED[line], encoding="utf-8")
    command = "fragility example" if line.startswith("fragility") else line.split()[0]
    given = rocking(f"{command} --study study.toml --json")
    assert given[:2] == (0, "")
    assert given == rocking(f"{line} --json")


def test_picture_of_two_lists_is_refused_before_the_scan(rocking, monkeypatch):
    monkeypatch.setattr("rocking.survey.overturning_amplitude.overturning_amplitude", None)
    Path("study.toml").write_text("period = [1, 2]\nrestitution = [0.8, 0.9]\nplot = 'b.png'\n")
    code, message, _ = rocking("overturning --study study.toml")
    wrong = "--plot needs a single axis; got --period and --restitution (give one of them as a number)"
    assert (code, message) == (2, f"{wrong} (study 'study.toml' gives period, restitution, plot)")


def test_keys_are_suggested_only_if_they_are_similar(rocking):
    keys = ["restitution_coefficient", "foo_angle", "theta", "amplitudes", "frequenzy"]
    Path("study.toml").write_text("".join(f"{key} = 1\n" for key in keys))
    *unknown, known = (
        rocking("simulate --study study.toml")[1].removeprefix("study 'study.toml': ").split("; ")
    )
    assert unknown == [
        "unknown 'amplitudes' (did you mean 'amplitude'?)",
        "unknown 'foo_angle'",
        "unknown 'frequenzy' (did you mean 'frequency'?)",
        "unknown 'restitution_coefficient'",
        "unknown 'theta'",
    ]
    assert known.startswith("keys of this command: amplitude, period, frequency, height, width, ")
    assert "brace-angle" in known
