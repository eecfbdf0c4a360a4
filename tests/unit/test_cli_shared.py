"""What all commands share: output files, warnings, study files, failures, and refusals in one line that leave no file."""

import json
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

from rocking.cli import options
from rocking.cli.commands import COMMANDS as TABLE

COMMANDS = {
    command.name: [each.name for each in (*command.options, *command.outputs)]
    + ["study"] * bool(command.report)
    for command in TABLE
}
WITHOUT = {"assess", "explore", "paper", "cite"}
"""Commands that compute nothing from their options alone."""
SILENT = {"lyapunov", "fit-restitution", "slide"}
"""Commands that do not warn of the block."""
BLOCK = "--height 190 --width 70"
SHAKEN = f"{BLOCK} --acceleration 4 --frequency-hz 0.12"
PUSHED = f"push.csv {BLOCK}"
LINES = {
    "simulate": f"{SHAKEN} --restitution 0.8 --phase 0.2 --brace-angle 0.9 --angle 0.1 --velocity 0.1 --cycles 5",
    "record": f"{PUSHED} --restitution 0.8 --inertia-ratio 1.4 --angle 0.1 --scale 1.5 --baseline mean",
    "slide": "push.csv --friction 0.2 --scale 1.5 --baseline mean",
    "spectrum": f"{PUSHED} --size 1:150:3 --pga-g 0.5 --restitution 0.8 --inertia-ratio 1.4",
    "classify": f"{SHAKEN} --phase 0.2 --max-cycles 500 --max-period 8",
    "lyapunov": f"{SHAKEN} --cycles 40 --transient 3",
    "modes": f"{SHAKEN} -n 3",
    "map": f"{BLOCK} --acceleration 4:4.4:2 --frequency-hz 0.12:0.14:2 --max-cycles 50 --max-period 8",
    "basins": f"{SHAKEN} --angle=-0.5:0.5:3 --velocity=-0.5:0.5:2 --boundary-runs 0 --max-cycles 50",
    "safe-basin": f"{BLOCK} --acceleration 4:5:2 --frequency-hz 0.12 --angle=-0.5:0.5 --samples 20 --seed 3",
    "overturning": f"{BLOCK} --acceleration 4:9:4 --frequency-hz 0.12:0.14:2 --phases 2 --max-cycles 50",
    "overturning-set": f"{PUSHED} --pga-g 0.5:2:9 --polarity=-1 --angle 0.1 --baseline mean",
    "ida": f"{PUSHED} --pga-g 0.5:2:4 --polarity worse --angle 0.1",
    "overturning-spectrum": f"--pulse one-sine {BLOCK} --acceleration-g 0.5:1:3 --frequency-hz 0.1:0.2:2",
    "fragility": f"{PUSHED} --pga-g 0.5:2:4 --limit 0.1 --limit 0.5 --samples 3 --width-spread 0.1 --replicates 100",
    "sensitivity": f"{PUSHED} --pga-g 0.5:2:4 --seed 3 --restitution 0.8",
    "fit-restitution": f"times.txt {BLOCK}",
    "orbits": f"{SHAKEN} --max-period 1 --effort 0.05 --seed 3",
    "continue": f"{SHAKEN.replace('4 ', '4:3.9 ')} --at 3.95 --step 0.1",
    "frequency-response": f"{BLOCK} --acceleration 4 --frequency-hz 0.12:0.13:2 --modes 1 --step 0.1",
    "orbit-diagram": f"{SHAKEN.replace('4 ', '4:5:3 ')} --sweep up --cycles 5 --transient 10 --section-phase 1",
}
"""A cheap run of each command, of a block that is too tall and not slender."""
SHAKEN_BY_RECORDS = {command: "push.csv" for command in LINES if {"file", "sources"} & set(COMMANDS[command])}
SOURCE = SHAKEN_BY_RECORDS | {"fit-restitution": "times.txt"}
FILES = {"plot": "a.svg", "animate": "a.gif", "csv": "a1.csv", "netcdf": "a.nc"}


pytestmark = pytest.mark.usefixtures("records")


def outputs(command, *names):
    """Return the output files among ``names`` that a command has options for, by option."""
    return {name: FILES[name] for name in names if name in COMMANDS[command]}


def typed(command, *names):
    files = " ".join(f"--{name} {path}" for name, path in outputs(command, *names).items())
    return f"{command} {LINES[command]} {files}"


def test_each_command_has_rows_and_each_that_computes_reads_a_study_file_and_writes_a_table():
    assert set(LINES) == set(COMMANDS) - WITHOUT == {name for name in COMMANDS if "study" in COMMANDS[name]}
    assert {name for name in LINES if "csv" not in COMMANDS[name]} == {"classify"}
    assert set(REFUSED) == set(COMMANDS)


