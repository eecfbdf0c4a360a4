"""Output of `--help`: whole sentences, and examples that work as printed, tried at a smaller size."""

import re
import shlex

import pytest
import typer

from rocking.cli.app import app

COMMANDS = list(typer.main.get_command(app).commands)
WITHOUT_EXAMPLES = {"explore", "cite"}


def examples(told, command):
    return re.findall(rf"^  (rocking {command} .+)$", told, re.MULTILINE)


def made_small(example):
    """Return the example with fewer points, cycles or samples: 9 along an axis test as much as 300."""
    example = re.sub(r"(:\d+)\b(?= |$)", lambda count: f":{min(int(count[0][1:]), 9)}", example)
    return re.sub(r"--samples \d+", "--samples 50", example)


def test_list_of_commands_has_whole_sentences(rocking):
    code, _, told = rocking("--help")
    listed = told.partition("Commands:\n")[2].splitlines()
    assert code == 0
    assert [line.split()[0] for line in listed] == COMMANDS
    assert all(line.endswith(".") and not line.endswith("...") for line in listed)


def test_short_name_of_the_option_is_known_to_all(rocking):
    for command in ("", *COMMANDS):
        assert rocking(f"{command} -h") == rocking(f"{command} --help")


@pytest.mark.parametrize("command", COMMANDS)
def test_each_example_stands_on_a_line_of_its_own_and_runs(rocking, tmp_path, command):
    code, _, told = rocking(f"{command} --help")
    found = examples(told, command)
    assert code == 0
    assert not set(told) & {"\\", "\b"}
    assert bool(found) == (command not in WITHOUT_EXAMPLES)
    for number, example in enumerate(found):
        code, message, _ = rocking(made_small(example).removeprefix("rocking "))
        assert (code, message) == (0, ""), example
        typed = shlex.split(example)
        named = [
            typed[typed.index(option) + 1] for option in ("--plot", "--store", "--output") if option in typed
        ]
        assert all((tmp_path / name).exists() for name in named), number
