"""Set of ground motions from a folder, a list of files, or a table with one row per file."""

from __future__ import annotations

import csv
import math
import os
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from attrs import evolve

from rocking.model.files import resolve_path
from rocking.model.ground_motion import GroundMotion, vertical_sentence
from rocking.model.record_set import RecordSet
from rocking.model.stations import RULES, stations
from rocking.model.text import counted, formatted, listed
from rocking.model.validation import RecordError, Refusal, WrongType, members, one_of, warn_of_input
from rocking.records.read import read_ground_motion, read_ground_motions
from rocking.records.text_file import TEXTS, Content, TextFile, decoded

FILE = "file"
OWN = (FILE, "channel", "scale", "units", "step", "name")
"""Columns with a meaning of their own. Each other column holds a number per row."""
DELIMITERS = ",;\t"
HEAD = 10_000
"""Bytes of a file in which its first line is sought."""


class Row(NamedTuple):
    """Row of a table; None for an empty cell."""

    place: str
    """Name of the table and line, for messages."""
    path: Path
    channel: int | None
    scale: float | None
    units: str | None
    step: float | None
    name: str
    numbers: dict[str, float]
    """Values of the other columns; NaN for an empty cell."""


def is_table(path: Path) -> bool:
    """Return whether the first line of a file names a column `file`."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        first = decoded(file.read(HEAD)) or ""
    return _delimiter(first.partition("\n")[0]) is not None


def rows(path: Path) -> list[Row]:
    """Return the rows of a table; `RecordError` with the line of the first wrong cell."""
    text = TextFile(Content(path))
    delimiter = _delimiter(text.lines[0]) or ","
    lines = csv.reader(text.lines, delimiter=delimiter)
    heads = [cell.strip() for cell in next(_cells(lines, text.name))]
    heads = [head.lower() if head.lower() in OWN else head for head in heads]
    for number, head in enumerate(heads):
        if not head or head in heads[:number]:
            raise RecordError(
                f"{text.name}: columns must have distinct names; got {formatted(head)} in column {number + 1}"
            )
    result = []
    for cells in _cells(lines, text.name):
        if any(cell.strip() for cell in cells):
            place = f"{text.name}, line {lines.line_num}"
            if len(cells) > len(heads):
                raise RecordError(
                    f"{place}: {len(cells)} cells under {len(heads)} columns; put a text with commas in quotes"
                )
            values = dict.fromkeys(heads, "") | {
                head: cell.strip() for head, cell in zip(heads, cells, strict=False)
            }
            if delimiter != ",":  # that of a spreadsheet with decimal commas
                values |= {
                    head: re.sub(r"^([-+]?\d+),(\d+)$", r"\1.\2", cell) for head, cell in values.items()
                }
            result.append(_row(place, path.parent, values))
    if not result:
        raise RecordError(f"{text.name}: the table has no rows")
    return result


def _cells(lines: Any, name: str) -> Iterator[list[str]]:
    """Yield the cells of each row; `RecordError` for one that the CSV format forbids, such as a quote without its end."""
    try:
        yield from lines
    except csv.Error as error:
        raise RecordError(f"{name}, line {lines.line_num}: {error}; check the quotes") from error


def _delimiter(first: str) -> str | None:
    """Return the delimiter of a first line with a cell `file`; None without one."""
    cells = {each: [cell.strip(' "\r\n').lower() for cell in first.split(each)] for each in DELIMITERS}
    return next(
        (each for each in DELIMITERS if len(cells[each]) > 1 and FILE in cells[each]),
        "," if cells[","] == [FILE] else None,
    )


def _row(place: str, folder: Path, cells: dict[str, str]) -> Row:
    if not cells[FILE]:
        raise RecordError(f"{place}: the column 'file' is empty; give the path of a record file")
    channel = _number(place, "channel", cells.get("channel", ""))
    if not math.isnan(channel) and not (channel >= 1 and channel == int(channel)):
        raise RecordError(f"{place}: channel must be a whole number from 1; got {cells['channel']}")
    scale = _number(place, "scale", cells.get("scale", ""))
    if scale == 0.0:
        raise RecordError(f"{place}: scale must not be 0; leave the cell empty for the record as it is")
    step = _number(place, "step", cells.get("step", ""))
    return Row(
        place,
        folder / cells[FILE],
        None if math.isnan(channel) else int(channel),
        None if math.isnan(scale) else scale,
        cells.get("units") or None,
        None if math.isnan(step) else step,
        " ".join(cells.get("name", "").split()),
        {head: _number(place, head, cell) for head, cell in cells.items() if head not in OWN},
    )


def _number(place: str, head: str, cell: str) -> float:
    """Return the finite number in a cell, or NaN for an empty one."""
    if not cell:
        return math.nan
    try:
        value = float(cell)
    except ValueError:
        value = math.inf
    if not np.isfinite(value):
        remedy = "" if head in OWN else "; remove the column if it is no number of each record"
        raise RecordError(f"{place}: column {head!r} must hold numbers; got {formatted(cell)}{remedy}")
    return value


ALLOWED = "be a folder, a table with a column 'file', or paths of record files"
ONE_FOR_EACH = " for all files that do not state it; a table with a column {!r} gives it for each file"
"""Remedy for several files of which one lacks an argument."""
MOST_TOLD = 20
"""Number of files that cannot be read, up to which each is told."""
LEFT_OUT = ("readme", "license", "licence")
"""Beginnings of names of files that accompany records: they state their source and terms."""
OTHER_QUANTITIES = (".vt2", ".dt2", "_searchresults.csv")
"""Ends of names, in lower case, of files in downloads of PEER without acceleration: velocity, displacement and the search."""


def read_record_set(
    source: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    *,
    units: str | None = None,
    step: float | None = None,
    baseline: str = "none",
    component: str = "all",
) -> RecordSet:
    """Read a folder, a table or a list of record files: all channels of each but the vertical ones, or one of each station.

    A motion is named by its file and, in a file with several channels, by its component. A vertical channel is left out, because
    the base of a block moves horizontally; a table that names its number in the column `channel` keeps it.

    Parameters
    ----------
    source : path or iterable of paths
        Record files in one of three forms. Each component is a motion of its own, of any length.

        - A folder: all its files, sorted by name. Hidden files and files named README… or LICENSE… are left out. So are the
          files without acceleration in a download of PEER: .VT2, .DT2 and _SearchResults.csv.
        - Paths of record files, or the path of one.
        - A table: a CSV file with a column `file`, relative to the table. The columns `channel` (default: all horizontal channels),
          `scale` (a factor), `units`, `step` and `name` are optional. Each other column holds numbers, such as magnitudes, and
          becomes one of `RecordSet.columns`. An empty cell there is NaN.
    units, step, baseline
        As for `read_ground_motion`. Of several files, those that state the unit or the step keep their own. In a table, a cell
        takes precedence.
    component : {"all", "first", "larger"}
        Horizontal components of each station: all of them, or one by a rule, as `RecordSet.one_per_station`. Default: "all".

    Returns
    -------
    RecordSet
        Motions in the order of the files.

    Raises
    ------
    RecordError
        If a file cannot be read or is no record, or if a table has a wrong cell.
        Also if no channel is horizontal, or if two motions have the same name.
        Unit and step of a file must be stated once, by the file or by an argument.
    TypeError, ValueError
        If an argument is of the wrong type or lies outside its range.
    OSError
        If no file can have the path.

    Warns
    -----
    InputWarning
        As for `read_ground_motion`. Also if vertical channels, or files of a folder without acceleration, are left out. Also if the
        set holds several horizontal components of one station, whose results depend on each other. These are channels of one file,
        or records whose headers have the same name, step and number of samples.

    See Also
    --------
    read_ground_motions : All channels of one file.
    rocking_spectrum : Largest angles of blocks of many sizes under such a set.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> for name, pga in (("a", 1.5), ("b", 2.0)):
    ...     _ = (folder / f"{name}.txt").write_text(f"0 {pga} -1 0".replace(" ", chr(10)))
    >>> _ = (folder / "set.csv").write_text("file,scale,magnitude" + chr(10) + "a.txt,2,6.5" + chr(10) + "b.txt,,7.1")
    >>> records = read_record_set(folder / "set.csv", units="m/s²", step=0.01)
    >>> records.names, [motion.pga for motion in records], records.columns["magnitude"].tolist()
    (('a.txt', 'b.txt'), [3.0, 2.0], [6.5, 7.1])
    """
    values = {"units": units, "step": step, "baseline": baseline}
    one_of("component", component, ("all", *RULES))
    if isinstance(source, str | os.PathLike):
        path = Path(source)
        resolve_path("source", path)
        if path.is_dir():
            return _set(_of_files(_folder(path), values, _folder_remedy(path)), component, path.name)
        if is_table(path):
            return _of_table(path, values, component)
        return _set(_of_files([path], values), component, path.name)
    paths = [_path(each) for each in members("source", source, ALLOWED)]
    if not paths:
        raise Refusal("source", "name one record file at least", paths)
    return _set(_of_files(paths, values), component, "source")


Motions = TypeVar("Motions")


class _Member(NamedTuple):
    """Motion of a set, named."""

    motion: GroundMotion
    numbers: Mapping[str, float]
    chosen: bool
    """True if a table names the channel."""

    @property
    def label(self) -> str:
        return ", ".join(filter(None, (self.motion.name, self.motion.component)))


def _path(value: Any) -> Path:
    if not isinstance(value, str | os.PathLike):
        raise WrongType("source", ALLOWED, value)
    return Path(value)


def _folder(path: Path) -> list[Path]:
    """Return the files of a folder, sorted by name, without those that accompany records; warn of other quantities."""
    files = sorted(each for each in path.iterdir() if not each.name.lower().startswith((".", *LEFT_OUT)))
    others = [each.name for each in files if each.name.lower().endswith(OTHER_QUANTITIES)]
    if len(files) == len(others):
        raise RecordError(f"{path}: the folder holds no record file; {TEXTS}")
    if others:
        left_out = f"{counted(len(others), 'file')} without acceleration left out"
        warn_of_input(f"{path}: {left_out}: {listed(others)}")
    return [each for each in files if each.name not in others]


def _folder_remedy(path: Path) -> str:
    return (
        f"; if it is no record, move it, or list the record files instead of the folder {path.name or path}"
    )


def _of_files(paths: Sequence[Path], values: dict[str, Any], remedy: str = "") -> list[_Member]:
    """Return the motions of files, each named by its file; by its path if several files have that name.

    `RecordError` on all files that cannot be read.
    """
    names = Counter(path.name for path in paths)
    several = len(paths) > 1
    result, refused = [], []
    for path in paths:
        try:
            if several:
                motions = _of_file(read_ground_motions, path, values, {})
            else:
                motions = read_ground_motions(path, **values)
        except RecordError as error:
            for_each = ONE_FOR_EACH.format(error.argument) if error.argument and several else ""
            refused.append(f"{error}{for_each}")
        else:
            result += _members(motions, path.name if names[path.name] == 1 else path.as_posix())
    if refused:
        raise RecordError(f"{_together(refused, len(paths))}{remedy}")
    return result


def _together(refused: Sequence[str], count: int) -> str:
    """Return the sentences on the files that cannot be read, of a number of files, as one."""
    if len(refused) == 1:
        return refused[0]
    numbered = " ".join(f"({number}) {sentence}" for number, sentence in enumerate(refused[:MOST_TOLD], 1))
    more = f" and {len(refused) - MOST_TOLD} more" if len(refused) > MOST_TOLD else ""
    return f"{len(refused)} of {count} files cannot be read: {numbered}{more}"


def _of_file(
    read: Callable[..., Motions], path: Path, values: dict[str, Any], own: dict[str, Any]
) -> Motions:
    """Read one of several files with values for all, and with its own ones; of the first, it keeps those that it states itself."""
    try:
        return read(path, **values | own)
    except RecordError as error:
        if error.argument in own or values.get(error.argument) is None:
            raise
        return _of_file(read, path, values | {error.argument: None}, own)


def _members(
    motions: Sequence[GroundMotion],
    name: str,
    numbers: Mapping[str, float] | None = None,
    *,
    chosen: bool = False,
) -> list[_Member]:
    """Return the motions of one file under its name, with distinct components if there are several."""
    several = Counter(motion.component for motion in motions)
    result = []
    for number, motion in enumerate(motions, 1):
        component = motion.component
        if len(motions) > 1 and not (component and several[component] == 1):
            component = ", ".join(filter(None, (component, f"channel {number}")))
        named = evolve(motion, name=name, component=component)
        result.append(_Member(named, numbers or {}, chosen=chosen))
    return result


def _of_table(path: Path, values: dict[str, Any], component: str) -> RecordSet:
    table = rows(path)
    names = Counter(row.path.name for row in table)
    result: list[_Member] = []
    for row in table:
        cells = (("units", row.units), ("step", row.step), ("channel", row.channel))
        own: dict[str, Any] = {name: value for name, value in cells if value is not None}
        try:
            motions: Sequence[GroundMotion]
            if row.channel is None:
                motions = _of_file(read_ground_motions, row.path, values, own)
            else:
                motions = (_of_file(read_ground_motion, row.path, values, own),)
            motions = [motion if row.scale is None else motion.scaled(row.scale) for motion in motions]
        except ValueError as error:
            raise RecordError(f"{row.place}: {error}") from error
        # Rows of one file differ by its components, or by the numbers of its channels.
        plain = (
            row.path.name
            if names[row.path.name] == 1 or row.channel is None
            else f"{row.path.name}, channel {row.channel}"
        )
        result += _members(motions, row.name or plain, row.numbers, chosen=row.channel is not None)
    return _set(result, component, path.name, f"{path.name}: ", "give distinct names in the column 'name'")


def _set(
    result: Sequence[_Member],
    component: str,
    source: str,
    place: str = "",
    remedy: str = "name each file once",
) -> RecordSet:
    """Return the set by the rule of its components, without vertical channels that nobody chose.

    `RecordError` if two motions have the same name.
    """
    kept = [each for each in result if each.chosen or not each.motion.vertical]
    left_out = [each.label for each in result if each.motion.vertical and not each.chosen]
    if not kept:
        rule = "no channel is horizontal, and the base of a block moves horizontally"
        raise RecordError(f"{source}: {rule}: {listed(left_out)}")
    label, count = Counter(each.label for each in kept).most_common(1)[0]
    if count > 1:
        raise RecordError(f"{place}{label} occurs {count} times; {remedy}")
    if left_out:
        warn_of_input(f"{source}: {counted(len(left_out), 'vertical channel')} left out: {listed(left_out)}")
    records = RecordSet(
        [each.motion for each in kept],
        {name: [each.numbers[name] for each in kept] for name in kept[0].numbers},
    )
    if component == "all":
        _warn_of_stations(records, source)
    else:
        records = records.one_per_station(component)
    _warn_of_copies(records, source)
    if records.vertical:
        warn_of_input(vertical_sentence(records.vertical))
    return records


SAME = 1 - 1e-6
"""Least correlation of the samples of a record and its copy, which may have fewer digits."""


def _warn_of_copies(records: RecordSet, source: str) -> None:
    """Warn of records that hold the samples of another one with a factor, which may be negative."""
    forms: dict[tuple[int, float], list[tuple[str, np.ndarray]]] = {}
    copies = []
    for name, motion in zip(records.names, records.motions, strict=True):
        samples = motion.acceleration
        size = np.linalg.norm(samples)
        if size == 0.0:
            continue
        form, earlier = samples / size, forms.setdefault((samples.size, motion.step), [])
        original = next((other for other, its in earlier if abs(form @ its) > SAME), None)
        if original is None:
            earlier.append((name, form))
        else:
            copies.append((name, original))
    if copies:
        first = "{} holds the samples of {}, perhaps with a factor".format(*copies[0])
        others = f", and {counted(len(copies) - 1, 'other record')} likewise" if len(copies) > 1 else ""
        warn_of_input(f"{source}: {first}{others}: each copy counts as a record, and says nothing new")


def _warn_of_stations(records: RecordSet, source: str) -> None:
    """Warn of stations with several horizontal components."""
    several = [places for places in stations(records.motions) if len(places) > 1]
    if several:
        which = f"several horizontal components of {counted(len(several), 'station')}"
        first = listed([records.names[place] for place in several[0]])
        doubt = (
            "their results depend on each other, and intervals that take them as independent are too narrow"
        )
        warn_of_input(
            f"{source}: {which} ({first}): {doubt}; take one of each, for example component='first'"
        )
