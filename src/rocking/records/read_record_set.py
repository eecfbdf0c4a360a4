"""Set of ground motions from a folder, a table or a list of record files."""

from __future__ import annotations

import os
import re
import warnings
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from attrs import evolve

from rocking.model import GroundMotion, RecordSet, counted, members, refusal
from rocking.records.channel import RecordError
from rocking.records.read import read_ground_motion, read_ground_motions
from rocking.records.record_table import is_table, rows

ALLOWED = "be a folder, a table with a column 'file', or paths of record files"
LEFT_OUT = ("readme", "license", "licence")
"""Beginnings of names of files that accompany records: they state their source and terms."""
OTHER_QUANTITIES = (".vt2", ".dt2", "_searchresults.csv")
"""Ends of names, in lower case, of files in downloads of PEER without acceleration: velocity, displacement and the search."""
MAX_NAMED = 3
FORMATS = "PEER AT2, COSMOS, CSMIP, USC, SMC, K-NET, ESM, GeoNet, and text with one or two columns"


def read_record_set(
    source: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    *,
    units: str | None = None,
    step: float | None = None,
    baseline: str = "none",
) -> RecordSet:
    """Read a folder, a table or a list of record files: all channels of each, vertical ones included.

    A motion is named by its file and, in a file with several channels, by its component.

    Parameters
    ----------
    source : path or iterable of paths
        Record files in one of three forms. Each component is a motion of its own, of any length.

        - A folder: all its files, sorted by name. Hidden files and files named README… or LICENSE… are left out. So are the
          files without acceleration in a download of PEER: .VT2, .DT2 and _SearchResults.csv.
        - Paths of record files, or the path of one.
        - A table: a CSV file with a column `file`, relative to the table. The columns `channel` (default: all channels),
          `scale` (a factor), `units`, `step` and `name` are optional. Each other column holds numbers, such as magnitudes, and
          becomes one of `RecordSet.columns`. An empty cell there is NaN.
    units, step, baseline
        As for `read_ground_motion`, for all files. In a table, a cell takes precedence.

    Returns
    -------
    RecordSet
        Motions in the order of the files.

    Raises
    ------
    RecordError
        If a file cannot be read or is no record, or if a table has a wrong cell.
        Also if two motions have the same name. Unit and step of a file must be stated once, by the file or by an argument.
    TypeError, ValueError
        If an argument is of the wrong type or lies outside its range.

    Warns
    -----
    UserWarning
        As for `read_ground_motion`. Also if files of a folder without acceleration are left out.

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
    given = {"units": units, "step": step, "baseline": baseline}
    if isinstance(source, str | os.PathLike):
        path = Path(source)
        if path.is_dir():
            return _distinct(_of_files(_folder(path), given, _way_out_of(path)))
        if is_table(path):
            return _of_table(path, given)
        return _distinct(_of_files([path], given))
    paths = [_path(each) for each in members("source", source, ALLOWED)]
    if not paths:
        raise ValueError(refusal("source", "name one record file at least", paths))
    return _distinct(_of_files(paths, given))


def _path(value: Any) -> Path:
    if not isinstance(value, str | os.PathLike):
        raise TypeError(refusal("source", ALLOWED, value))
    return Path(value)


def _folder(path: Path) -> list[Path]:
    """Return the files of a folder, sorted by name, without those that accompany records; warn of other quantities."""
    files = sorted(each for each in path.iterdir() if not each.name.lower().startswith((".", *LEFT_OUT)))
    others = [each.name for each in files if each.name.lower().endswith(OTHER_QUANTITIES)]
    if len(files) == len(others):
        raise RecordError(f"{path}: the folder holds no record file; the formats are {FORMATS}")
    if others:
        names = ", ".join(others[:MAX_NAMED]) + ", …" * (len(others) > MAX_NAMED)
        left_out = f"{counted(len(others), 'file')} without acceleration left out: {names}"
        warnings.warn(f"{path}: {left_out}", stacklevel=3)
    return [each for each in files if each.name not in others]


def _way_out_of(path: Path) -> str:
    return (
        f"; if it is no record, move it, or list the record files instead of the folder {path.name or path}"
    )


def _of_files(paths: Sequence[Path], given: dict[str, Any], way_out: str = "") -> list[GroundMotion]:
    """Return the motions of files, each named by its file; by its path if several files have that name."""
    names = Counter(path.name for path in paths)
    found = []
    for path in paths:
        try:
            motions = read_ground_motions(path, **given)
        except RecordError as error:
            raise RecordError(f"{error}{_of_several(error) if len(paths) > 1 else ''}{way_out}") from error
        found += _named(motions, path.name if names[path.name] == 1 else path.as_posix())
    return found


def _of_several(error: RecordError) -> str:
    """Return the way out for an argument that suits some files and not others; empty for another error."""
    for name in ("units", "step"):
        if re.search(rf"(do not give {name}|for example {name}=\S+)$", str(error)):
            return f"; a table with a column {name!r} gives it for each file"
    return ""


def _named(motions: Sequence[GroundMotion], name: str) -> list[GroundMotion]:
    """Return the motions of one file under its name, with distinct components if there are several."""
    several = Counter(motion.component for motion in motions)
    components = [
        motion.component
        if len(motions) == 1 or (motion.component and several[motion.component] == 1)
        else ", ".join(filter(None, (motion.component, f"channel {number}")))
        for number, motion in enumerate(motions, 1)
    ]
    return [
        evolve(motion, name=name, component=part) for motion, part in zip(motions, components, strict=True)
    ]


def _of_table(path: Path, given: dict[str, Any]) -> RecordSet:
    table = rows(path)
    names = Counter(row.path.name for row in table)
    motions: list[GroundMotion] = []
    columns: dict[str, list[float]] = {name: [] for name in table[0].numbers}
    for row in table:
        own = given | {
            name: value for name, value in (("units", row.units), ("step", row.step)) if value is not None
        }
        try:
            if row.channel is None:
                found: Sequence[GroundMotion] = read_ground_motions(row.path, **own)
            else:
                found = (read_ground_motion(row.path, row.channel, **own),)
            found = [motion if row.scale is None else motion.scaled(row.scale) for motion in found]
        except ValueError as error:
            raise RecordError(f"{row.place}: {error}") from error
        # Rows of one file differ by its components, or by the numbers of its channels.
        plain = (
            row.path.name
            if names[row.path.name] == 1 or row.channel is None
            else f"{row.path.name}, channel {row.channel}"
        )
        motions += _named(found, row.name or plain)
        for name, value in row.numbers.items():
            columns[name] += [value] * len(found)
    return _distinct(motions, columns, f"{path.name}: ", "give distinct names in the column 'name'")


def _distinct(
    motions: Sequence[GroundMotion],
    columns: dict[str, list[float]] | None = None,
    place: str = "",
    way_out: str = "name each file once",
) -> RecordSet:
    """Return the set; `RecordError` if two motions have the same name."""
    labels = Counter(", ".join(filter(None, (motion.name, motion.component))) for motion in motions)
    label, count = labels.most_common(1)[0]
    if count > 1:
        raise RecordError(f"{place}{label} occurs {count} times; {way_out}")
    return RecordSet(motions, columns or {})
