"""What all results share: their data as a dataset, tables, JSON and figures; attributes of datasets."""

from __future__ import annotations

import html as markup
import re
from base64 import b64encode
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from importlib import import_module
from inspect import signature
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from rocking.model.block import Block, block_attributes
from rocking.model.block_formulas import with_unit
from rocking.model.package import VERSION
from rocking.model.quantity import Quantity
from rocking.model.tables_and_json import Table, dictionary, in_si, tables_of
from rocking.model.validation import Refusal, instance, one_of

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

UNITS = ("si", "normalised")
BLOCK_FOR_SI = "give block=rk.Block(height=…, width=…), or make the system by block.system(…)"


def along(dimension: str | tuple[str, ...], columns: Mapping[str, tuple[Any, ...]]) -> dict[str, Any]:
    """Return variables of a dataset from their values, descriptions and units, or attributes in place of both.

    The unit is "1", for a normalised variable, if it is not given. Words and flags have none.
    """
    variables = {}
    for name, (values, text, *unit) in columns.items():
        array = np.asarray(values)
        units = {} if array.dtype.kind in "bSU" else {"units": unit[0] if unit else "1"}
        attributes = text if isinstance(text, dict) else {"long_name": text} | units
        variables[name] = dimension, array, attributes
    return variables


def described(what: str) -> dict[str, object]:
    """Return the attributes of a dataset; ``what`` is the result, as a noun phrase."""
    return {
        "Conventions": "CF-1.11",
        "title": f"{what} of a free-standing block on a shaking base",
        "source": f"rocking {VERSION}",
        "comment": "All quantities are normalised as in Yim & Lin (1991), Eqs. (1)-(4).",
    }


def in_units_of(own: Any, block: Block) -> Block:
    """Return a block that converts accelerations as the `own` block of a result does, if it has one."""
    return block if own is None else with_unit(block, own.normalised_by)


def with_own_units(text: str, block: Block) -> str:
    """Return a description or a heading with the units of a block: its acceleration, and the unstable balance of a restrained one."""
    if block.normalised_by == "tangent":
        text = text.replace("g theta_cr", "g tan theta_cr")
    if not block.by_balance:
        return text
    text = re.sub(r"g (tan )?theta_cr", r"(1 + rho) g \1#", text)
    text = re.sub(r"\balpha\b", "alpha_u", text.replace("theta_cr", "theta_u"))
    return text.replace("#", "theta_cr")


def html(draw: Callable[[], Any], line: str) -> str:
    """Return a figure above a line of text, for `_repr_html_`; `draw` makes the figure."""
    png: bytes = import_module("rocking.plot.figures").picture(draw)
    line = markup.escape(line)
    picture = b64encode(png).decode()
    return f'<figure><img alt="{line}" src="data:image/png;base64,{picture}"><figcaption>{line}</figcaption></figure>'


