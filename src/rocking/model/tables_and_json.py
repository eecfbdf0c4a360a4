"""Units and tables of the dataset of a result: conversion to SI, rows with headings, and lists for JSON.

The quantities of `rocking.model.quantity` give units, headings and keys. A variable with attributes `flag_values` and
`flag_meanings` holds codes, which tables replace by words.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Hashable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rocking.model.quantity import DESCRIBED, QUANTITIES, SI, SYSTEM_QUANTITIES, Quantity, with_unit

if TYPE_CHECKING:
    import xarray as xr

Table = dict[str, np.ndarray]
"""Columns of equal length by heading."""
Quantities = Mapping[str, Quantity]
"""Quantities of variables by name that differ from those of `rocking.model.quantity`."""

NO_QUANTITIES: Quantities = {}
FIXED = (
    *(
        "amplitude",
        "period",
        "frequency",
        "restitution",
        "critical_angle",
        "brace_angle",
        "brace_restitution",
    ),
    *("phase", "angle", "velocity"),
    *("angle_ratio", "frequency_ratio", "left_restitution", "wall_restitution"),
    *("stiffness_ratio", "prestress_ratio"),
)
"""Quantities of a system in the order of the columns of a table."""
RESULT = "result"
"""Name of the table of what has no dimensions: one row."""
PURE = Quantity("", units="")
"""Quantity without a unit."""
UNIT = re.compile(
    " (in units of (g |alpha )?theta_cr|in normalised time|in radians per normalised time|in cycles per tau|per tau)"
)
"""Unit of a normalised quantity in the description of a variable."""
ULPS = 4
"""Rounding of an axis, in units of the last place."""
PER = re.compile(r" ([a-z]+)-(\d)")
"""Power of a unit below 1 in the notation of the CF conventions, after another unit."""
SENTENCES = {
    re.compile(
        r"[^;.]* normalised as in Yim & Lin \(1991\), Eqs\. \(1\)-\(4\)([.;])"
    ): r"All quantities are in SI units\1",
    re.compile(r" Base accelerations are in units of g tan theta_cr\."): "",
    re.compile(r"A peak is in units of the critical angle;"): "All quantities are in SI units;",
    re.compile(r"amplitude cos\(frequency time"): "acceleration_m_per_s2 cos(2 pi frequency_hz time",
}
"""Sentences on units in the comment of a dataset, and the same in SI."""
IN_SI_UNITS = {
    "size": "size_m",
    "size_range": "size_range_m",
    "slenderness": "slenderness_rad",
    "slenderness_range": "slenderness_range_rad",
    "pga": "pga_m_per_s2",
}
"""Keys of quantities that are in SI units, whether or not there is a block."""
NUMBERED = ("record", "sample")
"""Dimensions whose coordinates are numbers from 0."""
PERIODIC = "periodic"
PERIODS = ("response_period", "orbit_period")
"""Variables in which 0 stands for a response that is not periodic."""
HITS = ("impacts_per_period", "brace_hits_per_period")
"""Variables in which -1 stands for infinitely many impacts, or for a response that is not periodic."""
COUNTS = (*PERIODS, *HITS, "transient")
"""Variables with integers that stand for an absent number."""


def quantity(name: Hashable, own: Quantities, description: str = "") -> Quantity:
    """Return the quantity of a variable or an attribute, by its name or by the unit in its description.

    One without a unit if there is none.
    """
    known = own.get(str(name)) or QUANTITIES.get(str(name))
    if known is None and (unit := UNIT.search(description)) is not None and unit[1] in DESCRIBED:
        known = with_unit(str(name), *DESCRIBED[unit[1]])
    return known or PURE


# SI units.


def si_of(known: Quantity, name: Hashable, block: Any) -> SI | None:
    """Return the SI counterpart of a quantity; none of the margin of a block with unequal sides, in units of the side at that time."""
    sides = block is not None and block.is_unsymmetric
    return None if name == "margin" and sides else known.si


def in_si(data: xr.Dataset, block: Any, own: Quantities) -> xr.Dataset:
    """Return a dataset whose normalised quantities are converted to SI; the key of an attribute then ends with its unit.

    Variables keep their names. Their attributes `units` and `long_name` change.
    """
    import xarray as xr

    def converted(name: Hashable, variable: Any) -> Any:
        si = si_of(quantity(name, own, variable.attrs.get("long_name", "")), name, block)
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
        attributes,
    )


def _comment(normalised: str) -> str:
    """Return the comment of a dataset in SI."""
    text = normalised
    for sentence, other in SENTENCES.items():
        text = sentence.sub(other, text)
    return text or "All quantities are in SI units."


def _attribute(name: Hashable, value: Any, block: Any, own: Quantities) -> Iterator[tuple[Hashable, Any]]:
    """Yield an attribute; with a block, that of a quantity in SI has the unit in its name."""
    si = si_of(quantity(name, own), name, block)
    if block is not None and name == "comment":
        yield name, _comment(value)
    elif block is None or si is None or isinstance(value, str):
        yield name, value
    elif value is None:
        yield si.key, None
    else:
        yield si.key, np.asarray(si.of(block, np.asarray(value, float))).tolist()


# Large datasets.


AT_ONCE = 1 << 20
"""Approximate number of points in memory at a time."""


def parts(data: xr.Dataset) -> Iterator[xr.Dataset]:
    """Yield the dataset in parts along its first axis, each in memory."""
    first = next(iter(data.data_vars.values())).dims[0]
    count = data.sizes[first]
    step = max(AT_ONCE * count // math.prod(data.sizes.values()), 1)
    for begin in range(0, count, step):
        yield data.isel({first: slice(begin, begin + step)}).load()


def counts(data: xr.Dataset, name: str) -> dict[str, int]:
    """Return the number of points with each flag of a variable, by the meaning of the flag."""
    meanings = flags(data[name].attrs)
    total = np.zeros(256, np.int64)
    for part in parts(data[[name]]):
        total += np.bincount(part[name].values.ravel(), minlength=256)
    return {meaning: int(total[value]) for value, meaning in meanings.items()}


# Tables.


class Group(NamedTuple):
    """Variables over the same dimensions: a table."""

    dimensions: tuple[Hashable, ...]
    variables: list[str]

    @property
    def name(self) -> str:
        """Name of the table."""
        return "_".join(map(str, self.dimensions)) or RESULT

    def short(self, name: str, text: str) -> str:
        """Return the heading or key of a variable without the name of the table: of "switch", "level" for "switch_level"."""
        prefix = f"{self.name}_"
        return text.removeprefix(prefix) if name.startswith(prefix) else text


def tables_of(data: xr.Dataset, own: Quantities, block: Any) -> dict[str, Table]:
    """Return the variables of a dataset as tables, one for each set of dimensions; the first one is that of the first variable.

    Values are in SI units with a block. A dataset without variables gives one row, that of its attributes.
    """
    groups = groups_of(data)
    if not groups:
        row = {str(name): np.array([each]) for name, each in data.attrs.items() if not isinstance(each, list)}
        return {RESULT: headed(row, block, own)}
    return {
        group.name: headed(rows_of(data, group, with_fixed=True), block, own, data, group) for group in groups
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


def rows_of(data: xr.Dataset, group: Group, *, with_fixed: bool) -> Table:
    """Return the columns of a table, normalised: coordinates, fixed quantities, then the variables.

    `with_fixed`: a row of a table over a quantity of a system also states the quantities of the system that do not vary, and
    their random samples.
    """
    dimensions, _ = group
    sizes = [data.sizes[name] for name in dimensions]
    coordinates = [
        name
        for dimension in dimensions
        for name in sorted(data.coords, key=dimension.__ne__)
        if data[name].dims[-1:] == (dimension,) and set(data[name].dims) <= set(dimensions)
    ]

    def column(name: Hashable) -> np.ndarray:
        each = data[name]
        shape = [size if where in each.dims else 1 for where, size in zip(dimensions, sizes, strict=True)]
        values = each.transpose(*(where for where in dimensions if where in each.dims)).values
        values = values.astype(int) if name in NUMBERED else words(values, each.attrs)
        return np.broadcast_to(values.reshape(shape), sizes).ravel()

    table = {str(name): column(name) for name in coordinates}
    if with_fixed and (not dimensions or table.keys() & SYSTEM_QUANTITIES.keys()):
        fixed = dict(_fixed(data.attrs))
        table |= {
            name: np.full(math.prod(sizes), value)
            for name, value in fixed.items()
            if not {name, name.removesuffix("_low"), name.removesuffix("_high")} & table.keys()
        }
    table |= {name: column(name) for name in group.variables}
    kinds = table.get("kind", table.get(f"{group.name}_kind", np.array(PERIODIC)))
    return table | {
        name: _counts(group.short(name, name), values, kinds)
        for name, values in table.items()
        if group.short(name, name) in COUNTS
    }


def _fixed(attributes: Mapping[Any, Any]) -> Iterator[tuple[str, Any]]:
    """Yield the quantities of a system, and of its random samples, that attributes give."""
    for name in (*FIXED, "samples", "seed"):
        if name in attributes:
            yield name, attributes[name]
        for end, value in zip(("low", "high"), attributes.get(f"{name}_range", ()), strict=False):
            yield f"{name}_{end}", value


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


def _counts(name: str, values: np.ndarray, kinds: np.ndarray) -> np.ndarray:
    """Return a column of counts as Python numbers: integers, NaN if absent, and infinity."""
    column = values.astype(object)
    column[values < (1 if name in PERIODS else 0)] = math.nan
    if name in HITS:
        column[(values == -1) & (kinds == PERIODIC)] = math.inf
    return column


def headed(
    table: Table,
    block: Any,
    own: Quantities = NO_QUANTITIES,
    data: xr.Dataset | None = None,
    group: Group = Group((), []),  # noqa: B008 (immutable)
) -> Table:
    """Return a table of normalised columns by name with units in its headings; with a block in SI units.

    Without a quantity of its name, the unit of a column is that of its variable in `data`.
    """
    columns = {}
    for name, values in table.items():
        attributes = data[name].attrs if data is not None and name in data else {}
        known = quantity(name, own, attributes.get("long_name", ""))
        si, converted = _converted(si_of(known, name, block), values, block)
        unit = known.unit or attributes.get("units", "1")
        bare = name.removesuffix(f"_{unit}").removesuffix(f"_{PER.sub(_written, unit)}")
        plain = f"{bare} [{unit}]" if unit not in ("", "1") else name
        columns[group.short(name, si.heading if si else plain)] = converted
    return columns


def as_typed(name: str, values: np.ndarray) -> np.ndarray:
    """Return a column of a file; levels that differ from 12 digits by the rounding of their axis alone have these digits.

    Examples
    --------
    >>> as_typed("level [g]", np.array([0.7999999999999999, 1 / 3])).tolist(), as_typed("peak", np.array([0.1 + 0.2])).tolist()
    ([0.8, 0.3333333333333333], [0.30000000000000004])
    """
    if not name.startswith("level") or values.dtype.kind != "f":
        return values
    short = np.array([float(f"{value:.12g}") for value in values.tolist()])
    with np.errstate(invalid="ignore"):
        return np.where(np.abs(short - values) <= ULPS * np.spacing(np.abs(values)), short, values)


def _written(power: re.Match[str]) -> str:
    """Return a power of a unit below 1 as names state it: "_per_s2" of " s-2"."""
    return f"_per_{power[1]}{power[2].removeprefix('1')}"


def _converted(si: SI | None, values: np.ndarray, block: Any) -> tuple[SI | None, np.ndarray]:
    """Return the SI counterpart of a column of numbers and the values in SI; None and the given values if there is none."""
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
    return {IN_SI_UNITS.get(str(name), str(name)): finite(value) for name, value in entries.items()}


def _keyed_rows(data: xr.Dataset, group: Group, own: Quantities, block: Any) -> list[dict[str, Any]]:
    """Return the rows of a table; in SI the key of a quantity ends with the unit."""
    keyed = {}
    for name, values in rows_of(data, group, with_fixed=False).items():
        description = data[name].attrs.get("long_name", "") if name in data else ""
        si, converted = _converted(si_of(quantity(name, own, description), name, block), values, block)
        keyed[group.short(name, si.key if si else IN_SI_UNITS.get(name, name))] = converted.tolist()
    return [dict(zip(keyed, row, strict=True)) for row in zip(*keyed.values(), strict=True)]


def json_text(entries: Mapping[str, Any]) -> str:
    """Return entries as the text of a JSON object."""
    return json.dumps(finite(dict(entries)), indent=2, ensure_ascii=False, allow_nan=False)


def finite(value: Any) -> Any:
    """Return a value with None in place of infinities and NaN, which JSON does not have."""
    if isinstance(value, dict):
        return {name: finite(part) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return [finite(part) for part in value]
    if isinstance(value, np.generic | np.ndarray):
        return finite(value.tolist())
    return None if isinstance(value, float) and not math.isfinite(value) else value
