"""Study files: forms of entries, messages about them, and files that are none."""

import json
from pathlib import Path

import pytest


def test_typed_options_come_first_also_where_they_equal_the_default(rocking):
    Path("study.toml").write_text("amplitude = 2\nperiod = 1\nrestitution = 0.9\nphase = 1.5\ncycles = 7\n")
    for line in ("--study study.toml --phase 0 --cycles 3", "--phase 0 --cycles 3 --study study.toml"):
        read = json.loads(rocking(f"simulate {line} --json")[2])
        assert (read["amplitude"], read["phase"], read["cycles"]) == (2.0, 0.0, 3)


def test_axis_is_a_table_and_modes_are_a_list(rocking):
    Path("study.toml").write_text(
        "amplitude = 2\nperiod = { start = 1, stop = 1.2, count = 3 }\nrestitution = 0.9\nmodes = [1, 3]\nstep = 0.1\n"
    )
    read = json.loads(rocking("frequency-response --study study.toml --json")[2])
    assert (read["period_range"], read["values"], read["modes"]) == ([1.0, 1.2], 3, [1, 3])


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


def test_range_is_a_table_as_it_is_a_text(rocking):
    others = "\nperiod = 1.721328\nrestitution = 0.8\nstep = 0.1\n"
    Path("table.toml").write_text("amplitude = { start = 7, stop = 6.9 }" + others)
    Path("text.toml").write_text('amplitude = "7:6.9"' + others)
    read = rocking("continue --study table.toml --json")
    assert read[:2] == (0, "")
    assert read == rocking("continue --study text.toml --json")


def test_range_of_initial_states_is_a_table(rocking):
    others = '\namplitude = "3:4:2"\nperiod = 1\nrestitution = 0.8\nsamples = 9\n'
    Path("table.toml").write_text("angle = { start = -0.5, stop = 0.25 }" + others)
    Path("text.toml").write_text('angle = "-0.5:0.25"' + others)
    read = rocking("safe-basin --study table.toml --json")
    assert (read[:2], json.loads(read[2])["angle_range"]) == ((0, ""), [-0.5, 0.25])
    assert read == rocking("safe-basin --study text.toml --json")


@pytest.mark.parametrize(
    ("command", "table", "told"),
    [
        (
            "continue",
            "{ start = 1, stop = 2, count = 3 }",
            "amplitude must be START:STOP, or a table of start and stop; got",
        ),
        (
            "continue",
            "{ start = 1 }",
            "amplitude must be START:STOP, or a table of start and stop; got start",
        ),
        ("continue", "{ start = 1, stop = 1 }", "start and stop of amplitude must differ; got 1 for both"),
        ("continue", "{ start = 1, stop = 'a' }", "stop of amplitude must be a number; got 'a'"),
        ("orbit-diagram", "{ start = 1, stop = inf }", "stop of amplitude must be a finite number; got inf"),
        (
            "map",
            "{ start = 1 }",
            "amplitude must be a number, START:STOP:COUNT, or a table of start, stop and optionally count; got start",
        ),
        ("map", "{ start = 1, stop = 1 }", "start and stop of amplitude must differ; got 1 for both"),
        ("map", "{ start = nan, stop = 1 }", "start of amplitude must be a finite number; got nan"),
    ],
)
def test_wrong_table_is_an_error_about_the_file(rocking, command, table, told):
    Path("study.toml").write_text(f"amplitude = {table}\nperiod = 1\nrestitution = 0.9\n")
    code, message, out = rocking(f"{command} --study study.toml")
    assert (code, out) == (2, "")
    assert message.startswith(f"study 'study.toml': {told}")


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


@pytest.mark.parametrize(
    ("command", "value"), [("simulate", "nan"), ("map", "inf"), ("basins", "-inf"), ("overturning", "nan")]
)
def test_numbers_that_are_not_finite_are_errors_about_the_file(rocking, command, value):
    Path("study.toml").write_text(f"restitution = {value}\nperiod = 1\n")
    code, message, out = rocking(f"{command} --study study.toml")
    assert (code, out) == (2, "")
    assert message.startswith("study 'study.toml': restitution must ")
    assert message.endswith(f"; got {value}")


def test_number_in_si_that_is_not_finite_is_an_error_about_the_file(rocking):
    Path("study.toml").write_text(
        "height = nan\nwidth = 0.5\nacceleration = '1:2:2'\nfrequency-hz = '1:2:2'\n"
    )
    assert (
        rocking("map --study study.toml")[1] == "study 'study.toml': height must be a finite number; got nan"
    )


def test_section_is_an_error_with_its_remedy(rocking):
    Path("study.toml").write_text("[simulate]\namplitude = 2\n")
    assert rocking("simulate --study study.toml")[1] == (
        "study 'study.toml': unknown 'simulate' (a section: write the keys of options without sections)"
    )


def test_file_that_is_no_text_is_an_error_with_the_encoding(rocking):
    Path("study.toml").write_bytes(b"\xff\xfe\x00")
    assert rocking("simulate --study study.toml")[1] == (
        "--study must name a TOML file; got 'study.toml': the file is not text in UTF-8"
    )


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


@pytest.mark.parametrize(
    ("command", "line", "told"),
    [
        ("continue", "amplitude = [1, 2]", "amplitude must be a number or START:STOP; got [1, 2]"),
        (
            "safe-basin",
            "angle = '0.1'",
            "angle must be a range, START:STOP with finite START ≠ STOP; got '0.1' (example",
        ),
        ("continue", "amplitude = true", "amplitude must be a number or START:STOP; got True"),
        ("orbit-diagram", "phase = [1, 2]", "phase must be a number or START:STOP:COUNT; got [1, 2]"),
        ("frequency-response", "period = [1, 2]", "period must be an axis, START:STOP:COUNT; got [1, 2]"),
        (
            "frequency-response",
            "period = '2'",
            "period must be an axis, START:STOP:COUNT with finite START ≠ STOP",
        ),
    ],
)
def test_message_about_an_entry_states_its_form(rocking, command, line, told):
    Path("study.toml").write_text(line)
    assert rocking(f"{command} --study study.toml")[1].startswith(f"study 'study.toml': {told}")


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
