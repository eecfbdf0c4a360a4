"""Output of a command: files, which are checked before the computation, and what is printed."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click
from attrs import frozen

from rocking.cli.options import FILMS, InvalidInput, OutputFile, OutputFolder, option, refusals
from rocking.model.files import (
    TILES,
    check_replaceable,
    check_writable,
    replacing,
    replacing_hdf5,
    resolve_path,
)
from rocking.model.tables_and_json import as_typed, json_text
from rocking.model.text import formatted_path
from rocking.survey import export

if TYPE_CHECKING:
    from rocking.cli.requests import Request

Row = tuple[str, ...]
Table = Mapping[str, Any]
"""Columns by heading."""
WARNING = "warning: "
INPUT_FILES = {
    "study": "the study file",
    "file": "the record",
    "second": "the record of --second",
    "vertical": "the record of --vertical",
    "sources": "a record",
    "times": "the file of times",
    "hazard": "the table of the hazard",
}
"""Parameters of commands whose values are input files, and what these are in messages."""


def check_files(parameters: Iterable[click.Parameter], options: Mapping[str, Any]) -> dict[str, Path]:
    """Return the requested output files by the names of their options, of tiles their page.

    InvalidInput is raised for a file that cannot be written, and for outputs that would overwrite each other or an input.
    """
    requested = [each for each in parameters if each.name in options]
    folders = {each.name: options[each.name] for each in requested if isinstance(each.type, OutputFolder)}
    files = {each.name: options[each.name] for each in requested if isinstance(each.type, OutputFile)}
    # the order of the messages and of the lines "wrote ..."
    files = {name: files[name] for name in ("plot", "animate", "csv", "netcdf") if name in files}
    check_apart(folders | files, inputs_of(options))
    for each in requested:
        if isinstance(each.type, OutputFile):
            check_file(each.name, files[each.name], each.type.suffixes)
    if "tiles" in folders:
        with refusals():
            folder = check_replaceable("--tiles", folders["tiles"], TILES)
        files["tiles"] = folder / TILES.page
    return files


def check_file(name: str, path: Path, suffixes: Sequence[str]) -> None:
    """Raise InvalidInput for a file that cannot be written."""
    if path == Path("-"):
        raise InvalidInput(
            f"{option(name)} must be the path of a file; got '-' (files are not written to stdout: use --json for the summary)"
        )
    with refusals():
        check_writable(option(name), path, suffixes)


def inputs_of(options: Mapping[str, Any]) -> dict[Path, str]:
    """Return the input files of a command, and what they are in messages."""
    inputs: dict[Path, str] = {Path("/dev/stdout"): "the file to which stdout is redirected"}
    for name, what in INPUT_FILES.items():
        value = options.get(name, ())
        inputs |= dict.fromkeys((value,) if isinstance(value, Path) else value, what)
    return inputs


def check_apart(outputs: Mapping[str, Path], inputs: Mapping[Path, str]) -> None:
    """Raise InvalidInput for two outputs at one place, one output inside another, or an output in place of an input.

    The place of a link is that of its target.
    """
    taken: dict[Path, str] = {}
    for name, path in outputs.items():
        with refusals():
            place = resolve_path(option(name), path)
        for there, what in inputs.items():
            if is_same(place, there.resolve()):
                raise InvalidInput(f"{option(name)} must not overwrite {what}; got {formatted_path(path)}")
        for there, other in taken.items():
            if is_same(place, there):
                raise InvalidInput(
                    f"{option(other)} and {option(name)} must differ; got {formatted_path(path)} for both"
                )
            if place.is_relative_to(there) or there.is_relative_to(place):
                raise InvalidInput(
                    f"{option(other)} and {option(name)} must not lie inside each other; got {formatted_path(path)} for {option(name)}"
                )
        taken[place] = name


def is_same(one: Path, other: Path) -> bool:
    """Return whether two absolute paths without symbolic links are one place, also by hard links."""
    return one == other or (one.exists() and other.exists() and one.samefile(other))


# Files.


def write_csv(tables: Iterable[Table], path: Path) -> None:
    """Write tables with the same headings as one CSV file; a table maps headings to arrays."""
    import csv

    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        for number, table in enumerate(tables):
            if number == 0:
                writer.writerow(table)
            columns = (as_typed(name, column).tolist() for name, column in table.items())
            writer.writerows(zip(*columns, strict=True))


# Reports.


class Text(NamedTuple):
    """What is printed: a title, rows as columns, and further lines."""

    title: str
    rows: Iterable[Row]
    lines: Iterable[str] = ()


def _result(computed: Any) -> Any:
    return computed


def _nothing(*_: Any) -> dict[str, Any]:
    return {}


def of_dataset(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function of a result that passes its dataset to a given function."""
    return lambda result, *arguments: function(result.dataset, *arguments)


