"""Outputs of each command in a golden file: its command lines, and below each what it prints and writes.

A golden file holds lines "$ rocking ...", each followed by what the command prints, a summary of the files that it writes, and
its refusal. `python tests/golden/outputs.py` runs these lines again and rewrites the files; names of commands select some.
Numbers are rounded to six digits, and rounding errors are shown as "~0", so that the files do not depend on the processor.
"""

import contextlib
import io
import json
import math
import os
import re
import shlex
import sys
import tempfile
from pathlib import Path
from unittest import mock

import numpy as np
import xarray as xr

import rocking
from rocking.cli.main import run

FOLDER = Path(__file__).parent
FLOAT = re.compile(r"(?<![\w.])([-+−]?)(\d+\.\d+(?:e[-+]?\d+)?|\d+e[-+]?\d+)(?![\w.])")
DIGITS = 6
SLOW = re.compile(r"^computing \d+:\d\d:\d\d\n", re.MULTILINE)
"""Line that a command without a progress prints when it takes seconds, as on a busy computer."""
ROUNDING = 1e-9
"""Smaller sizes are rounding errors in the inputs of the golden files."""
WIDTH = "80"


def rounded(text):
    """Round the decimal numbers in a text; a line with a rounding error loses its alignment."""

    def replace(match):
        sign, digits = match.groups()
        value = float(digits)
        if 0.0 < value < ROUNDING:
            return "~0"
        short = f"{value:.{DIGITS}g}"
        return sign + (digits if float(short) == value else short)

    lines = []
    for line in text.splitlines():
        new = FLOAT.sub(replace, line.rstrip()).replace("≤ 0,", "≤ ~0,")
        lines.append(re.sub(r"(?<=\S) +", " ", new) if "~0" in new else new)
    return "\n".join(lines)


def rounded_value(value):
    """Round the numbers in what JSON holds."""
    if isinstance(value, dict):
        return {key: rounded_value(each) for key, each in value.items()}
    if isinstance(value, list):
        return [rounded_value(each) for each in value]
    if isinstance(value, float) and math.isfinite(value):
        return 0.0 if abs(value) < ROUNDING else float(f"{value:.{DIGITS}g}")
    return rounded(value) if isinstance(value, str) else value


def of_json(text):
    """Format JSON with one entry per line; of a long list, only its length and its first element."""

    def short(value):
        if isinstance(value, dict):
            return {key: short(each) for key, each in value.items()}
        if isinstance(value, list) and len(value) > 4:
            return [short(value[0]), f"... {len(value)} in all"]
        return [short(each) for each in value] if isinstance(value, list) else value

    return json.dumps(short(rounded_value(json.loads(text))), indent=1, ensure_ascii=False)


def of_csv(path):
    """Summarise a CSV file: its heading, its first row, and the number of rows."""
    heading, *rows = path.read_text().splitlines()
    first = ",".join(rounded(cell) for cell in rows[0].split(",")) if rows else ""
    return f"{heading}\n{first}\n{len(rows)} rows"


def of_netcdf(path):
    """Summarise a netCDF file: dimensions, variables and attributes."""

    def attributes(owner, indent):
        return [f"{indent}{name} = {of_attribute(value)}" for name, value in owner.attrs.items()]

    with xr.open_dataset(path, decode_cf=False) as found:
        lines = ["dimensions: " + ", ".join(f"{name} {size}" for name, size in found.sizes.items())]
        for name, variable in found.variables.items():
            lines.append(f"{variable.dtype} {name}({', '.join(variable.dims)})")
            lines += attributes(variable, "    ")
        return "\n".join([*lines, "attributes:", *attributes(found, "    ")])


def of_attribute(value):
    """Format an attribute of a netCDF file."""
    plain = value.tolist() if isinstance(value, np.ndarray | np.generic) else value
    return json.dumps(rounded_value(plain), ensure_ascii=False)


SUMMARIES = {".csv": of_csv, ".nc": of_netcdf}


def output(line):
    """Run a command line in an empty folder; return what it prints and writes."""
    printed, errors, before = io.StringIO(), io.StringIO(), Path.cwd()
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        os.chdir(folder)
        stack.callback(os.chdir, before)
        stack.enter_context(mock.patch.object(sys, "argv", shlex.split(line)))
        stack.enter_context(mock.patch.dict(os.environ, {"COLUMNS": WIDTH}))
        stack.enter_context(contextlib.redirect_stdout(printed))
        stack.enter_context(contextlib.redirect_stderr(errors))
        code, message = run()
        text = printed.getvalue()
        told = SLOW.sub("", errors.getvalue())
        parts = [of_json(text) if text.startswith(("{", "[")) else rounded(text), rounded(told)]
        parts += [f"exit {code}: {rounded(message)}" if code or message else ""]
        parts += [
            f"[{path.name}]\n{SUMMARIES[path.suffix](path)}"
            for path in sorted(Path(folder).iterdir())
            if path.suffix in SUMMARIES
        ]
    return "\n".join(part for part in parts if part).replace(rocking.__version__, "VERSION")


def recorded(path):
    """Return the text of a golden file as its command lines give it now."""
    lines = [line for line in path.read_text().splitlines() if line.startswith("$ ")]
    return "\n\n".join(f"{line}\n{output(line.removeprefix('$ '))}".rstrip() for line in lines) + "\n"


if __name__ == "__main__":
    for golden in sorted(FOLDER.glob("*.txt")):
        if golden.stem in sys.argv[1:] or not sys.argv[1:]:
            golden.write_text(recorded(golden))
