"""Help pages: whole sentences, groups of options, defaults, and examples that run as printed, apart from their size."""

import re
import shlex

import pytest

from rocking.cli.commands import COMMANDS as TABLE

COMMANDS = [command.name for command in TABLE]
FEWER = {"orbits": " --effort 0.05", "basins": " --boundary-runs 100"}
"""Options that make the examples of a command shorter."""
WITHOUT_EXAMPLES = {"explore", "cite"}
SLOW = {"record", "paper", "fragility"}
WITH_BLOCK = {"record", "spectrum", "fragility", "overturning-set", "sensitivity"}
WITH_SYSTEM = set(COMMANDS) - {"explore", "paper", "cite"} - WITH_BLOCK


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


def test_list_of_commands_has_whole_sentences(rocking):
    code, _, told = rocking("--help")
    listed = told.partition("Commands:\n")[2].splitlines()
    assert code == 0
    assert [line.split()[0] for line in listed] == COMMANDS
    assert all(line.endswith(".") and not line.endswith("...") for line in listed)


@pytest.mark.parametrize("command", ["", *COMMANDS])
def test_help_fits_the_terminal_and_breaks_no_name(rocking, monkeypatch, command):
    for columns, option in ((80, "-h"), (120, "--help")):
        monkeypatch.setenv("COLUMNS", str(columns))
        printed = rocking(f"{command} {option}")[2]
        assert max(map(len, printed.splitlines())) <= columns
        assert not re.search(r"\w-$|Default:$", printed, re.MULTILINE)
        assert not set(printed) & {"\u2011", "\u00a0", "\b"}


@pytest.mark.parametrize("command", COMMANDS)
def test_options_stand_in_their_groups_with_their_defaults(rocking, command):
    printed = rocking(f"{command} --help")[2]
    assert "[default:" not in printed
    assert ("Normalised input:\n" in printed) == (command in WITH_SYSTEM)
    assert ("SI input:\n" in printed) == (command in WITH_SYSTEM | WITH_BLOCK)
    assert ("θcr is the critical angle" in printed) == ("SI input:\n" in printed)
    assert ("AXIS" in printed.partition("Examples:")[0]) == ("START:STOP:COUNT" in printed)
    if command in WITH_SYSTEM:
        normalised, _, rest = printed.partition("Normalised input:\n")[2].partition("\nSI input:\n")
        physical, _, others = rest.partition("\nOptions:\n")
        assert re.findall(r"^  --([\w-]+)", normalised, re.MULTILINE) == [
            name
            for name in re.findall(r"^  --([\w-]+)", printed, re.MULTILINE)
            if name in ("amplitude", "period", "frequency")
        ]
        assert {"height", "width", "frequency-hz"} <= set(
            re.findall(r"^  --([\w-]+)", physical, re.MULTILINE)
        )
        assert others.startswith("  --restitution ")


@pytest.mark.parametrize(
    "command", [pytest.param(each, marks=pytest.mark.long) if each in SLOW else each for each in COMMANDS]
)
def test_each_example_can_be_copied_and_runs(rocking, tmp_path, command):
    code, _, told = rocking(f"{command} --help")
    found = examples(told, command)
    assert code == 0
    assert bool(found) == (command not in WITHOUT_EXAMPLES)
    for number, example in enumerate(found):
        code, message, _ = rocking(made_small(example).removeprefix("rocking "))
        assert (code, message) == (0, ""), example
        typed = shlex.split(example)
        named = [
            typed[typed.index(option) + 1] for option in ("--plot", "--store", "--output") if option in typed
        ]
        assert all((tmp_path / name).exists() for name in named), number
