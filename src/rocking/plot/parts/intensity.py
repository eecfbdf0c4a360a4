"""Label of the axis of an intensity measure, and names of limits of the angle."""

from __future__ import annotations

import math
from typing import Any

from rocking.model.block import Block

SYMBOLS = {
    "I_A": "$I_A$",
    "PGA/(g tan θcr)": r"PGA$/(g\,\tan\theta_\mathrm{cr})$",
    "α PGV/(g tan θcr)": r"$\alpha\,$PGV$/(g\,\tan\theta_\mathrm{cr})$",
}


def level_label(scale: Any) -> str:
    """Return the label of the axis of the levels of a dataset: description, symbol and unit."""
    symbol, unit = scale.attrs["symbol"], scale.attrs.get("units", "1")
    name = scale.attrs["long_name"]
    if "/" in symbol:
        name = ""
    elif symbol in name:
        symbol = ""
    return " ".join(
        filter(None, (name, SYMBOLS.get(symbol, symbol), "" if unit in ("1", "") else f"({unit})"))
    )


def limit_label(limit: float, block: Block) -> str:
    """Return the event of exceeding a limit of |Θ|, in degrees."""
    if math.isinf(limit):
        return "overturning"
    return rf"$|\theta| > {block.degrees(limit):.3g}°$ (${limit:g}\,\theta_\mathrm{{cr}}$)"
