"""How datasets of this room name their parameters and the package that made them."""

from __future__ import annotations

from rocking.model import VERSION

LONG_NAMES = {
    "amplitude": "amplitude of the base's acceleration, A",
    "period": "period of the base, T",
    "frequency": "frequency of the base, Omega",
    "phase": "phase of the base at the start, phi",
    "restitution": "restitution at an impact, e",
    "brace_angle": "angle of the braces, Theta_b",
    "brace_restitution": "restitution at a brace, r",
}


def named(text: str) -> dict[str, str]:
    """The attributes of a variable, normalised as all of them are."""
    return {"long_name": text, "units": "1"}


def described(what: str) -> dict[str, object]:
    """The attributes of every dataset."""
    return {
        "Conventions": "CF-1.11",
        "title": f"{what} of a free-standing block on a shaking base",
        "source": f"rocking {VERSION}",
        "comment": "Everything is normalised as in Yim and Lin (1991), eqs. 1-4.",
    }
