"""Parameters of a system as balls: real numbers with rigorous bounds of their errors (F. Johansson, Arb, 2017)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from functools import reduce
from typing import NamedTuple

from flint import arb

from rocking.model import System


class Refused(Exception):
    """A condition of a proof is not shown; the text names it."""


class TooLong(Refused):
    """A motion is followed too long; more digits do not help."""


class Balls(NamedTuple):
    """Parameters of a slender block under a harmonic base motion."""

    amplitude: arb
    frequency: arb
    response: arb  # beta = A/(1 + frequency^2)
    restitution: arb
    brace_angle: arb | None
    brace_restitution: arb


def balls_of(system: System, widths: Mapping[str, float]) -> Balls:
    """Return the parameters of a system: the doubles that were given, exactly, or with half-widths by name.

    A frequency follows from its period in balls.
    """
    forcing, braces = system.periodic, system.braces
    name, value = forcing.given

    def number(which: str, middle: float) -> arb:
        return arb(middle, widths.get(which, 0.0))

    amplitude, frequency = number("amplitude", forcing.amplitude), number(name, value)
    if name == "period":
        frequency = 2 * arb.pi() / frequency
    return Balls(
        amplitude,
        frequency,
        amplitude / (1 + frequency * frequency),
        number("restitution", system.restitution),
        None if braces is None else number("brace_angle", braces.angle),
        arb(1) if braces is None else number("brace_restitution", braces.restitution),
    )


def hull(low: arb, high: arb) -> arb:
    """Return a ball that contains all numbers between two balls."""
    return low.union(high)


def largest(values: Iterable[arb]) -> arb:
    """Return a ball that contains the largest of some numbers."""
    return reduce(arb.max, values)


def least(values: Iterable[arb]) -> arb:
    """Return a ball that contains the least of some numbers."""
    return reduce(arb.min, values)


def above(value: arb) -> float:
    """Return a double that is not below any number of a ball."""
    return math.nextafter(float(value.upper()), math.inf)


def below(value: arb) -> float:
    """Return a double that is not above any number of a ball."""
    return math.nextafter(float(value.lower()), -math.inf)


def whole(value: arb) -> int:
    """Return the only whole number in a ball; raise Refused if there is none, or several."""
    number = value.unique_fmpz()
    if number is None:
        raise Refused("the number of half turns of the forcing phase is not decided")
    return int(number)
