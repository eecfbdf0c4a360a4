"""Names of parameters, and attributes common to the datasets of this subpackage."""

from __future__ import annotations

from typing import Any

from rocking.model import VERSION

LONG_NAMES = {
    "amplitude": "amplitude of the base acceleration, A",
    "period": "forcing period, T",
    "frequency": "angular frequency of the forcing, Omega",
    "phase": "initial forcing phase, phi",
    "restitution": "coefficient of restitution of an impact, e",
    "brace_angle": "brace angle, Theta_b",
    "brace_restitution": "coefficient of restitution of a brace impact, r",
    "critical_angle": "critical angle of the block, theta_cr",
}
IN_RADIANS = ("phase", "critical_angle")


def named(text: str) -> dict[str, str]:
    """Return the attributes of a normalised variable."""
    return {"long_name": text, "units": "1"}


def coordinate_of(along: str, name: str, values: Any) -> tuple[str, Any, dict[str, str]]:
    """Return the values of a parameter as a variable."""
    return along, values, {"long_name": LONG_NAMES[name], "units": "rad" if name in IN_RADIANS else "1"}


def described(what: str) -> dict[str, object]:
    """Return the attributes common to all datasets."""
    return {
        "Conventions": "CF-1.11",
        "title": f"{what} of a free-standing block on a shaking base",
        "source": f"rocking {VERSION}",
        "comment": "All quantities are normalised as in Yim & Lin (1991), Eqs. (1)-(4).",
    }
