"""Text in one column of acceleration, in two of time and acceleration, or in more under a line of titles."""

from __future__ import annotations

import math
import re
from typing import NamedTuple

from attrs import evolve

from rocking.model.text import counted, formatted
from rocking.records.counted import is_count, stated_peak, vertical_component, vertical_of
from rocking.records.text_file import (
    MAX_SAMPLES,
    NUMBER,
    ROW,
    Channel,
    TextFile,
    in_plain_numbers,
    mixes_commas,
    with_exponent_e,
)
from rocking.records.times import PrintedTimes, printed_times
from rocking.records.units import (
    IN_BRACKETS,
    OTHER_TIMES,
    SEPARATOR,
    TIMES,
    cells,
    header_units,
    is_line_of_units,
    is_other,
    titles,
    unit_of,
)

COMMENT = re.compile(r"\s*(?:[#%!]|//|$)")
WORD = re.compile(r"[^\W_]+")
TIME = {"t", "time", "times"}
ACCELERATION = re.compile(r"acc(?:el(?:erations?)?)?|a", re.IGNORECASE)
BRACKETED = re.compile(r"(?:^|(?<=[\])]))[^\[\]()]++[\[(][^\[\]()]*[\])]")
"""Title with its unit in brackets."""
DIRECTION = re.compile(
    r"ns|sn|ew|we|ud|du|[nsewzxylr]|up|down|dwn|ver(?:t(?:ical)?)?|lon(?:g(?:itudinal)?)?|tra(?:n(?:s(?:verse)?)?)?"
    r"|a[xyz]|h[12]?|hor(?:iz(?:ontal)?)?[12]?|[ns]?\d{1,3}[ew]?|[behls][hln][enz123]",
    re.IGNORECASE,
)
"""Word that names the direction of a component."""
OTHER_QUANTITY = re.compile(r"(?:vel|disp)", re.IGNORECASE)
STATED = re.compile(
    r"\b(?:(dt|delta[ _-]?t|step|interval)|sampl(?:ing|e) (?:rate|frequency))\b"
    rf"(?:\s*[=:]?\s*({NUMBER.pattern})\s*(seconds?|sec|s|hz)?\s*(?:[;)]|,(?!\d)|$))?",
    re.IGNORECASE,
)
"""Word for the time step or the sampling rate above a column of samples, its number and the unit; no number if more follows."""
OF_OTHER_SAMPLES = re.compile(
    r"\b(?:original|raw|uncorrected|resampled|decimated|interpolated)", re.IGNORECASE
)
LARGEST_PLAIN_STEP = 0.1
"""Largest time step that is taken to be in s without its unit."""
SAME_STEP = 0.05
"""Relative difference between the step that a header states and that of the times, which are rounded."""
SPECTRAL = re.compile(r"(?i:p?sa\b|spe[ck]tral acc|response spe[ck]tr)|P?Se\b")
"""Last title of a response spectrum."""
NO_TIMES = {
    "t",
    "f",
    "natural",
    "period",
    "periods",
    "periode",
    "periodo",
    "freq",
    "frequency",
    "frequenz",
    "frecuencia",
}
"""Words of the first title of a spectrum."""
NUMBERS = {"step", "index", "sample", "samples", "number", "no"}
"""Words of the title of a column that numbers the samples, and holds no times."""
HEADER_LINES = 100
MOST_COLUMNS = 4
"""Time and three components; lines of more numbers in general hold samples one after another."""


class Title(NamedTuple):
    """Title of a column of acceleration."""

    name: str
    unit: str | None


def recognises(file: TextFile) -> bool:
    """Return whether the text has rows of one or two numbers, or of more under a line of titles."""
    return not unlike(file)