@pytest.mark.parametrize("command", LINES)
def test_files_are_written_and_named_and_the_block_is_warned_of(rocking, command):
    files, before = outputs(command, "plot", "csv", "netcdf"), set(Path().iterdir())
    slender = " --model slender --normalised-by angle" if "normalised_by" in COMMANDS[command] else ""
    code, message, out = rocking(typed(command, *files) + slender)
    assert (code, message) == (0, "")
    assert out.splitlines()[-len(files) :] == [f"wrote {path}" for path in files.values()]
    assert {str(path) for path in set(Path().iterdir()) - before} == set(files.values())
    unusual, wide = (
        re.compile(f"^warning: {text}", re.MULTILINE)
        for text in (
            r"height [\d.]+ m is unusual: sizes are in metres$",
            "outside the slender range, θcr = 0.353 rad",
        )
    )
    assert bool(unusual.search(out)) == bool(wide.search(out)) == (command not in SILENT)
    if "model" in COMMANDS[command]:
        code, message, full = rocking(f"{command} {LINES[command]} --model full")
        assert (code, message) == (0, "")
        assert bool(unusual.search(full)) == (command not in SILENT)
        assert not wide.search(full)
        assert "lift-off: " not in full


def entries(line):
    """Return the options of a line as a study file; an option that is repeated is a list."""
    found = {}
    for name, value in re.findall(r"(?<= )--?([\w-]+)[ =](\S+)", f" {line}"):
        found.setdefault(name, []).append(value if re.fullmatch(r"-?[\d.]+", value) else f'"{value}"')
    texts = {name: each[0] if len(each) == 1 else f"[{', '.join(each)}]" for name, each in found.items()}
    return "".join(f"{name} = {text}\n" for name, text in texts.items())


def changed(study):
    """Return a study file with the last digit of each number changed, and with other files."""
    return re.sub(
        r"\d(?=\D*$)",
        lambda digit: str(int(digit[0]) + (-1 if digit[0] == "9" else 1)),
        study,
        flags=re.MULTILINE,
    )


@pytest.mark.parametrize("command", LINES)
def test_study_states_the_options_and_typed_ones_take_precedence(rocking, command):
    files = list(outputs(command, "csv").values())

    def result(line):
        return *rocking(f"{line} --json"), *(Path(path).read_bytes() for path in files)

    line = typed(command, "csv")
    expected = result(line)
    assert expected[:2] == (0, "")
    assert json.loads(expected[2], parse_constant=pytest.fail)["files"] == files
    Path("study.toml").write_text(entries(line))
    assert result(f"{command} {SOURCE.get(command, '')} --study study.toml") == expected
    Path("study.toml").write_text(changed(entries(line)))
    assert result(f"{line} --study study.toml") == expected
    assert not Path("a2.csv").exists()


@pytest.mark.parametrize("command", LINES)
def test_all_errors_of_a_study_file_are_one_line_that_lists_the_keys(rocking, command):
    files, size = outputs(command, *FILES), "width" if "width" in COMMANDS[command] else "friction"
    Path("study.toml").write_text(f"zzz = 1\n{size} = '2'\n" + "".join(f"{name} = 3\n" for name in files))
    code, message, out = rocking(f"{command} {SOURCE.get(command, '')} --study study.toml")
    told, _, keys = message.partition("; keys of this command: ")
    wrong = [f"{size} must be a number", *(f"{name} must be a path; got 3" for name in files)]
    assert (code, out) == (2, "")
    assert told.startswith("study 'study.toml': ")
    assert told.count(" must ") + told.count("unknown ") == len(wrong) + 1
    assert all(
        each in told
        for each in (*wrong, "; got '2' (write a number without quotation marks)", "unknown 'zzz'")
    )
    assert set(keys.replace("-", "_").split(", ")) == set(COMMANDS[command]) - {
        "study",
        "json",
        "file",
        "sources",
        "times",
    }


@pytest.mark.parametrize("command", LINES)
@pytest.mark.parametrize(
    "error, told",
    [
        (ValueError("so\nsad"), (1, "internal error: ValueError: so sad")),
        (KeyboardInterrupt(), (130, "")),
    ],
)
def test_run_that_ends_while_a_file_is_written_leaves_none(rocking, monkeypatch, command, error, told):
    def fail(*_, **__):
        raise error

    monkeypatch.setattr("csv.writer", fail)
    monkeypatch.setattr("matplotlib.figure.Figure.savefig", fail)
    before = set(Path().iterdir())
    assert rocking(typed(command, "csv" if "csv" in COMMANDS[command] else "plot")) == (*told, "")
    assert set(Path().iterdir()) == before


KINDS = {"plot": ".png, .svg, .pdf", "animate": ".gif, .mp4", "csv": ".csv", "netcdf": ".nc"}


@pytest.mark.parametrize("command", LINES)
def test_kind_of_each_output_file_is_checked(rocking, command):
    before = set(Path().iterdir())
    for name in outputs(command, *KINDS):
        kinds = KINDS[name] + ", .gif, .mp4" * ((command, name) == ("simulate", "plot"))
        told = f"--{name} must end in {kinds}; got 'a.txt'"
        assert rocking(f"{command} {LINES[command]} --{name} a.txt") == (2, told, "")
    assert set(Path().iterdir()) == before