@frozen
class Report:
    """How a result is printed and written. Each function takes what the command computed and its request.

    `result` returns the result of what was computed, whose data the files and the JSON hold. `warnings` and `more` return further
    entries of the JSON. `figure` also takes `rocking.plot`.
    """

    text: Callable[[Any, Request], Text]
    figure: Callable[[Any, Any, Request], Any] | None = None
    warnings: Callable[[Any, Request], Iterable[str]] | None = None
    more: Callable[[Any, Request], dict[str, Any]] = _nothing
    result: Callable[[Any], Any] = _result
    table: str = ""
    """Table of the CSV file. Default: the principal one."""
    rows: Callable[[Any, Request], Iterable[Table]] | None = None
    """Tables of the CSV file in parts, if they are not those of the result."""
    in_parts: bool = False
    """Whether the files are written in parts, because the result may be larger than the memory."""

    def drawn(self, plot: Any, computed: Any, request: Request) -> Any:
        """Return the figure of the result."""
        if self.figure is not None:
            return self.figure(plot, computed, request)
        result = self.result(computed)
        beside = {} if request.block is None or result.block is not None else {"block": request.block}
        return result.plot(**beside)

    def tables(self, computed: Any, request: Request) -> Iterable[Table]:
        """Return the tables of the CSV file."""
        if self.rows is not None:
            return self.rows(computed, request)
        if self.in_parts:
            return export.tables(self.result(computed).dataset, request.block)
        tables = self.result(computed).tables(block=request.block)
        return [tables[self.table or next(iter(tables))]]

    def write_data(self, computed: Any, request: Request, path: Path) -> None:
        """Write the netCDF file."""
        if self.in_parts:
            export.to_netcdf(self.result(computed).dataset, path, request.block)
        else:
            with replacing_hdf5(path) as file:
                self.result(computed).to_xarray(block=request.block).to_netcdf(file, engine="h5netcdf")

    def json(self, computed: Any, request: Request) -> dict[str, Any]:
        """Return the JSON of the result, its warnings included."""
        entries = self.result(computed).to_dict(block=request.block) | self.more(computed, request)
        if self.warnings is not None:
            entries["warnings"] = list(self.warnings(computed, request))
        return entries


def write(report: Report, computed: Any, request: Request, files: Mapping[str, Path]) -> None:
    """Write the requested files of a result."""
    for name, path in files.items():
        if name == "csv":
            write_csv(report.tables(computed, request), path)
        elif name == "netcdf":
            report.write_data(computed, request, path)
        else:
            draw(report, computed, request, path)


def draw(report: Report, computed: Any, request: Request, path: Path) -> None:
    """Write the figure of a result, its animation or its tiles."""
    from rocking import plot

    if path.suffix.lower() in FILMS:
        plot.animation(computed, path, request.block)
    elif path.name == TILES.page:
        plot.tiles(computed, path.parent, request.block)
    else:
        plot.save(report.drawn(plot, computed, request), path)


@contextmanager
def complete(store: Path | None) -> Iterator[None]:
    """Report that the store is complete if the output after the survey is interrupted."""
    try:
        yield
    except KeyboardInterrupt:
        if store is not None:
            note = f"--store {formatted_path(store)} is complete; repeat the command to write the remaining files"
            print(f"rocking: {note}", file=sys.stderr)
        raise


def show(report: Report, result: Any, request: Request, paths: Sequence[Path]) -> None:
    """Print the result as a table or as JSON, and the paths of the files."""
    if request.options.get("json"):
        files = {"files": [str(path) for path in paths]}
        print(json_text(report.json(result, request) | files))
    else:
        print_table(report.text(result, request), paths)


def print_table(text: Text, files: Iterable[Path]) -> None:
    """Print a title, rows as columns, further lines, and the paths of the files written."""
    print(styled(text.title, bold=True))
    for line in aligned(list(text.rows)):
        print(line)
    for line in text.lines:
        print(styled(line, fg="yellow") if line.startswith(WARNING) else line)
    for path in files:
        print(f"wrote {path}")


def styled(text: str, **style: Any) -> str:
    """Return a text with a style if stdout is a terminal, unless the user wants no colours."""
    plain = not sys.stdout.isatty() or os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb"
    return text if plain else click.style(text, **style)


def aligned(rows: Sequence[Row]) -> Iterator[str]:
    """Yield the rows as lines of a table; lines are never cut, so that numbers stay whole in a narrow terminal."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        yield "   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