def unlike(file: TextFile) -> str:
    """Return what a text without readable columns has instead, with the line; empty for columns."""
    file = in_plain_numbers(file)
    lines = file.lines[: HEADER_LINES + 1]
    first = _first_row(file)
    if first is None:
        row = next((index for index, line in enumerate(lines) if re.match(r"\s*[-+.]?\d", line)), None)
        if row is not None:
            return f", line {row + 1}: numbers alone expected; got {formatted(lines[row].strip())}"
        begin = next(line for line in file.lines if line.strip()).strip()
        return f": neither a record nor a table with a column 'file'; it begins with {formatted(begin)}"
    width = len(_parts(lines[first]))
    if width <= 2 or _heads(file, first, width):
        return ""
    if mixes_commas(lines[first]):
        rule = "commas separate the numbers and stand in them: put ; between the numbers"
        return f", line {first + 1}: {rule}; got {formatted(lines[first].strip())}"
    rule = f"more than two need a line of {width} titles that begins with the time, such as time,NS,EW"
    if width > MOST_COLUMNS:
        rule = "for samples one after another, put a line with their number and the time step before them, such as 1560 0.02"
    return f", line {first + 1}: {width} numbers in a line; {rule}"


def read(file: TextFile) -> list[Channel]:
    """Read the only channel, or one for each title."""
    file = in_plain_numbers(file)
    first = _first_row(file)
    assert first is not None
    width = len(_parts(file.lines[first]))
    places, rows = _rows(file, first, width)
    if width <= 2:
        _check_titles(file, first, width)
        titled, header = [_only_title(file, first, width)], file.lines[:first]
    else:
        titled = _titles(file, first, width)
        header = [line for line in file.lines[:first] if len(cells(line)) != width]
    units = header_units(header)
    times = None if width == 1 else printed_times(file, places, [row[0] for row in rows])
    step = _step(header) if width == 1 else None
    if times is None:
        _check_first(file, places, rows)
    else:
        _check_running(file, first, rows, times)
        times = _with_stated(times, _step(header))
    peak = stated_peak(file, first) if len(titled) == 1 else None
    result = []
    for place, (name, unit) in enumerate(titled, width - len(titled)):
        samples = file.numbers(places, [row[place] for row in rows], "a sample")
        others = units.named if width == 2 else frozenset()
        stated = units._replace(named=others | {unit}) if unit else units
        result.append(
            Channel(samples, stated.only(), step, "text", "", name, peak, header=stated, times=times)
        )
    return result


def _step(header: list[str]) -> float | None:
    """Return the time step in s that the lines above a column of samples state; None if they do not, or if there is a doubt."""
    found = {
        None if OF_OTHER_SAMPLES.search(line) else _stated_step(*match)
        for line in header
        for match in STATED.findall(line)
    }
    return found.pop() if len(found) == 1 else None


def _stated_step(word: str, number: str, unit: str) -> float | None:
    """Return the step of a match of `STATED`; of a sampling rate, whose word is empty, the inverse."""
    if not number or (unit.lower() == "hz") == bool(word) or not (unit or word):
        return None
    value = float(with_exponent_e(number))
    if not 0.0 < value <= (math.inf if unit else LARGEST_PLAIN_STEP) or math.isinf(value):
        return None
    return value if word else 1.0 / value


def _check_first(file: TextFile, places: list[int], rows: list[list[str]]) -> None:
    """Refuse a whole number above a column of samples with decimals: it may be their number, and nothing says so."""
    if len(rows) > 1 and is_count(rows[0][0]) and not any(row[0].isdigit() for row in rows[1:]):
        rule = f"remove each line that is no sample, or write {rows[0][0]}.0 if it is one"
        raise file.error(places[0], f"{rows[0][0]} stands above numbers with decimals; {rule}")


def _check_running(file: TextFile, first: int, rows: list[list[str]], times: PrintedTimes) -> None:
    """Refuse 0, 1, 2, … or 1, 2, 3, … in a first column, unless a title says that they are s, or a time."""
    if times.step != 1.0 or times.values[0] not in (0.0, 1.0):
        return
    width, titled = len(rows[0]), []
    for line in file.lines[:first]:
        heads = [head[0] for head in (_cells(line, width), titles(line)) if len(head) == width]
        titled.append({word.lower() for head in heads for word in WORD.findall(head)})
    numbers = bool(next(filter(None, titled[::-1]), set()) & NUMBERS)
    whole = all(row[0].isdigit() or "E" in row[0].upper() for row in rows)
    if (whole or numbers) and not any(each & TIMES or (each & TIME and not numbers) for each in titled):
        rule = "if it is no time in s, remove it, and give the step if no line states it; or put a title such as time (s) above it"
        raise file.error(first, f"the first column numbers the samples; {rule}")


