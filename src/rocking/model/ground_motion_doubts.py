"""Sentences on ground motions that are probably not what is meant: vertical, in another unit, or with a drift."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from rocking.model.formatting import listed

if TYPE_CHECKING:
    from rocking.model.ground_motion import GroundMotion

MAX_END, MAX_MEAN, MAX_RATIO = 0.2, 0.5, 30.0
"""Largest |velocity| at the end over PGV, |mean velocity| over its root mean square, and PGA PGD/PGV² without drift."""
USUAL_PGA = (0.01, 50.0)
"""Peaks in m/s² without a warning: nobody feels a smaller one, and about 40 m/s² is the largest that was recorded."""
VERTICAL = {"u", "up", "v", "ver", "vert", "vertical", "z", "ud", "updown", "down", "dn", "dwn"}
"""Letters of components that are vertical; so is each code of three letters that ends with z."""


def is_vertical(component: str) -> bool:
    """Return whether the name of a component is vertical.

    Examples
    --------
    >>> is_vertical("U-D"), is_vertical("HNZ"), is_vertical("360°")
    (True, True, False)
    """
    letters = re.sub("[^a-z]", "", component.partition(",")[0].lower())
    return letters in VERTICAL or (len(letters) == 3 and letters.endswith("z"))


def drift_doubt(motion: GroundMotion) -> str:
    """Return the sentence of `GroundMotion.drift_doubt`."""
    pgv, velocity = motion.pgv, motion.velocity
    if pgv == 0.0:
        return ""
    end = abs(float(velocity[-1])) / pgv
    mean = abs(float(velocity.mean())) / math.sqrt(float((velocity**2).mean()))
    ratio = motion.pga * motion.pgd / pgv**2
    reasons = {
        f"the velocity at the end is {100 * end:.0f} % of the PGV": end / MAX_END,
        f"the mean velocity is {100 * mean:.0f} % of its root mean square": mean / MAX_MEAN,
        f"PGA PGD/PGV² is {ratio:.3g}, where 6 is usual": ratio / MAX_RATIO,
    }
    worst = max(reasons, key=reasons.__getitem__)
    if reasons[worst] <= 1.0:
        return ""
    treated = "no" if motion.baseline == "none" else f"a {motion.baseline}"
    better = {"linear": "quadratic", "quadratic": None}.get(motion.baseline, "linear")
    remedy = (
        f"use a corrected record, or for example baseline={better!r}" if better else "use a corrected record"
    )
    return (
        f"the PGV and PGD are those of a drift, because {treated} baseline is removed and {worst}: {remedy}"
    )


def pga_doubt(pga: float) -> str:
    """Return a sentence on a peak in m/s² that is probably in another unit; empty for any other."""
    low, high = USUAL_PGA
    if pga == 0.0 or low <= pga <= high:
        return ""
    return f"a PGA of {pga:.4g} m/s² is unusual: check the unit of the samples"


def vertical_sentence(names: Sequence[str]) -> str:
    """Return the warning that vertical components are used as horizontal ones."""
    which = "the component {} is" if len(names) == 1 else "the components {} are"
    return f"{which.format(listed(names))} vertical, and the base moves horizontally: choose a horizontal component"
