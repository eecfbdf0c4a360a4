"""Finished map of outcomes as a netCDF file in memory."""

from __future__ import annotations

import io

import numpy as np

from rocking.explorer.ground_motion.size_map import SizePicture, SizePlane
from rocking.explorer.ground_motion.view import GroundView, address
from rocking.model.package import VERSION
from rocking.model.verdict import Outcome


def netcdf(plane: SizePlane, picture: SizePicture, name: str, shown: GroundView) -> bytes:
    """Return the netCDF file of a map, with the names and units of `rocking_spectrum`, and height and width of each block."""
    import xarray as xr

    sizes, angles = plane.sizes_of(picture.side), np.radians(plane.angles_of(picture.side))
    over = ("slenderness", "size")
    effects = {
        "flag_values": np.arange(3, dtype=np.uint8),
        "flag_meanings": "undecided certified not-assessed",
    }
    flags = {"flag_values": np.arange(len(Outcome), dtype=np.uint8), "flag_meanings": " ".join(Outcome)}
    attributes = {
        "outcome": {"long_name": "end of the motion", **flags},
        "certified": {"long_name": "whether no rounding error can have changed the outcome", **effects},
        "peak": {
            "long_name": "largest absolute angle in units of theta_cr",
            "units": "1",
            "comment": "infinite if the block overturns",
        },
        "margin": {"long_name": "K+ of least size over all lift-offs and impacts", "units": "1"},
    }
    data = xr.Dataset(
        {each: (over, values, attributes[each]) for each, values in picture.fields.items()},
        {
            "size": ("size", sizes, {"long_name": "half diagonal R", "units": "m"}),
            "slenderness": ("slenderness", angles, {"long_name": "critical angle", "units": "rad"}),
            "height": (over, 2 * np.outer(np.cos(angles), sizes), {"units": "m"}),
            "width": (over, 2 * np.outer(np.sin(angles), sizes), {"units": "m"}),
        },
        {
            "Conventions": "CF-1.11",
            "title": "Ends of free-standing blocks under a base motion",
            "source": f"rocking {VERSION}",
            "base_motion": name,
            "level": shown.scale,
            "model": shown.model,
            "view": address(shown),
        },
    )
    target = io.BytesIO()
    data.to_netcdf(target, engine="h5netcdf")
    return target.getvalue()