def _with_stated(times: PrintedTimes, stated: float | None) -> PrintedTimes:
    """Return the times of a column with a doubt if the header states another step than theirs."""
    if stated is None or times.step is None or math.isclose(stated, times.step, rel_tol=SAME_STEP):
        return times
    doubt = f"the times give a step of {times.step:g} s, which is taken; the header states {stated:g} s"
    return evolve(times, doubt="; ".join(filter(None, (times.doubt, doubt))))


def _rows(file: TextFile, first: int, width: int) -> tuple[list[int], list[list[str]]]:
    """Return the lines with numbers, and their numbers as text."""
    places, rows = [], []
    for index in range(first, len(file.lines)):
        row = _parts(file.lines[index])
        if len(row) == width:
            places.append(index)
            rows.append(row)
        elif not COMMENT.match(file.lines[index]):
            raise file.error(
                index, f"{counted(width, 'number')} expected; got {formatted(file.lines[index].strip())}"
            )
    if len(rows) > MAX_SAMPLES:
        raise file.error(places[MAX_SAMPLES], f"more than {MAX_SAMPLES:,} samples")
    return places, rows


def _first_row(file: TextFile) -> int | None:
    return next((index for index, line in enumerate(file.lines[: HEADER_LINES + 1]) if _parts(line)), None)


def _parts(line: str) -> list[str]:
    """Return the numbers of a line as text; none if it has anything else, or a decimal comma."""
    return [] if ("," in line and ";" in line) or not ROW.fullmatch(line) else NUMBER.findall(line)


def _heads(file: TextFile, first: int, width: int) -> tuple[int, list[str], list[str]] | None:
    """Return the place and the cells of the last line of titles that begins with the time, and those of a line of units after it."""
    lines = [
        (k, result)
        for k, line in enumerate(file.lines[:first])
        if len(result := _cells(line, width)) == width
    ]
    heads = [k for k, (_, result) in enumerate(lines) if TIME & {*map(str.lower, WORD.findall(result[0]))}]
    if not heads:
        return None
    place, head = lines[heads[-1]]
    below = (
        result for _, result in lines[heads[-1] + 1 :] if _plain(result[0]).lower() in (*TIMES, *OTHER_TIMES)
    )
    return place, head, next(below, [])


def _cells(line: str, width: int) -> list[str]:
    """Return the cells of a line of titles; those that end with a bracket, or lie between two blanks, if so there are `width`."""
    result, plain = cells(line), line.strip().lstrip("#%!/ ")
    if len(result) == width or _has_value(plain):
        return result
    others = BRACKETED.findall(plain), re.split(r"\s{2,}", plain)
    return next((each for each in others if len(each) == width), result)


def _has_value(line: str) -> bool:
    """Return whether a digit stands outside the brackets of a line."""
    return re.search(r"\d", IN_BRACKETS.sub("", line)) is not None


def _titles(file: TextFile, first: int, width: int) -> list[Title]:
    """Return the titles of all columns but the time; an error names a column that may hold another quantity."""
    result = _heads(file, first, width)
    assert result is not None
    place, head, below = result
    time = {*map(str.lower, WORD.findall(head[0])), *map(str.lower, WORD.findall(below[0] if below else ""))}
    if not time <= {*TIME, *TIMES, "in", "elapsed"}:
        raise file.error(
            place, f"times in s expected; the header gives {formatted(' '.join([head[0], *below[:1]]))}"
        )
    titled = [_title(file, place, *each) for each in zip(head[1:], below[1:] or [""] * width, strict=False)]
    with_unit = sum(each.unit is not None for each in titled)
    if 0 < with_unit < len(titled):
        lacks = next(cell for cell, each in zip(head[1:], titled, strict=True) if each.unit is None)
        raise file.error(
            place, f"a unit of acceleration expected in the title {formatted(lacks)}, as in others"
        )
    return titled


