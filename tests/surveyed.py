"""Systems and arguments of surveys from quantities by name."""

import numpy as np

import rocking as rk


def system_with(**quantities):
    """Return the system with these quantities; others have the value 1, the phase is 0, and there are no braces."""
    time = "frequency" if "frequency" in quantities else "period"
    forcing = rk.Harmonic(
        quantities.get("amplitude", 1.0),
        phase=quantities.get("phase", 0.0),
        **{time: quantities.get(time, 1.0)},
    )
    reach, rebound = (quantities.get(f"brace_{name}") for name in ("angle", "restitution"))
    braces = None if reach is None else rk.Braces(reach, 1.0 if rebound is None else rebound)
    return rk.System(forcing, quantities.get("restitution", 1.0), braces, quantities.get("critical_angle"))


def surveyed(**quantities):
    """Return the arguments of a map: arrays are axes, and numbers those of the system and of the initial state."""
    axes = {name: values for name, values in quantities.items() if np.ndim(values)}
    numbers = {name: value for name, value in quantities.items() if name not in axes}
    start = rk.State(numbers.pop("angle", 0.0), numbers.pop("velocity", 0.0))
    return {"system": system_with(**numbers), "start": start} | axes
