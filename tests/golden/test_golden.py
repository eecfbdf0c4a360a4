"""The commands print and write what their golden files hold: `python tests/golden/outputs.py` accepts a change."""

import pytest

from golden.outputs import FOLDER, recorded
from rocking.cli.commands import COMMANDS

FILES = sorted(FOLDER.glob("*.txt"))


def test_each_command_has_a_golden_file():
    assert {path.stem for path in FILES} == {"rocking", *(command.name for command in COMMANDS)}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_output_is_as_recorded(path):
    assert recorded(path).splitlines() == path.read_text().splitlines()