def _title(file: TextFile, place: int, cell: str, below: str) -> Title:
    """Return a title as the words that name a direction, and its unit of acceleration."""
    bracket = (IN_BRACKETS.findall(cell) or [""])[-1]
    words = WORD.findall(cell)
    unit = unit_of(_plain(below) or bracket)
    if not below and unit is not None:
        words = WORD.findall(IN_BRACKETS.sub("", cell))
    elif not (below or bracket) and len(words) > 1 and unit_of(words[-1]) is not None:
        unit = unit_of(words.pop())
    names = [word for word in words if not ACCELERATION.fullmatch(word)]
    known = [DIRECTION.fullmatch(word) or (unit is not None and word in ("v", "V")) for word in names]
    if (_plain(below) and unit is None) or not all(known):
        shape = "name directions and units of acceleration, such as time (s),NS (g),EW (g), and remove other columns"
        raise file.error(
            place,
            f"{formatted(' '.join(filter(None, (cell, below))))} is not known as an acceleration; {shape}",
        )
    return Title(" ".join(names), unit)


def _plain(cell: str) -> str:
    return cell.strip("[]() ")


def _only_title(file: TextFile, first: int, width: int) -> Title:
    """Return the direction in the title of the only column of acceleration, or a vertical one above it; of two columns the unit, too."""
    result = _heads(file, first, width) if width == 2 else None
    cell = result[1][1] if result else file.lines[first - 1] if width == 1 and first else ""
    bracketed = unit_of((IN_BRACKETS.findall(cell) or [""])[-1])
    if width == 1 and bracketed is None:
        cell = ""
    unit = bracketed if width == 2 else None
    words = WORD.findall(IN_BRACKETS.sub(_direction_alone, cell))
    names = [word for word in words if not ACCELERATION.fullmatch(word)]
    known = [DIRECTION.fullmatch(word) or (bracketed is not None and word in ("v", "V")) for word in names]
    if names and all(known):
        return Title(" ".join(names), unit)
    named = "".join(word for word in names if word.lower() not in ("component", "comp", "motion"))
    return Title(vertical_of(named) or vertical_component(file.lines[:first]), unit)


def _direction_alone(bracket: re.Match[str]) -> str:
    """Return what a bracket holds if it is a direction and no unit, as in acc (Z) (m/s2)."""
    return bracket[0] if DIRECTION.fullmatch(bracket[1]) and unit_of(bracket[1]) is None else ""


def _heads_a_spectrum(head: list[str]) -> bool:
    """Return whether two titles are those of a spectrum: period or frequency, and an acceleration."""
    words = {*map(str.lower, WORD.findall(IN_BRACKETS.sub("", head[0])))}
    if (
        not words
        or not words <= NO_TIMES
        or unit_of((IN_BRACKETS.findall(head[-1]) or head[-1:])[-1]) is None
    ):
        return False
    return "t" not in words or SPECTRAL.match(head[-1]) is not None


def _check_titles(file: TextFile, first: int, width: int) -> None:
    """Refuse columns whose titles or unit line state another quantity than acceleration, or times that are not in s."""
    last = max((k for k in range(first) if len(_cells(file.lines[k], width)) == width > 1), default=None)
    if last is not None and _heads_a_spectrum(head := _cells(file.lines[last], width)):
        given = ", ".join(head)
        raise file.error(last, f"times in s and accelerations expected; the header gives {formatted(given)}")
    for index in range(first):
        line = file.lines[index]
        result = bracketed = IN_BRACKETS.findall(line)
        time = bracketed[0].strip().lower() if len(bracketed) == width > 1 else ""
        if time not in TIMES and (time not in OTHER_TIMES or index != last or _has_value(line)):
            result = titles(line)
            if len(result) != width or not (SEPARATOR.search(line) or is_line_of_units(line)):
                continue  # words
        if is_other(result[-1]) or OTHER_QUANTITY.match(cells(line)[-1]):
            units = "m/s², cm/s², mm/s², g or gal"
            raise file.error(
                index, f"acceleration in {units} expected; the header gives {formatted(result[-1])}"
            )
        if width > 1 and {*OTHER_TIMES} & {result[0].lower(), *map(str.lower, WORD.findall(cells(line)[0]))}:
            raise file.error(index, f"times in s expected; the header gives {formatted(result[0])}")
