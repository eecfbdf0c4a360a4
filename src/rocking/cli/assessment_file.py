"""File of an assessment: blocks, records, levels and limits in TOML, each key with its unit; all errors are reported together."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from attrs import Factory, define, frozen

from rocking.assessment.assess import UNCERTAIN, checked_friction, checked_period, checked_years, with_level
from rocking.cli.options import NUMBER, RESTRAINER, VALUES, Axis, InvalidInput
from rocking.cli.record_requests import drift_warnings
from rocking.cli.requests import values_of
from rocking.cli.study import text_of
from rocking.model.block import Block
from rocking.model.record_set import INTENSITIES, RecordSet
from rocking.model.restitution import Restitution
from rocking.model.system import Wall
from rocking.model.text import formatted_path
from rocking.model.validation import Refusal, Text, instance, refusal, similar
from rocking.records.record_set import read_record_set
from rocking.records.synthetic import synthetic_ground_motions
from rocking.survey.overturning_rate import hazard_curve

LENGTHS = ("height", "width", "offset", "centre_height", "radius_of_gyration")
UNITS = {"m": 1.0, "cm": 1e2, "mm": 1e3}
"""Lengths in a metre, by the end of a key."""
IMPACT = ("restitution", "restitution_factor", "wall")
"""Keys of the restitution, of which a block has at most one."""
PLAIN = (*IMPACT, "inertia_ratio", "friction")
ENDS = {"m/s²": "_m_per_s2", "m/s": "_m_per_s", "m": "_m", "1": "", "g": ""}
"""Ends of the keys of levels, by their unit; the name of a measure in g ends with it."""
MEASURES = {
    f"{name.replace('-', '_')}{ENDS[measure.unit]}": name for name, (measure, _) in INTENSITIES.items()
}
"""Keys of the levels, and the intensity measure of each."""
TOP = ("title", "by", "limits", "limits_deg", "sa_period_s", "polarity", "model", "seed")
SECTIONS = ("block", "records", "levels", "uncertain", "hazard")
OF_HAZARD = ("file", "levels", "rates_per_year", "years")
ADVICE = re.compile(r"(?:--)?\b(baseline|component|units)='([^']+)'")
STEP = re.compile(r"(?:--)?\bstep=([\d.e-]+)|(?<=omit )step\b|(?<=do not give )step\b")
"""Arguments in a message of the reader, which are keys of [records]."""
NO_RESTRAINER = "an assessment needs the base reactions of a free block"
EXAMPLE = 'pga_g = "0.1:1.2:23"'


@frozen
class NamedBlock:
    """Block of an assessment with its name and its coefficient of friction."""

    name: str
    block: Block
    friction: float | None


@frozen
class Case:
    """What a file of an assessment asks for.

    Attributes
    ----------
    path : Path
        The file.
    title, by : str
        Heading of the page, and the line below it.
    blocks : list of NamedBlock
        Blocks.
    records : RecordSet
        Records.
    inputs : list of Path
        Files that no output may replace.
    intensity : str
        Intensity measure of the levels.
    levels : array (n,)
        Levels.
    level : float or None
        Level of the rows.
    others : dict
        Further arguments of `assess`.
    names : dict
        Arguments of `assess` → keys of the file, for messages.
    warnings : list of str
        Warnings of the reader and of the block.
    """

    path: Path
    title: str
    by: str
    blocks: list[NamedBlock]
    records: RecordSet
    inputs: list[Path]
    intensity: str
    levels: np.ndarray
    level: float | None
    limits: list[float]
    limits_deg: list[float]
    others: dict[str, Any]
    names: dict[str, str]
    warnings: list[str]

    @property
    def place(self) -> str:
        """Name of the file in messages."""
        return self.path.name

    def limits_of(self, block: Block) -> list[float]:
        """Return the limits of |Θ| of a block."""
        return sorted([*self.limits, *np.atleast_1d(block.angle(degrees=self.limits_deg or [])).tolist()])


@define
class Errors:
    """Errors of a file, collected."""

    sentences: list[str] = Factory(list)

    @contextmanager
    def collected(self, names: Mapping[str, str] | None = None) -> Iterator[None]:
        """Keep the message of a refusal in the block; other names of arguments may be given."""
        try:
            yield
        except (TypeError, ValueError) as error:
            told = error.of(names) if isinstance(error, Refusal) and names else error
            if str(told) not in self.sentences:
                self.sentences.append(str(told))

    def unknown(self, entries: Mapping[str, Any], known: Iterable[str], where: str) -> None:
        """Add a sentence for each unknown key."""
        known = list(known)
        for key in entries:
            if key in known:
                continue
            if key in LENGTHS and any(each.startswith(f"{key}_") for each in known):
                keys = ", ".join(f"{key}_{unit}" for unit in UNITS)
                self.sentences.append(f"{key!r}{where} needs its unit: write one of {keys}")
                continue
            near = similar(key, known)
            hint = f"did you mean {near!r}?" if near else f"keys are {', '.join(known)}"
            self.sentences.append(f"unknown {key!r}{where} ({hint})")


def read_case(path: Path) -> Case:
    """Return what a file of an assessment asks for; InvalidInput with all errors of the file, before any computation."""
    entries, errors = entries_of(path), Errors()
    errors.unknown(entries, (*TOP, *SECTIONS), "")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        blocks = list(blocks_of(entries, errors))
        intensity_key, levels, level = levels_of(entries, errors)
        others = others_of(entries, errors) | hazard_of(entries, path.parent, errors)
        limits = {name: numbers_of(entries, name, errors) for name in ("limits", "limits_deg")}
        source, reading = source_of(entries, path.parent, errors)
        intensity = MEASURES.get(intensity_key, intensity_key)
        names = names_of(intensity_key, intensity)
        check_ranges(levels, level, intensity, others, errors, names)
        texts = {name: text_entry(entries, name, errors) for name in ("title", "by")}
        if errors.sentences:
            raise InvalidInput(f"{path.name}: {'; '.join(errors.sentences)}")
        records = records_of(path, source, reading)
    told = [*(str(each.message) for each in caught), *drift_warnings(records)]
    sentences = list(dict.fromkeys(map(with_keys, told)))
    inputs = [path, *([source] if isinstance(source, Path) else source)]
    if isinstance(others.get("hazard"), Path):
        inputs.append(others["hazard"])
    return Case(
        path, texts["title"] or f"Rocking assessment: {path.stem}", texts["by"], blocks, records, inputs,
        intensity, levels, level, limits["limits"], limits["limits_deg"], others, names, sentences,
    )  # fmt: skip


def with_keys(message: str) -> str:
    """Return a message of the reader with the keys of [records] instead of arguments.

    Examples
    --------
    >>> with_keys("give it, for example step=0.01"), with_keys("omit step"), with_keys("take one, for example component='first'")
    ('give it, for example step_s = 0.01 in [records]', 'omit step_s', 'take one, for example component = "first" in [records]')
    """
    keyed = ADVICE.sub(r'\1 = "\2" in [records]', message)
    return STEP.sub(lambda found: f"step_s = {found[1]} in [records]" if found[1] else "step_s", keyed)


def names_of(key: str, intensity: str) -> dict[str, str]:
    """Return the names of the arguments of `assess` in a file whose levels have a key."""
    return {
        "levels": f"{key} in [levels]",
        "level": "design in [levels]",
        f"intensity {intensity!r}": f"{key} in [levels]",
        "intensity": "the key of [levels]",
        "limits": "limits",
        "friction": "friction in [block]",
        "sa_period": "sa_period_s",
        "records": "source in [records]",
        "hazard levels": "levels in [hazard]",
        "hazard rates": "rates_per_year in [hazard]",
        "years": "years in [hazard]",
    }


def check_ranges(
    levels: np.ndarray,
    level: float | None,
    intensity: str,
    others: Mapping[str, Any],
    errors: Errors,
    names: Mapping[str, str],
) -> None:
    """Collect what is out of range, as far as it shows without the records: the level of the rows, the hazard, years and period."""
    with errors.collected(names):
        if level is not None and levels.size:
            with_level(levels, level)
    with errors.collected(names):
        if "years" in others:
            checked_years(others["years"])
    with errors.collected(names):
        if "sa_period" in others:
            checked_period(others["sa_period"])
    measure, _ = INTENSITIES.get(intensity, (None, None))
    with errors.collected(names):
        if "hazard" in others and measure is not None:
            hazard_curve(others["hazard"], measure.unit)


def entries_of(path: Path) -> dict[str, Any]:
    """Return the entries of a file; InvalidInput if it cannot be read."""
    import tomllib

    try:
        return tomllib.loads(text_of(path))
    except (OSError, ValueError, RecursionError) as error:
        reason: Any = getattr(error, "strerror", None) or error
        if isinstance(error, UnicodeDecodeError):
            reason = "the file is not text in UTF-8"
        elif isinstance(error, RecursionError):
            reason = "the file is nested too deeply"
        raise InvalidInput(f"FILE must name a TOML file; got {formatted_path(path)}: {reason}") from error


def blocks_of(entries: Mapping[str, Any], errors: Errors) -> Iterator[NamedBlock]:
    """Yield the blocks of the file."""
    found = entries.get("block")
    if not found:
        errors.sentences.append(
            "[block] is missing: give its height and width, such as height_mm = 2000 and width_mm = 600"
        )
        return
    tables = found if isinstance(found, list) else [found]
    for number, table in enumerate(tables, 1):
        where = " in [block]" if len(tables) == 1 else f" in block {number}"
        if not isinstance(table, Mapping):
            errors.sentences.append(refusal("block", "be a section [block], or sections [[block]]", found))
            return
        before = len(errors.sentences)
        block = block_of(table, errors, where)
        if block is not None and len(errors.sentences) == before:
            yield NamedBlock(text_entry(table, "name", errors, where), block, table.get("friction"))


def block_of(table: Mapping[str, Any], errors: Errors, where: str) -> Block | None:
    """Return the block of a section; None after an error."""
    keys = {base: [f"{base}_{unit}" for unit in UNITS] for base in LENGTHS}
    for key in [key for key in RESTRAINER if key in table][:1]:
        errors.sentences.append(f"{key}{where} must be omitted: {NO_RESTRAINER}")
    free = {key: value for key, value in table.items() if key not in RESTRAINER}
    errors.unknown(free, ("name", *(key for each in keys.values() for key in each), *PLAIN), where)
    values: dict[str, Any] = {}
    typed: dict[str, str] = {}
    shown: dict[str, str] = {}
    for base, choices in keys.items():
        given = [key for key in choices if key in table]
        if len(given) > 1:
            errors.sentences.append(f"give {given[0]} or {given[1]}{where}, not both")
        for key in given[:1]:
            with errors.collected():
                number = NUMBER.entry(f"{key}{where}", table[key])
                values[base] = number / UNITS[key.removeprefix(f"{base}_")]
                typed[base] = f"{key}{where}"
                shown[base] = f"{table[key]:.15g} {key.removeprefix(f'{base}_')}"
    for key in PLAIN:
        if key in table:
            with errors.collected():
                values[key] = NUMBER.entry(f"{key}{where}", table[key])
                typed[key] = f"{key}{where}"
    missing = [f"{base}_mm" for base in ("height", "width") if base not in values and base not in table]
    missing = [key for key in missing if not any(each in table for each in keys[key.removesuffix("_mm")])]
    if missing:
        errors.sentences.append(f"{' and '.join(missing)} missing{where}")
    if "height" not in values or "width" not in values:
        return None
    with errors.collected({"friction": f"friction{where}"}):
        if "friction" in values:
            checked_friction(values.pop("friction"))
    given = [key for key in IMPACT if key in values]
    if len(given) > 1:
        errors.sentences.append(f"give {given[0]} or {given[1]}{where}, not both")
        return None
    factor = values.pop("restitution_factor", None)
    with errors.collected({"restitution": f"wall{where}"}):
        if "wall" in values:
            values["wall"] = Wall(values.pop("wall"))
    with errors.collected({**typed, "factor": typed.get("restitution_factor", "")}):
        if factor is not None:
            values["restitution"] = Restitution.housner(factor)
        try:
            return Block(**values)
        except Refusal as error:
            if error.argument not in shown or not isinstance(error.value, int | float):
                raise
            as_typed = Text(shown[error.argument])
            raise Refusal(error.argument, error.allowed, as_typed, error.remedy) from error
    return None


def levels_of(entries: Mapping[str, Any], errors: Errors) -> tuple[str, np.ndarray, float | None]:
    """Return the key of the levels, the levels, and the level of the rows."""
    table = entries.get("levels")
    empty = "", np.array([]), None
    if not isinstance(table, Mapping):
        errors.sentences.append(
            f"[levels] is missing: give the levels of an intensity measure, such as {EXAMPLE}"
        )
        return empty
    given = [key for key in table if key != "design"]
    if len(given) > 1:
        for key in [key for key in given if key not in MEASURES and similar(key, ["design"])]:
            errors.sentences.append(f"unknown {key!r} in [levels] (did you mean 'design'?)")
            given.remove(key)
    if len(given) != 1:
        got = " and ".join(given) or "none"
        errors.sentences.append(
            f"give exactly one of {', '.join(MEASURES)}, or a column of the table, in [levels]; got {got}"
        )
        return empty
    (key,) = given
    with_unit = [
        each
        for each, name in MEASURES.items()
        if key in INTENSITIES and each.startswith(f"{key}_") and INTENSITIES[name][0].unit != "1"
    ]
    if with_unit and key not in MEASURES:
        errors.sentences.append(f"{key!r} in [levels] needs its unit: write {' or '.join(with_unit)}")
        return empty
    levels, level = np.array([]), None
    with errors.collected():
        found = VALUES.entry(f"{key} in [levels]", table[key])
        if not isinstance(found, Axis) and np.ndim(found) == 0:
            raise ValueError(
                refusal(f"{key} in [levels]", "hold two levels at least", found, f"example: {EXAMPLE}")
            )
        levels = np.asarray(values_of(found), dtype=float)
    if "design" in table:
        with errors.collected():
            level = float(NUMBER.entry("design in [levels]", table["design"]))
    return key, levels, level


def others_of(entries: Mapping[str, Any], errors: Errors) -> dict[str, Any]:
    """Return further arguments of `assess`."""
    others: dict[str, Any] = {}
    for key, name in (("sa_period_s", "sa_period"), ("seed", "seed")):
        if key in entries:
            with errors.collected():
                others[name] = NUMBER.entry(key, entries[key])
    for key in ("polarity", "model"):
        if key in entries:
            others[key] = text_entry(entries, key, errors)
    uncertain = entries.get("uncertain", {})
    if not isinstance(uncertain, Mapping):
        errors.sentences.append(refusal("uncertain", "be a section [uncertain]", uncertain))
        return others
    errors.unknown(uncertain, UNCERTAIN, " in [uncertain]")
    found = {}
    for key in UNCERTAIN:
        if key in uncertain:
            with errors.collected():
                found[key] = NUMBER.entry(f"{key} in [uncertain]", uncertain[key])
    return {**others, "uncertain": found} if found else others


def hazard_of(entries: Mapping[str, Any], folder: Path, errors: Errors) -> dict[str, Any]:
    """Return the arguments of the hazard: a file, or levels and annual rates."""
    table = entries.get("hazard")
    if table is None:
        return {}
    if isinstance(table, str):
        table = {"file": table}
    if not isinstance(table, Mapping):
        errors.sentences.append(refusal("hazard", "be the path of a table, or a section [hazard]", table))
        return {}
    errors.unknown(table, OF_HAZARD, " in [hazard]")
    found: dict[str, Any] = {}
    if "years" in table:
        with errors.collected():
            found["years"] = NUMBER.entry("years in [hazard]", table["years"])
    lists = [key for key in ("levels", "rates_per_year") if key in table]
    if ("file" in table) == bool(lists) or len(lists) == 1:
        errors.sentences.append("give file, or levels and rates_per_year, in [hazard]")
    elif lists:
        where = " in [hazard]"
        before = len(errors.sentences)
        levels, rates = (numbers_of(table, key, errors, where) for key in lists)
        if len(errors.sentences) == before:
            found["hazard"] = levels, rates
    else:
        name = text_entry(table, "file", errors, " in [hazard]")
        path = folder / name
        if path.is_file():
            found["hazard"] = path
        elif name:
            errors.sentences.append(
                f"file in [hazard] must name a table of levels and annual rates; got {formatted_path(path)}, which is not there"
            )
    return found


def numbers_of(entries: Mapping[str, Any], key: str, errors: Errors, where: str = "") -> list[float]:
    """Return a number, or the numbers of a list."""
    found = entries.get(key, [])
    result = []
    for each in found if isinstance(found, list) else [found]:
        with errors.collected():
            result.append(float(NUMBER.entry(f"{key}{where}", each)))
    return result


def text_entry(entries: Mapping[str, Any], key: str, errors: Errors, where: str = "") -> str:
    """Return a text on one line; an empty one if it is not given."""
    with errors.collected():
        return " ".join(instance(f"{key}{where}", entries.get(key, ""), str).split())
    return ""


def source_of(
    entries: Mapping[str, Any], folder: Path, errors: Errors
) -> tuple[Path | list[Path], dict[str, Any]]:
    """Return the records of the file as `read_record_set` takes them, relative to the folder of the file, and how they are read."""
    table = entries.get("records")
    if isinstance(table, str | list):
        table = {"source": table}
    if not isinstance(table, Mapping) or ("source" in table) == ("synthetic" in table):
        errors.sentences.append(
            '[records] must state its source: a folder, a table or files, such as source = "motions"'
        )
        return [], {}
    if "synthetic" in table:
        errors.unknown(table, ("synthetic",), " in [records]")
        with errors.collected():
            return [], {"synthetic": NUMBER.entry("synthetic in [records]", table["synthetic"])}
        return [], {}
    errors.unknown(table, ("source", "units", "step_s", "baseline", "component"), " in [records]")
    reading: dict[str, Any] = {}
    for key in ("units", "baseline", "component"):
        if key in table:
            reading[key] = text_entry(table, key, errors, " in [records]")
    if "step_s" in table:
        with errors.collected():
            reading["step"] = NUMBER.entry("step_s in [records]", table["step_s"])
    source = table["source"]
    texts = source if isinstance(source, list) else [source]
    if not texts or not all(isinstance(each, str) and each for each in texts):
        allowed = "be the path of a folder or a table, or a list of paths of record files"
        errors.sentences.append(refusal("source in [records]", allowed, source))
        return [], {}
    paths = [folder / each for each in texts]
    return paths if isinstance(source, list) else paths[0], reading


def records_of(path: Path, source: Path | list[Path], reading: dict[str, Any]) -> RecordSet:
    """Return the records; InvalidInput if they cannot be read."""
    names = {
        "count": "synthetic in [records]",
        "source": "source in [records]",
        "step": "step_s in [records]",
        "units": "units in [records]",
        "baseline": "baseline in [records]",
        "component": "component in [records]",
    }
    try:
        if "synthetic" in reading:
            return RecordSet(synthetic_ground_motions(reading["synthetic"], seed=1))
        return read_record_set(source, **reading)
    except (TypeError, ValueError, OSError) as error:
        told = error.of(names) if isinstance(error, Refusal) else error
        raise InvalidInput(f"{path.name}: records: {with_keys(str(told))}") from error
