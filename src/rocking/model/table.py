"""Units and tables of the dataset of a result: conversion to SI, rows with headings, and lists for JSON.

The quantities of `rocking.model.quantity` give units, headings and keys. A variable with attributes `flag_values` and
`flag_meanings` holds codes, which tables replace by words.
"""

from __future__ import annotations

import math
import re
from collections.abc import Hashable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rocking.model.quantity import QUANTITIES, SI, SYSTEM_QUANTITIES, Quantity

if TYPE_CHECKING:
    import xarray as xr

Table = dict[str, np.ndarray]
"""Columns of equal length by heading."""
Quantities = Mapping[str, Quantity]
"""Quantities of variables by name that differ from those of `rocking.model.quantity`."""

RESULT = "result"
"""Name of the table of what has no dimensions: one row."""
PURE = Quantity("", units="")
"""Quantity without a unit."""
UNIT = re.compile(
    r" (in units of [a-z]+( theta_cr)?|in normalised time|in radians per normalised time|in cycles per tau|per tau)"
)
"""Unit of a normalised quantity in the description of a variable."""
SENTENCES = {
    re.compile(
        r"[^;.]* normalised as in Yim & Lin \(1991\), Eqs\. \(1\)-\(4\)[.;]"
    ): "All quantities are in SI units.",
    re.compile(r"A peak is in units of the critical angle;"): "All quantities are in SI units;",
    re.compile(r"amplitude cos\(frequency time"): "acceleration_m_per_s2 cos(2 pi frequency_hz time",
}
"""Sentences on units in the comment of a dataset, and the same in SI."""
NUMBERED = ("record", "sample")
"""Dimensions whose coordinates are numbers from 0."""
PERIODIC = "periodic"
PERIODS = ("response_period", "orbit_period", "rest_period")
"""Variables in which 0 stands for a response that is not periodic."""
HITS = ("impacts_per_period", "brace_hits_per_period")
"""Variables in which -1 stands for infinitely many impacts, or for a response that is not periodic."""
COUNTS = (*PERIODS, *HITS, "transient")
"""Variables with integers that stand for an absent number."""


def quantity(name: Hashable, own: Quantities) -> Quantity:
    """Return the quantity of a variable or an attribute; one without a unit if there is none of this name."""
    return own.get(str(name)) or QUANTITIES.get(str(name), PURE)


# SI units.


def in_si(data: xr.Dataset, block: Any, own: Quantities) -> xr.Dataset:
    """Return a dataset whose normalised quantities are converted to SI; the key of an attribute then ends with its unit.

    Variables keep their names. Their attributes `units` and `long_name` change.
    """
    import xarray as xr

    def converted(name: Hashable, variable: Any) -> Any:
        si = quantity(name, own).si
        if si is None or variable.dtype.kind not in "fiu":
            return variable.variable
        kept = {
            key: value for key, value in variable.attrs.items() if key not in ("units", "long_name", "symbol")
        }
        described = {"long_name": UNIT.sub("", variable.attrs.get("long_name", "")), "units": si.units}
        return xr.Variable(variable.dims, si.of(block, variable.values), described | kept)

    attributes = dict(
        item for name, value in data.attrs.items() for item in _attribute(name, value, block, own)
    )
    return xr.Dataset(
        {name: converted(name, each) for name, each in data.data_vars.items()},
        {name: converted(name, each) for name, each in data.coords.items()},
        attributes | {"comment": _comment(data.attrs.get("comment", ""))},
    )


def _comment(normalised: str) -> str:
    """Return the comment of a dataset in SI."""
    text = normalised
    for sentence, other in SENTENCES.items():
        text = sentence.sub(other, text)
    return text or "All quantities are in SI units."


def _attribute(name: Hashable, value: Any, block: Any, own: Quantities) -> Iterator[tuple[Hashable, Any]]:
    """Yield an attribute; with a block, that of a quantity in SI has the unit in its name."""
    si = quantity(name, own).si
    if block is None or si is None or isinstance(value, str):
        yield name, value
    elif value is None:
        yield si.key, None
    else:
        yield si.key, np.asarray(si.of(block, np.asarray(value, float))).tolist()


# Tables.


class Group(NamedTuple):
    """Variables over the same dimensions: a table."""

    dimensions: tuple[Hashable, ...]
    variables: list[str]

    @property
    def name(self) -> str:
        """Name of the table."""
        return "_".join(map(str, self.dimensions)) or RESULT

    def short(self, text: str) -> str:
        """Return a heading or a key without the name of the table: of "switch", "level" instead of "switch_level"."""
        return text.removeprefix(f"{self.name}_")


def tables_of(data: xr.Dataset, own: Quantities, block: Any) -> dict[str, Table]:
    """Return the variables of a dataset as tables, one for each set of dimensions; the first one is that of the first variable.

    Values are in SI units with a block. A dataset without variables gives one row, that of its attributes.
    """
    groups = groups_of(data)
    if not groups:
        row = {name: value for name, value in data.attrs.items() if not isinstance(value, list)}
        columns = {str(name): np.array([value]) for name, value in row.items()}
        return {RESULT: dict(_headed(name, values, data, own, block) for name, values in columns.items())}
    return {
        each.name: {
            each.short(heading): values
            for heading, values in (
                _headed(name, column, data, own, block) for name, column in rows_of(data, each).items()
            )
        }
        for each in groups
    }


