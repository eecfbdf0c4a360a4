"""Names of spectral lines as combinations of forcing and rotation frequency: Yim & Lin (1991), Eq. (7).

Frequencies here are in units of the forcing frequency, which is 1.
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
    """Combination p·f + q·f_r, with p a multiple of 1/n and q an integer, and the distance of a line from it."""

    forcing: Fraction
    rotation: int
    offset: float

    @property
    def name(self) -> str:
        """Text such as "5f/3 − 2f_r"."""
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
    """Return the simplest combination within the resolution of a line; None if there is none or it is ambiguous.

    Multiples of 1/`parts` are combined with integer multiples q of the rotation frequency. The simplest combination has the
    smallest |q|. It is ambiguous if another one has at most 2|q| + 1. The largest |q| is 32, or fewer if the combinations
    would cover more than a tenth of all frequencies: more combinations would fit any line.
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
    """Return the n of f/n and the rotation frequency that name the most of the ten strongest lines.

    Parameters
    ----------
    lines : sequence of float
        Frequencies, the strongest first.
    parts : int or None
        Given n. None: the smallest n up to 16 that names the most lines.
    rotation : float or None
        Given rotation frequency. None: the strongest line that is no multiple of f/n, if it names another line too.
    resolution : float
        Largest distance of a line from its combination.

    Returns
    -------
    parts : int
        n.
    rotation : float or None
        Rotation frequency; None if there is none.
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
    """Return the strongest line that is no multiple of 1/`parts`, or None."""
    for line in lines:
        if abs(line - round(line * parts) / parts) > resolution:
            return line
    return None
