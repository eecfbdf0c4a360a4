"""Survey as an xarray dataset with its parameters, flags, package version and method."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rocking.model.package import VERSION
from rocking.survey.measurement import Arrays, Measurement
from rocking.survey.spec import SurveySpec

if TYPE_CHECKING:
    import xarray as xr


def dataset(asked: SurveySpec, measure: Measurement, arrays: Arrays) -> xr.Dataset:
    """Return the dataset of arrays over all axes, with coordinates and attributes."""
    import xarray as xr

    names = tuple(asked.axes)
    variables = {each.name: (names, arrays[each.name], each.attributes) for each in measure.variables}
    coordinates = {name: (name, values, asked.coordinate(name)) for name, values in asked.axes.items()}
    return xr.Dataset(variables, coordinates, attributes(asked, measure))


def attributes(asked: SurveySpec, measure: Measurement) -> dict[str, Any]:
    """Return the attributes of a survey: the quantities that do not vary, the options and the package version."""
    return {
        "Conventions": "CF-1.11",
        "title": measure.title,
        "source": f"rocking {VERSION}",
        "method": measure.method,
        "comment": asked.comment,
        **asked.described(),
        **measure.options,
    }