class Result:
    """Base class of results: data with units as a dataset, tables, JSON, and a figure, which a notebook shows above the text.

    A result of a system that `Block.system` made is in SI units, unless ``units="normalised"`` is given. Any other is normalised;
    with a block it is in SI units.

    Attributes
    ----------
    block : Block
        Block that the system was made of; None if there is none.
    """

    __slots__ = ()

    PLOT: ClassVar[str] = ""
    """Name of the function of `rocking.plot` that draws results of the class; "" if there is none."""
    LONG: ClassVar[tuple[str, ...]] = ()
    """Tables that are too long for JSON."""
    QUANTITIES: ClassVar[Mapping[str, Quantity]] = {}
    """Quantities of variables whose names mean something else in other results."""

    @property
    def block(self) -> Any:  # noqa: D102
        # The class says what it is. Pages would take a docstring here for that of the fields `block` of other results.
        return getattr(getattr(self, "system", None), "block", None)

    def _data(self) -> xr.Dataset:
        """Return the data of the result, normalised. Attributes may be True, False or None."""
        return self.dataset  # type: ignore[attr-defined]

    def _data_for(self, block: Any) -> xr.Dataset:
        """Return the data, with what they hold only for SI units of a block."""
        return self._data()

    def _summary(self) -> xr.Dataset:
        """Return the part of the data that JSON holds."""
        return self._data()

    def _block(self, units: str | None, block: Any) -> Any:
        """Return the block of results in SI units, None for normalised ones; errors as in `to_xarray`."""
        own = self.block
        block = own if block is None else in_units_of(own, instance("block", block, Block))
        if units is not None and one_of("units", units, UNITS) == "si" and block is None:
            raise Refusal("units", "be 'normalised' for a system without a block", units, BLOCK_FOR_SI)
        return None if units == "normalised" else block

    def _with_sizes(self, data: xr.Dataset, block: Any) -> xr.Dataset:
        """Return data with the sizes of the block as attributes, also if the units are normalised."""
        known = self.block if block is None else in_units_of(self.block, block)
        return data if known is None else data.assign_attrs(block_attributes(known))

    def _dataset(self, data: xr.Dataset, block: Any, chosen: Any) -> xr.Dataset:
        """Return data in SI units of the chosen block, with attributes that netCDF has."""
        data = self._with_sizes(data, block)
        data = data.copy(deep=False) if chosen is None else in_si(data, chosen, self.QUANTITIES)
        data.attrs = dict(_plain(data.attrs))
        if chosen is None and self.block is not None and self.block.by_balance:
            data.attrs |= {"comment": with_own_units(data.attrs.get("comment", ""), self.block)}
        if chosen is None and self.block is not None:
            for each in data.variables.values():
                if "long_name" in each.attrs:
                    each.attrs = each.attrs | {
                        "long_name": with_own_units(each.attrs["long_name"], self.block)
                    }
        return data

    def to_xarray(self, *, units: str | None = None, block: Any = None) -> xr.Dataset:
        """Return the result as a dataset, with units.

        Parameters
        ----------
        units : {"si", "normalised"}, optional
            Units of the values. Default: SI if the block is known, else normalised.
        block : Block, optional
            Block of a system that was made without one. Default: that of the system.

        Returns
        -------
        xarray.Dataset
            Variables with the attributes `long_name` and `units`. The quantities that do not vary are attributes; in SI their
            names end with the unit.

        Raises
        ------
        TypeError
            If `block` is not a Block, or `units` is not a string.
        ValueError
            If `units` is neither of the two, or is "si" without a block.

        Examples
        --------
        >>> import rocking as rk
        >>> system = rk.Block(height=2.0, width=0.5).system(acceleration=4.0, frequency_hz=1.2)
        >>> motion = rk.simulate(system, cycles=5)
        >>> motion.to_xarray()["angle"].attrs["units"], motion.to_xarray(units="normalised")["angle"].attrs["units"]
        ('rad', '1')
        """
        chosen = self._block(units, block)
        return self._dataset(self._data_for(chosen), block, chosen)

    def to_dict(self, *, units: str | None = None, block: Any = None) -> dict[str, Any]:
        """Return the result as values that JSON has: its attributes, then its tables as lists of rows.

        Parameters
        ----------
        units, block
            As in `to_xarray`.

        Returns
        -------
        dict
            Numbers are finite or None. In SI the keys end with the unit, such as `peak_rad`. Tables that may be very long, such as
            the samples of a motion, are left out; `tables` has them.

        Raises
        ------
        TypeError, ValueError
            As in `to_xarray`.

        Examples
        --------
        >>> import rocking as rk
        >>> result = rk.classify(rk.Block(2.0, 0.5).system(acceleration=2.0, frequency_hz=1.2)).to_dict()
        >>> result["kind"], result["peak_rad"], result["acceleration_m_per_s2"]
        ('rest', 0.0, 2.0)
        """
        chosen = self._block(units, block)
        return dictionary(self._with_sizes(self._summary(), block), self.QUANTITIES, self.LONG, chosen)

    def tables(self, *, units: str | None = None, block: Any = None) -> dict[str, Table]:
        """Return the result as tables, one for each set of dimensions of its dataset.

        Parameters
        ----------
        units, block
            As in `to_xarray`.

        Returns
        -------
        dict of str to dict of str to ndarray
            Columns by heading, in tables by the names of their dimensions. Headings contain the units. The first table is the
            principal one.

        Raises
        ------
        TypeError, ValueError
            As in `to_xarray`.

        Examples
        --------
        >>> import rocking as rk
        >>> system = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.925)
        >>> result = rk.safe_basin(system, amplitude=[0.2, 0.5], samples=100)
        >>> list(result.tables()["amplitude"])[:4]
        ['amplitude [g theta_cr]', 'period [1/alpha]', 'restitution', 'phase [rad]']
        """
        chosen = self._block(units, block)
        tables = tables_of(self._data_for(chosen), self.QUANTITIES, chosen)
        own = self.block
        if chosen is not None or own is None:
            return tables
        return {
            name: {with_own_units(key, own): column for key, column in each.items()}
            for name, each in tables.items()
        }

    def to_dataframe(
        self, table: str | None = None, *, units: str | None = None, block: Any = None
    ) -> pd.DataFrame:
        """Return a table of the result as a pandas DataFrame.

        Parameters
        ----------
        table : str, optional
            Name of the table, as in `tables`. Default: the principal one.
        units, block
            As in `to_xarray`.

        Returns
        -------
        pandas.DataFrame
            Table with units in its headings.

        Raises
        ------
        TypeError, ValueError
            As in `to_xarray`, or if there is no such table.

        Examples
        --------
        >>> import rocking as rk
        >>> system = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.925)
        >>> result = rk.safe_basin(system, amplitude=[0.2, 0.5], samples=100)
        >>> result.to_dataframe()["safe"].tolist()
        [0.55, 0.55]
        """
        import pandas as pd

        tables = self.tables(units=units, block=block)
        name = next(iter(tables)) if table is None else one_of("table", table, tuple(tables))
        return pd.DataFrame(tables[name])

    def plot(self, *arguments: Any, units: str | None = None, **options: Any) -> Any:
        """Draw the result by its function of `rocking.plot`; return what this returns.

        Parameters
        ----------
        *arguments, **options
            Further arguments of the function, such as `ax`, and `block` for a system that was made without one.
        units : {"si", "normalised"}, optional
            Units of the figure. Default: SI if the block is known, else normalised.

        Raises
        ------
        TypeError, ValueError
            As in `to_xarray`, or as the function does.

        Examples
        --------
        >>> import rocking as rk
        >>> motion = rk.simulate(rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925), cycles=3)
        >>> len(motion.plot().axes)
        2
        """
        draw = getattr(import_module("rocking.plot"), self.PLOT)
        if units is not None:
            block = self._block(units, options.get("block"))
            if "block" in signature(draw).parameters:
                options["block"] = block
        return draw(self, *arguments, **options)

    def _figure(self) -> Any:
        """Return the figure, or its axes, that a notebook shows."""
        return self.plot()

    def _repr_html_(self) -> str | None:
        with suppress(Refusal):  # the function draws other results of the class
            return html(self._figure, str(self)) if self.PLOT else None
        return None


def _plain(attributes: Mapping[Any, Any]) -> Iterable[tuple[Any, Any]]:
    """Yield attributes that netCDF has: no None, and 1 and 0 for True and False."""
    for name, value in attributes.items():
        if value is not None:
            yield name, int(value) if isinstance(value, bool) else value
