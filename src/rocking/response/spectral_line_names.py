"""Which whole-number combination of forcing and rotation frequency a line is; eq. (7) of Yim & Lin (1991).

Frequencies are counted in those of the forcing here: the forcing itself is 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from attrs import frozen

MAX_ROTATIONS = 32
CHANCE = 0.1
MAX_SUBHARMONIC = 16
TELLING_LINES = 10


@frozen
class Combination:
    """p·f + q·f_r, with p a multiple of 1/n and q whole, and how far a line lies from it."""

    forcing: Fraction
    rotation: int
    offset: float

    @property
    def name(self) -> str:
        """Such as "5f/3 − 2f_r"."""
        terms = [(self.forcing, "f"), (Fraction(self.rotation), "f_r")]
        text = ""
        for factor, symbol in terms:
            if factor:
                sign = "−" if factor < 0 else "+"
                text += f" {sign} " if text else sign.replace("+", "")
                text += _multiple(abs(factor), symbol)
        return text or "0"


def _multiple(factor: Fraction, symbol: str) -> str:
    over = f"/{factor.denominator}" if factor.denominator > 1 else ""
    return f"{factor.numerator if factor.numerator > 1 else ''}{symbol}{over}"


def combination(line: float, parts: int, rotation: float | None, resolution: float) -> Combination | None:
    """The simplest combination within the resolution of a line; None without one, or where it is ambiguous.

    Multiples of 1/`parts` are combined with whole numbers q of rotations. The simplest has the fewest; it is ambiguous
    where another has no more than 2|q| + 1. Only so many rotations are tried, 32 at most, that the combinations cover a
    tenth of all frequencies: more would find one near any line.
    """
    most = min(MAX_ROTATIONS, int((CHANCE / (2 * resolution * parts) - 1) / 2)) if rotation else 0
    found = None
    for turns in sorted(range(-most, most + 1), key=abs):
        if found is not None and abs(turns) > 2 * abs(found.rotation) + 1:
            break
        remainder = line - turns * (rotation or 0.0)
        nearest = Fraction(round(remainder * parts), parts)
        if abs(remainder - float(nearest)) > resolution:
            continue
        if found is not None:
            return None
        found = Combination(nearest, turns, remainder - float(nearest))
    return found


def parts_and_rotation(
    lines: Sequence[float], parts: int | None, rotation: float | None, resolution: float
) -> tuple[int, float | None]:
    """The n of the multiples f/n and the rotation frequency that name the most of the ten strongest lines.

    Parameters
    ----------
    lines : sequence of float
        Frequencies, the strongest first.
    parts, rotation : int, float or None
        What is known of the two. If not, the least n up to 16 is taken, and the strongest line that is no multiple
        of f/n; one that names no line but itself is none.
    resolution : float
        How near a line must be to what it is called.

    Returns
    -------
    int, float or None
    """
    telling = lines[:TELLING_LINES]
    best: tuple[int, int, float | None] = (-1, parts or 1, rotation)
    for n in [parts] if parts else range(1, MAX_SUBHARMONIC + 1):
        free = rotation or _free(telling, n, resolution)
        named = [combination(line, n, free, resolution) for line in telling]
        if not rotation and sum(one is not None and one.rotation != 0 for one in named) < 2:
            free, named = None, [combination(line, n, None, resolution) for line in telling]
        count = sum(one is not None for one in named)
        if count > best[0]:
            best = (count, n, free)
    return best[1], best[2]


def _free(lines: Sequence[float], parts: int, resolution: float) -> float | None:
    """The strongest line that is no multiple of 1/`parts`."""
    for line in lines:
        if abs(line - round(line * parts) / parts) > resolution:
            return line
    return None
