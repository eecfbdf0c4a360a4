"""Help pages: they fit the terminal, and their examples run as printed, apart from their size. tests/golden holds their text."""

import re
import shlex

import pytest

import record_files as write
from rocking.cli.commands import COMMANDS as TABLE

COMMANDS = [command.name for command in TABLE]
FEWER = {"orbits": " --effort 0.05", "basins": " --boundary-runs 100"}
"""Options that make the examples of a command shorter."""
WITHOUT_EXAMPLES = {"explore", "cite"}
SLOW = {"record", "paper"}


def examples(printed, command):
    """Return the examples at the end of a help page, each on one line."""
    lines = printed.partition("\n  Examples:\n")[2].replace("\\\n", " ")
    return [
        " ".join(line.split()) for line in re.findall(rf"^  (rocking {command} .+)$", lines, re.MULTILINE)
    ]


def made_small(example):
    """Return an example with fewer points, cycles or samples, which run the same code in less time."""
    # the third number of an axis; the second one of a range is its end
    example = re.sub(r"(:[^ :]+:)(\d+)\b(?= |$)", lambda axis: f"{axis[1]}{min(int(axis[2]), 9)}", example)
    return re.sub(r"--samples \d+", "--samples 50", example) + FEWER.get(example.split()[1], "")


def write_what_they_read(folder):
    """Write the files that the examples name: times of impacts, records of a site and its hazard."""
    (folder / "times.txt").write_text("0.0 0.9 1.68 2.36 2.97 3.52 4.02")
    (folder / "hazard.csv").write_text("PGA (g),annual rate\n0.1,0.01\n0.4,0.001\n1.6,0.00002\n")
    (folder / "records").mkdir()
    for name, push in (("near", 0.4), ("far", -0.3)):
        samples = [0.0, push, -push, push / 2, 0.0] * 20
        (folder / "records" / f"{name}.at2").write_text("\n".join(write.peer(samples)))


@pytest.mark.parametrize("command", ["", *COMMANDS])
def test_help_fits_the_terminal_and_breaks_no_name(rocking, monkeypatch, command):
    for columns, option in ((80, "-h"), (120, "--help")):
        monkeypatch.setenv("COLUMNS", str(columns))
        printed = rocking(f"{command} {option}")[2]
        assert max(map(len, printed.splitlines())) <= columns
        assert not re.search(r"\w-$|Default:$", printed, re.MULTILINE)
        assert not set(printed) & {"\u2011", "\u00a0", "\b"}


def test_block_overturns_in_the_example_that_says_so(rocking):
    printed = rocking("record --help")[2]
    line = printed[printed.index("the block overturns.") :].splitlines()[1]
    assert "overturned: certain" in rocking(line.strip(" \\").removeprefix("rocking "))[2]


@pytest.mark.parametrize(
    "command", [pytest.param(each, marks=pytest.mark.long) if each in SLOW else each for each in COMMANDS]
)
def test_each_example_can_be_copied_and_runs(rocking, tmp_path, command):
    code, _, told = rocking(f"{command} --help")
    found = examples(told, command)
    assert code == 0
    assert bool(found) == (command not in WITHOUT_EXAMPLES)
    write_what_they_read(tmp_path)
    for number, example in enumerate(found):
        code, message, _ = rocking(made_small(example).removeprefix("rocking "))
        assert (code, message) == (0, ""), example
        typed = shlex.split(example)
        named = [
            typed[typed.index(option) + 1] for option in ("--plot", "--store", "--output") if option in typed
        ]
        assert all((tmp_path / name).exists() for name in named), number