def groups_of(data: xr.Dataset) -> list[Group]:
    """Return the tables of a dataset; coordinates that stand in no other table make one, too."""
    groups: dict[tuple[Hashable, ...], list[str]] = {}
    for name, each in data.data_vars.items():
        groups.setdefault(each.dims, []).append(str(name))
    for name, each in data.coords.items():
        if name not in data.dims and each.dims:
            groups.setdefault(each.dims, [])
    return [Group(*each) for each in groups.items()]


def rows_of(data: xr.Dataset, group: Group) -> Table:
    """Return the columns of a table, normalised: coordinates, fixed quantities, then the variables.

    A row of a table over a quantity of a system also states the quantities of the system that do not vary, and their random
    samples.
    """
    dimensions, _ = group
    sizes = [data.sizes[name] for name in dimensions]
    along = [name for name in dimensions if name in data.coords]
    beside = [
        name
        for name, each in data.coords.items()
        if name not in data.dims and set(each.dims) <= set(dimensions)
    ]

    def column(name: Hashable) -> np.ndarray:
        each = data[name]
        shape = [size if where in each.dims else 1 for where, size in zip(dimensions, sizes, strict=True)]
        values = each.transpose(*(where for where in dimensions if where in each.dims)).values
        values = values.astype(int) if name in NUMBERED else words(values, each.attrs)
        return np.broadcast_to(values.reshape(shape), sizes).ravel()

    table = {str(name): column(name) for name in (*along, *beside)}
    if not dimensions or table.keys() & SYSTEM_QUANTITIES.keys():
        fixed = dict(_fixed(data.attrs))
        table |= {name: np.full(math.prod(sizes), fixed[name]) for name in fixed if name not in table}
    table |= {name: column(name) for name in group.variables}
    return table | {name: _counts(name, table) for name in COUNTS if name in table}


def _fixed(attributes: Mapping[Any, Any]) -> Iterator[tuple[str, Any]]:
    """Yield the quantities of a system, and of its random samples, that attributes give."""
    for name in SYSTEM_QUANTITIES:
        if name in attributes:
            yield name, attributes[name]
    for name in SYSTEM_QUANTITIES:
        for end, value in zip(("low", "high"), attributes.get(f"{name}_range", ()), strict=False):
            yield f"{name}_{end}", value
    for name in ("samples", "seed"):
        if name in attributes:
            yield name, attributes[name]


def words(values: np.ndarray, attributes: Mapping[str, Any]) -> np.ndarray:
    """Return codes as the words that the attributes of their variable give, and any other values as they are."""
    if "flag_values" not in attributes:
        return values
    meanings = flags(attributes)
    return np.array([meanings.get(code, "") for code in range(256)])[values.astype(np.uint8)]


def flags(attributes: Mapping[str, Any]) -> dict[int, str]:
    """Return the meanings of the values of a variable from its attributes."""
    codes = np.asarray(attributes["flag_values"]).tolist()
    return dict(zip(codes, attributes["flag_meanings"].split(), strict=True))


def _counts(name: str, table: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return a column of counts as Python numbers: integers, NaN if absent, and infinity."""
    values = table[name]
    column = values.astype(object)
    column[values < (1 if name in PERIODS else 0)] = math.nan
    if name in HITS:
        column[(values == -1) & (table.get("kind", PERIODIC) == PERIODIC)] = math.inf
    return column


def _headed(
    name: str, values: np.ndarray, data: xr.Dataset, own: Quantities, block: Any
) -> tuple[str, np.ndarray]:
    """Return the heading of a column with its unit, that of the quantity or else of the variable, and the values in this unit."""
    si, converted = _converted(name, values, own, block)
    if si is not None:
        return si.heading, converted
    unit = quantity(name, own).unit or (data[name].attrs.get("units", "1") if name in data else "1")
    return f"{name} [{unit}]" if unit not in ("", "1") else name, values


def _converted(name: str, values: np.ndarray, own: Quantities, block: Any) -> tuple[SI | None, np.ndarray]:
    """Return the SI counterpart of a column of numbers and the values in SI; None and the given values if there is none."""
    si = quantity(name, own).si
    if block is None or si is None or values.dtype.kind not in "fiu":
        return None, values
    return si, np.asarray(si.of(block, values))


# JSON.


def dictionary(data: xr.Dataset, own: Quantities, left_out: Iterable[str], block: Any) -> dict[str, Any]:
    """Return the attributes of a dataset, and its tables as lists of rows, as values that JSON has; in SI units with a block."""
    known = ((name, value) for name, value in data.attrs.items() if name != "Conventions")
    entries: dict[Any, Any] = dict(
        item for name, value in known for item in _attribute(name, value, block, own)
    )
    for each in groups_of(data):
        if each.name not in left_out:
            rows = _keyed_rows(data, each, own, block)
            entries |= rows[0] if each.name == RESULT else {each.name: rows}
    return {str(name): finite(value) for name, value in entries.items()}


def _keyed_rows(data: xr.Dataset, group: Group, own: Quantities, block: Any) -> list[dict[str, Any]]:
    """Return the rows of a table; in SI the key of a quantity ends with the unit."""
    keyed = {}
    for name, values in rows_of(data, group).items():
        si, converted = _converted(name, values, own, block)
        keyed[group.short(si.key if si else name)] = converted.tolist()
    return [dict(zip(keyed, row, strict=True)) for row in zip(*keyed.values(), strict=True)]


def finite(value: Any) -> Any:
    """Return a value with None in place of infinities and NaN, which JSON does not have."""
    if isinstance(value, dict):
        return {name: finite(part) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return [finite(part) for part in value]
    if isinstance(value, np.generic | np.ndarray):
        return finite(value.tolist())
    return None if isinstance(value, float) and not math.isfinite(value) else value