@pytest.mark.parametrize(
    "command, link", [*((name, Path.symlink_to) for name in LINES), ("map", Path.hardlink_to)]
)
def test_output_that_is_a_link_to_another_one_or_to_an_input_is_refused(rocking, command, link):
    other, target = "study", "in.toml"
    Path(target).write_text("")
    for name, path in outputs(command, *FILES).items():
        Path(target).touch()
        link(Path(path), target)
        told = f"--{other} and --{name} must differ; got '{path}' for both"
        if other == "study":
            told = f"--{name} must not overwrite the study file; got '{path}'"
        line = f"{command} {LINES[command]} --{other} {target} --{name} {path}"
        assert rocking(line) == (2, told, "")
        Path(path).unlink()
        other, target = name, path


def test_link_to_an_output_that_is_not_there_yet_is_refused_and_so_is_the_file_of_stdout(rocking):
    Path("y.csv").symlink_to("y.nc")
    line = typed("simulate")
    code, message, _ = rocking(f"{line} --csv y.csv --netcdf y.nc")
    assert (code, message) == (2, "--csv and --netcdf must differ; got 'y.nc' for both")
    with Path("out.csv").open("w") as out:
        done = subprocess.run(
            [sys.executable, "-m", "rocking", *f"{line} --csv out.csv --json".split()],
            stdout=out,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    told = "rocking: --csv must not overwrite the file to which stdout is redirected; got 'out.csv'\n"
    assert (done.returncode, done.stderr) == (2, told)


@pytest.mark.parametrize("command", SHAKEN_BY_RECORDS)
def test_no_record_is_overwritten(rocking, monkeypatch, command):
    special = {
        "record": "motion.simulate",
        "slide": "motion.sliding",
        "spectrum": "survey.spectra",
        "ida": "survey.incremental_dynamic_analysis",
    }
    computes = special.get(command, f"survey.{command.replace('-', '_')}")
    import_module(f"rocking.{computes}")
    monkeypatch.setattr(f"rocking.{computes}", None)
    Path("sub").mkdir()
    Path("push.csv").replace("sub/a.csv")
    Path("table.csv").write_text("file,scale\nsub/a.csv,0.5\n")
    one = "file" in COMMANDS[command]
    for source in ("sub/a.csv",) if one else ("sub/a.csv", "sub", "table.csv"):
        what = "the record" if one else "a record"
        told = f"--csv must not overwrite {what}; got 'sub/a.csv'"
        line = LINES[command].replace("push.csv", source)
        assert rocking(f"{command} {line} --csv sub/a.csv") == (2, told, "")


N = "--period 1 --restitution 0.9"
SI = "--height 2 --width 0.5"
SPECTRUM = "push.csv --size 1:2:3 --slenderness-deg"
PULSES = "--pulse ricker --amplitude 1:9:9 --frequency 1:8:5"
MAP = f"--amplitude 1:2:2 --max-cycles 9 {N.replace('1', '1:2:2')}"
REFUSED = {
    "simulate": {
        "": "no system is given: give --amplitude, --period (or --frequency) and --restitution, or in SI --height, --width, "
        "--acceleration (or --acceleration-g, --displacement) and --frequency-hz (or --period-s)",
        "--amplitude 2 --height 1": "--amplitude is normalised and --height is SI: use one of the two (the SI option is --acc",
        "--amplitude 2": "missing --period and --restitution: give --amplitude, --period (or --frequency) and --restitution",
        "--height 2 --acceleration 3": "missing --width and --frequency-hz: give --height, --width, --acceleration (or --acceleration-g, "
        "--displacement) and --frequency-hz (or --period-s)",
        f"{SI} --period-s 1": "missing --acceleration: give --height",
        f"--amplitude 2 {N} --frequency 6": "give exactly one of --period, --frequency; got --period=1.0 and --frequency=6.0",
        f"{SI} --acceleration 3 --frequency-hz 2 --period-s 1": "give exactly one of --frequency-hz, --period-s; got",
        f"{SI} --acceleration 1e9 --period-s 1": "--acceleration must lie in [0, 2402.42] m/s²; got 1000000000.0",
        f"{SI} --width 3 --acceleration 3 --period-s 1": "--restitution must lie in [0, 1]; got -0.0385 by Housner's formula for a block "
        "2 m high and 3 m wide (are --height and --width swapped, or in another unit? If not, give --restitution)",
        f"{SI} --height 0 --acceleration 3 --period-s 1": "--height must lie in [0.001, 1000] m; got 0",
        "--amplitude 2 --period nan --restitution 0.9": "--period must lie in [0.00628319, 6283.19]; got nan",
        "--amplitude 2 --frequency 0 --restitution 0.9": "--frequency must lie in ",
        f"--amplitude 2 {N} --phase 1e4": "--phase must lie in [-1000, 1000]; got 10000.0",
        f"--amplitude 2 {N} --brace-angle 0": "--brace-angle must lie in [0.001, 1000]; got 0",
        f"--amplitude 2 {N} --brace-angle 1 --brace-restitution 2": "--brace-restitution must lie in [0, 1]; got 2",
        f"--amplitude 2 {N} --brace-restitution 1": "--brace-restitution needs --brace-angle",
        f"--amplitude 2 {N} --brace-angle 0.5 --angle 0.6": "--angle must lie between the braces, in [-0.5, 0.5]; got 0.6",
        f"--amplitude 2 {N} --velocity -inf": "--velocity must lie in [-1000, 1000]; got -inf",
        f"--amplitude 2 {N} --model full": "--model needs a block in SI: give --critical-angle with normalised input",
        f"{SI} --acceleration 3 --period-s 1 --critical-angle 0.2": "--critical-angle is normalised: with --height and --width",
        f"--amplitude 2 {N} --cycles 0": "--cycles must be a whole number in [1, 1000000000]; got 0",
        f"--amplitude 2 {N} --friction 0.3": "--friction needs a block in SI: give --height and --width",
        f"{SI} --acceleration 3 --period-s 1 --friction 11": "--friction must lie in [0.001, 10]; got 11",
        f"{SI} --acceleration 3 --period-s 1 --friction 0.3 --cycles 1e6": "--cycles must be at most 100000 with --friction; got 1000000.0",
        f"--amplitude 2 {N} --cycles 1e6 --csv a.csv": "--cycles must be at most 100000 with --csv; got 1000000.0",
        f"--pulse one-sine --amplitude 2 {N} --cycles 5": "--cycles belongs to harmonic motion: omit it with --pulse",
        f"--pulse one-sine --amplitude 2 {N} --phase 1": "--phase belongs to harmonic motion: omit it with --pulse",
        f"--pulse one-sine {SI} --displacement 0.1 --frequency-hz 1": "--displacement belongs to harmonic motion",
        f"--pulse sine --amplitude 2 {N}": "--pulse must be one of 'rectangular'",
        "--nonsense": "No such option '--nonsense'.",
        "--amplitude": "Option '--amplitude' requires an argument.",
    },
    "record": {
        "--height 2": "Missing argument 'FILE'.",
        f". {SI}": ".: a folder; give the path of one file",
        f"bare.txt {SI}": "bare.txt: the file does not state the unit of its samples; give it, for example --units='m/s²'",
        f"bare.txt {SI} --units g": "bare.txt: the file does not state its time step; give it, for example --step=0.01",
        f"bare.txt {SI} --units feet": "--units must be one of 'm/s²', 'cm/s²', 'mm/s²', 'g', 'gal'; got 'feet'",
        f"push.csv {SI} --step 0.1": "push.csv: the times give a step of 0.5 s; omit --step, or correct the times",
        f"push.csv {SI} --channel 2": "--channel must be 1 to 1, the channels of push.csv; got 2",
        f"push.csv {SI} --baseline cubic": "--baseline must be one of 'none', 'mean', 'linear', 'quadratic'; got 'cubic'",
        f"push.csv {SI} --scale nan": "--scale must be a finite real number of size up to 1e+06; got nan",
        f"push.csv {SI} --scale 0": "--scale must not be 0; got 0 (omit it for the record as it is)",
        f"push.csv {SI} --pga-g 0": "--pga-g must lie in [1e-09, 100000] g; got 0",
        f"push.csv {SI} --pga-g=-1": "--pga-g must lie in [1e-09, 100000] g; got -1",
        f"push.csv {SI} --inertia-ratio 0.5": "--inertia-ratio must lie in [1, 10]; got 0.5",
        f"push.csv {SI} --restitution 2": "--restitution must lie in [0, 1]; got 2",
        f"push.csv {SI} --friction 0": "--friction must lie in [0.001, 10]; got 0",
        "push.csv --height 2": "missing --width: give --height and --width",
        "push.csv --height 2 --width 1 --wall 0.5 --restitution 0.9": "give --restitution or --wall, not both",
        "push.csv --height 2 --width 1 --wall 0.5 --restitution-scatter 0.1:normal:1": "give --restitution-scatter or --wall, not",
    },
    "slide": {
        "--friction 0.3": "Missing argument 'FILE'.",
        "push.csv": "missing --friction",
        "push.csv --friction 0": "--friction must lie in [0.001, 10]; got 0",
        "push.csv --friction=-0.3": "--friction must lie in [0.001, 10]; got -0.3",
        "push.csv --friction nan": "--friction must lie in [0.001, 10]; got nan",
        "push.csv --friction 0.3 --scale 0": "--scale must not be 0; got 0 (omit it for the record as it is)",
        "push.csv --friction 0.3 --scale 2 --pga-g 1": "give --scale or --pga-g, not both",
        "push.csv --friction 0.3 --csv push.csv": "--csv must not overwrite the record; got 'push.csv'",
    },
    "spectrum": {
        "push.csv": "missing --size and --slenderness-deg: give --size and --slenderness-deg, or --height and --width",
        f"{SPECTRUM} 9 --width 1": "give --slenderness-deg or --width, not both: height and width",
        f"{SPECTRUM} 9 --scale 1 --pga-g 1": "give --scale or --pga-g, not both",
        f"{SPECTRUM} 100": "--slenderness-deg must lie in [0.00572958, 89.9544]; got 100",
        f"{SPECTRUM} 60": "--slenderness-deg, in rad, must be a critical angle in rad for which",
        f"{SPECTRUM} 9 --scale 0": "--scale must lie in [1e-09, 1e+06]; got 0",
        f"{SPECTRUM} 9 --pga-g 0": "--pga-g must lie in [1e-09, 1e+06]; got 0",
        "push.csv --size 1 --slenderness-deg 9": "--size must be an axis, START:STOP:COUNT, if nothing else varies and there is one "
        "record; got 1.0 (rocking record",
        f"{SPECTRUM} 9 --pga-g 0.1:1:3 --plot a.png": "--plot needs one value of --pga-g; got an axis",
        "push.csv --size 1 --slenderness-deg 9 --plot a.png": "--plot needs an axis: give --size or --slend",
        "push.csv example --size 1:2:3 --slenderness-deg 5:10:7 --plot a.png": "--plot draws one record, or at most 6 values of "
        "--slenderness-deg; got 2 records",
    },
    "classify": {
        f"--amplitude 2 {N} --max-cycles 0": "--max-cycles must be a whole number in [1, 100000000]; got 0",
        f"--amplitude 2 {N} --max-period 2.5": "--max-period must be a whole number in [1, 10000]; got 2.5",
        f"{SI} --acceleration 4 --period-s 1 --model full --prove": "proofs are available for the slender block only (omit "
        "--critical-angle and --model full)",
    },
    "lyapunov": {
        f"--amplitude 2 {N} --transient -1": "--transient must be a whole number in [0, ",
        f"--amplitude 60 {N}": "the block must stay upright for an exponent; overturning is certain in cycle 0",
    },
    "modes": {
        "--amplitude 2 --period 1 --restitution 0": "--restitution must lie in (0, 1] for symmetric modes; got 0.0 (an impact that",
    },
    "map": {
        f"{MAP} --csv -": "--csv must be the path of a file; got '-' (files are not written to stdout: use --json for the summary)",
        f"{MAP} --csv nowhere/a.csv": "--csv must lie in an existing folder; got 'nowhere/a.csv'",
        f"{MAP} --csv period/phase.csv": "--csv must lie in an existing folder; got 'period/phase.csv'",
        f"{MAP} --csv look/map.csv --tiles look": "--tiles and --csv must not lie inside each other; got 'look/map.csv' for --csv",
        f"{MAP} --store look/map.zarr --tiles look": "--store and --tiles must not lie inside each other; got 'look' for --tiles",
        f"{MAP} --store map --tiles ./map": "--store and --tiles must differ; got 'map' for both",
        f"{MAP} --plot map.png --tiles map.png": "--tiles and --plot must differ; got 'map.png' for both",
        f"{MAP} --store=": "--store must be the path of a folder; got ''",
        f"{MAP} --store {__file__}": f"--store must be the path of a folder; got {__file__!r}, which is a file",
        f"{MAP} --store {__file__}/map": "--store must be a folder that can be written; got",
        f"{MAP} --store {Path(__file__).parent}": "--store must be a new folder, or the folder of an earlier survey; got",
        f"{MAP} --tiles .": "--tiles must not contain the working directory; got '.'",
        f"{MAP} --tiles {Path(__file__).parent}": "--tiles must be new, empty, or hold only an earlier index.html with its files; got "
        f"{str(Path(__file__).parent)!r}, which holds other files",
        f"{MAP} --study nowhere.toml": "--study must name a TOML file; got 'nowhere.toml': No such file or directory",
        f"{SI} --displacement 0.1 --frequency-hz 1:2:9": "--displacement with an axis of the frequency varies amplitude and frequency: "
        "use --acceleration instead",
        f"{MAP} --store a.zarr --curves melnikow --plot a.png": "--curves must be one of 'symmetry-breaking-1', ",
        f"{MAP} --store a.zarr --symbols 12 --plot a.png": "--symbols must be one of 'kinds', '10', '11', '13b'; got '12'",
        f"{MAP} --store a.zarr --curves melnikov": "--curves needs a plot: give --plot FILE as well",
        f"{MAP} --store a.zarr --symbols 11 --tiles map": "--symbols needs a plot: give --plot FILE as well",
        f"{MAP} --store a.zarr --curves melnikov --plot a.png --brace-angle 0.3": "--curves must lie over a map of a slender, "
        "symmetric block without braces; got 'brace_angle = 0.3'",
        f"{MAP} --store a.zarr --curves melnikov --plot a.png --critical-angle 0.3": "--curves must lie over a map of a slender, "
        "symmetric block without braces; got 'critical_angle = 0.3'",
        f"{MAP} --store a.zarr --curves melnikov --plot a.png --period 1 --angle=-1:1": "--curves must lie over ",
    },
    "basins": {
        f"--amplitude 2 {N} --samples 10 --angle 1": "--angle must be an axis, START:STOP:COUNT with … got '1' (example: 1:3:60)",
        f"--amplitude 2 {N} --velocity 0.5": "--velocity must be an axis, START:STOP:COUNT with … got '0.5' (example: 1:3:60)",
    },
    "safe-basin": {
        f"--amplitude 3 {N}": "--amplitude must be an axis, START:STOP:COUNT with finite",
        f"--amplitude 3:6:4 {N} --angle 1:-1": "--angle must be a range, START:STOP, in [-1000, 1000] with START < STOP; got",
        f"--amplitude 3:6:4 {N} --velocity 0:1:5": "--velocity must be a range, START:STOP with",
        f"--amplitude 3:6:4 {N} --brace-angle 0.5 --angle=-1:1": "--angle must be a range, START:STOP, in [-0.5, 0.5]",
    },
    "overturning": {
        "--amplitude 1:2:3": "missing --period and --restitution: give --period (or --frequency) and --restitution",
        f"{N} --acceleration 1:3:10": "--period is normalised and --acceleration is SI: use one of the two",
        f"{N} --amplitude 3": "--amplitude must be an axis, START:STOP:COUNT with … got '3' (example: 1:3:60)",
        f"{N.replace('1', '1:2:2').replace('0.9', '0.8:0.9:2')} --plot b.png": "--plot needs a single axis; got --period and "
        "--restitution (give one of them as a number)",
        "--height 2 --frequency-hz 1": "missing --width: give --height, --width and --frequency-hz (or --period-s)",
        f"{SI} --frequency-hz 1 --acceleration 3": "--acceleration must be an axis, START:STOP:COUNT with … got '3' (example: 1:3:60)",
    },
    "overturning-set": {
        f"push.csv {SI}": "give exactly one of --scale, --pga, --pga-g, --pgv, --pgd, --arias, --cav, --pga-ratio, "
        "--pgv-ratio, --sa; got none",
        f"push.csv {SI} --pga-g 0.1:1 --scale 1:2": "give exactly one of --scale, --pga, --pga-g, --pgv, --pgd, --arias, --cav, "
        "--pga-ratio, --pgv-ratio, --sa; got --scale and --pga-g",
        f"push.csv {SI} --sa 1:9:9": "--sa needs --sa-period, too",
        f"push.csv {SI} --pga-g 0.1:1:3 --sa-period 1": "--sa-period needs --sa, too",
        f"push.csv {SI} --sa 1:9:9 --sa-period 0": "--sa-period must lie in [0.0001, 10000] s; got 0",
        f"push.csv {SI} --pga-g 0.5": "--pga-g must be an axis, START:STOP:COUNT with … got '0.5' (example: 1:3:60)",
        f"push.csv {SI} --pga-g 0:1:20": "--pga-g must hold two numbers or more in",
        f"push.csv {SI} --pga-g 0.1:1 --polarity 2": '--polarity must be "+", "-", "both" or "worse", or 1, -1 or [-1, 1]; got 2',
        f"push.csv {SI} --pga-g 0.1:1 --units g": "push.csv: the header names m/s²; omit --units, or correct the header",
        f"push.csv {SI} --pga-g 0.1:1 --baseline cubic": "--baseline must be one of 'none', 'mean', 'linear', 'quad",
        f"bare.txt {SI} --pga-g 0.1:1": "bare.txt: the file does not state the unit of its samples; give it, for example --units=",
        f"push.csv push.csv {SI} --pga-g 0.1:1": "push.csv occurs 2 times; name each file once",
    },
    "ida": {
        f"push.csv {SI}": "give exactly one of --scale, --pga, --pga-g, --pgv, ",
        f"push.csv {SI} --pga-g 0.5": "--pga-g must be an axis, START:STOP:COUNT with … got '0.5' (example: 1:3:60)",
        f"push.csv {SI} --scale 1:2:2 --polarity 2": '--polarity must be "+", "-", "both" or "worse", or 1, -1 or [-1, 1]; got 2',
    },
    "overturning-spectrum": {
        "--amplitude 1:9:9 --frequency 1:8:5 --restitution 0.9": "missing --pulse: give the form of the pulse, such as --pulse one-sine",
        f"{PULSES}": "missing --restitution: give --amplitude, --frequency and --restitution",
        f"--pulse ricker {SI}": "missing --acceleration and --frequency-hz: give --height, --width, --acc",
        "--pulse ricker --amplitude 1:9:9 --height 2": "--amplitude is normalised and --height is SI: use one of the",
        "--pulse ricker --amplitude 2 --frequency 1:8:5 --restitution 0.9": "--amplitude must be an axis, START:STOP:",
        f"--pulse ricker {SI} --acceleration 1:2:3 --acceleration-g 1:2:3 --frequency-hz 1:2:3": "give --acceleration or "
        "--acceleration-g, not both",
        f"--pulse ricker {SI} --acceleration 1:2:3 --frequency-hz 1": "--frequency-hz must be an axis, START:STOP:",
        f"{PULSES} --restitution 0.8:0.9:3 --plot a.png": "--plot needs one value of "
        "--restitution; got an axis (give a number)",
        f"{PULSES} --restitution 0.9 --repair": "--repair must be used with --store, whose damaged",
    },
    "fragility": {
        f"push.csv {SI} --scale 0": "--scale must lie in [1e-09, 1e+06]; got 0",
        f"push.csv {SI} --scale 1:2:2 --limit 0.5 --limit 0.1": "--limit must hold numbers in (0, 10], ascending",
        f"push.csv {SI} --scale 1:2:2 --samples 3": "--samples must be 1 for a certain block; got 3 (give --height-spread",
    },
    "sensitivity": {
        f"push.csv {SI} --pga 1:2:2 --restitution 1": "the block must have a restitution in [0.02, 0.98]; got 1.0",
        f"push.csv {SI} --pga 1:2:2 --seed -1": "--seed must be a whole number in [0, 4294967295]; got -1",
    },
    "fit-restitution": {
        "--height 2": "Missing argument 'FILE'.",
        "nowhere.txt": "FILE must name a text file that can be read; got 'nowhere.txt' (No such file or directory)",
        "gentle.csv": "FILE must hold times in s, and lines with #; got 'time'",
        "times.txt --height 2": "missing --width: give --height and --width",
        "times.txt --release 90": "--release must come before the first of FILE; got 90",
        "times.txt --angle 0": "--angle must lie between 0 and 1, exclusive; got 0.0",
        "times.txt --frequency-parameter 0": "--frequency-parameter must lie in [0.001, 10000]; got 0",
        f"times.txt {SI} --frequency-parameter 2": "--frequency-parameter must be omitted with --height and --width, which",
        "times.txt --model full": "--model must be 'slender' without a critical angle; got 'full' (give --height and --width)",
        "times.txt --csv times.txt": "--csv must",
    },
    "orbits": {
        f"--amplitude 2 {N} --effort 0": "--effort must lie in [0.01, 1000]; got 0",
        f"--amplitude 2 {N} --seed -1": "--seed must be a whole number in [0, ",
        f"--amplitude 2 {N} --prove --critical-angle 0.2": "proofs are available for the slender block only",
    },
    "continue": {
        f"--amplitude 2 {N}": "exactly one option must be a range, START:STOP; got none",
        "--amplitude 2:3 --period 1:2 --restitution 0.9": "exactly one option must be a range, START:STOP; got --amplitude and --",
        f"--amplitude -1:2 {N}": "--amplitude must lie in [0, 1000]; got -1.0",
        f"--amplitude 2:3 {N} --at 4": "--at must lie in [2, 3]; got 4",
        # the response is at rest: what is invalid is found before it is computed
        f"--amplitude 0.5:3 {N} --step 1": "--step must lie in [1e-06, 0.1]; got 1",
        "--amplitude 0.5 --period 1 --restitution 0.9:0": "--restitution must lie in [0.001, 1]; got 0.0",
        f"--amplitude 0.5:3 {N}": "the response from the initial state must be periodic; got rest (give --response-period, another --at, "
        "or another --angle",
        f"--amplitude 3:2 {N} --response-period 0": "--response-period must be a whole number in [1, 1000]; got 0",
        f"--amplitude 3:2 {N} --response-period 1 --angle 3": "the initial state must not overturn within 2 cycles; got --angle 3 and "
        "--velocity 0 (give --angle and",
        f"--amplitude 3:2 {N} --response-period 5 --angle 0.3": "no orbit of period 5 was found from --angle 0.3 and --velocity 0: "
        "Newton's method ends … (give --angle and --velocity nearer to the orbit, or another --response-period)",
        f"--amplitude 5:20 --at 15 {N} --response-period 2": "the orbit found near the initial state must have --response-period 2; got "
        "period 1 (give --angle and --velocity nearer to the orbit)",
        f"--amplitude 2:3 {N} --critical-angle 0.2 --response-period 1 --angle 0.95": "orbit must have impacts, … (give another --at)",
        f"--amplitude 3:2 {N} --response-period 1 --angle 0.81": "orbit must have an impact",
        f"{SI} --displacement 0.1 --frequency-hz 1:2": "--displacement with a range of --frequency-hz varies amplitude and frequency: "
        "use --acceleration instead",
    },
    "frequency-response": {
        "": "missing --amplitude and --period and --restitution: give --amplitude, --period",
        f"--amplitude 2 {N}": "--period must be an axis, START:STOP:COUNT with",
        "--amplitude 2 --period 0:1:3 --restitution 0.9": "--period must lie in ",
        f"--amplitude 0 {N.replace('1', '1:2:3')}": "--amplitude must be above 0: without forcing there is no (1, n)",
        f"{SI} --acceleration 0 --frequency-hz 1:2:3": "--acceleration must be above 0: without forcing",
        f"{SI} --frequency-hz 1:2:3": "missing --acceleration: give --height, --width, --acceleration (or --acceleration-g) and "
        "--frequency-hz",
        "--amplitude 2 --period 1:2:3 --restitution 1": "--restitution must lie in [0.001, 1); got 1.0 (an undamped motion never reaches "
        "a steady response; rocking modes",
        f"--amplitude 0.1 {N.replace('1', '1:2:3')} --step 5": "--step must lie in [1e-06, 0.1]; got 5",
    },
    "orbit-diagram": {
        "--amplitude 1:2 --period 1:2 --restitution 0.9": "exactly one option must be an axis, START:STOP:COUNT; got --amp",
        f"--amplitude -1:2 {N}": "--amplitude must lie in [0, 1000]; got -1.0",
        "--amplitude 2 --period 1 --restitution 0.5:1.5": "--restitution must lie in [0, 1]; got 1.5",
        f"--amplitude 1:2 {N} --sweep round": "--sweep must be one of 'up', 'down', 'both', 'rest'",
        f"--amplitude 1:2 {N} --cycles 0": "--cycles must be a whole number in [1, ",
        f"--amplitude 1:2 {N} --transient -1": "--transient must be a whole number in [0, 1000000]",
        f"--amplitude 1:2 {N} --section-phase 1e9": "--section-phase must lie in",
        f"--amplitude 2 {N} --brace-restitution 0:1": "--brace-restitution needs --brace-angle",
        f"{SI} --displacement 0.1 --frequency-hz 1:2": "--displacement with an axis of --frequency-hz varies amplitude and",
    },
    "explore": {
        "--no-browser --port=-1": "--port must be a whole number in [0, 65535]; got -1",
        "--no-browser --port=abc": "--port must be a whole number in [0, 65535]; got abc",
    },
    "assess": {
        "": "Missing argument 'FILE'.",
        "nowhere.toml": "FILE must name a TOML file; got 'nowhere.toml': No such file or directory",
        "push.csv": "FILE must name a TOML file; got 'push.csv': ",
        "example --output bare.txt/here": "--output must be a folder that can be written; ",
    },
    "paper": {
        "99": "FIGURE must be among ",
        "1 pulses-and-earthquakes": "FIGURE must be among … got 'pulses-and-earthquakes' "
        "(the reports are yim-lin-1991 and pulses-and-earthquakes)",
        "1 --output bare.txt/here": "--output must be a folder that can be written; ",
    },
    "cite": {
        "extra": "Got unexpected extra argument (extra)",
    },
}
"""Beginnings of messages by options of each command; … stands for a part that is not compared."""


@pytest.mark.parametrize(
    "command, options", [(command, options) for command, rows in REFUSED.items() for options in rows]
)
def test_what_is_invalid_is_refused_in_one_line_and_leaves_no_file(rocking, command, options):
    before = set(Path().iterdir())
    code, message, out = rocking(f"{command} {options}")
    assert (code, out) == (2, "")
    start, _, end = REFUSED[command][options].partition("…")
    assert message.startswith(start)
    assert message.endswith(end)
    assert set(Path().iterdir()) == before


def test_number_of_cycles_is_checked_before_orbits_are_followed(rocking, monkeypatch):
    monkeypatch.setattr(sys.modules["rocking.orbits.frequency_response"], "continue_orbit", pytest.fail)
    line = "frequency-response --amplitude 2 --period 0.5:2.5:9 --restitution 0.925 --max-cycles 0"
    assert rocking(line)[1].startswith("--max-cycles must be a whole number in [1, ")


TEXTS = [
    "x",
    "1:x",
    "1:1",
    "1:1:9",
    "1:nan",
    "0:inf:3",
    "1:2:1",
    "1:2:1e7",
    "1:2:2.5",
    "1:2:3:4",
    f"{'1' * 5_000}:",
]


@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize(
    "kind", [options.VALUES, options.AXIS, options.ONE_RANGE, options.RANGE], ids=lambda kind: kind.name
)
def test_text_that_is_no_axis_and_no_range_is_refused_with_an_example(kind, text):
    with pytest.raises(ValueError, match="^--period must be ") as refused:
        kind.read("--period", text)
    got = repr(text) if len(text) < 10 else f"'{'1' * 58}…"
    assert re.fullmatch(
        rf"--period must be .* with finite START ≠ STOP.*; got {got} \(example: [-\d:]+\)", str(refused.value)
    )


@pytest.mark.parametrize(
    "text, kind", [("1:2:3", options.ONE_RANGE), ("1", options.AXIS), ("1", options.RANGE)]
)
def test_number_axis_and_range_are_told_apart(text, kind):
    with pytest.raises(ValueError, match="^--period must be "):
        kind.read("--period", text)
