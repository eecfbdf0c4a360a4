"""A claim of the paper, and what comes of it when it is computed."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from enum import StrEnum

from attrs import evolve, frozen

SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def small(value: float) -> str:
    """A difference as a power of ten, to one digit.

    Examples
    --------
    >>> small(6.1e-14), small(0.0)
    ('6·10⁻¹⁴', '0')
    """
    digit, _, power = f"{value:.0e}".partition("e")
    return f"{digit}·10{str(int(power)).translate(SUPERSCRIPT)}" if value else "0"


def agreement(value: float) -> str:
    """How far two computed quantities are apart at most.

    Examples
    --------
    >>> agreement(6.1e-14), agreement(0.0)
    ('apart by at most 6·10⁻¹⁴', 'equal bit for bit')
    """
    return f"apart by at most {small(value)}" if value else "equal bit for bit"


def typeset(text: str) -> str:
    """Text with its numbers as in print: a minus sign, and powers of ten.

    Examples
    --------
    >>> typeset("-0.052, within 1e-07, 2.5e+05, cycles 1-3, x-2")
    '−0.052, within 10⁻⁷, 2.5·10⁵, cycles 1-3, x-2'
    """

    def power(found: re.Match[str]) -> str:
        digits, exponent = found.groups()
        ten = f"10{str(int(exponent)).translate(SUPERSCRIPT)}"
        return ten if digits == "1" else f"{digits}·{ten}"

    text = re.sub(r"(?<![\w.])(\d+(?:\.\d+)?)e([+-]\d+)\b", power, text)
    return re.sub(r"(?<![\w.])-(?=\d)", "−", text)


class Standing(StrEnum):
    """How a claim stands after the computation."""

    REPRODUCED = "reproduced"
    DIFFERS = "differs"
    SLIPS = "the paper slips"
    UNEXPLAINED = "not explained"


@frozen
class Finding:
    """What was computed for a claim.

    Attributes
    ----------
    holds : bool
        Whether the figures bear the claim out.
    figures : str
        The figures.
    shown : bool
        Where the claim does not hold: whether what we say in its place was shown by the same computation.
    """

    holds: bool
    figures: str
    shown: bool = False


@frozen
class Claim:
    """A claim of the paper, in our words, and the computation that judges it.

    Attributes
    ----------
    place : str
        Where the paper makes it.
    says : str
        What it says, with its numbers as printed.
    compute : callable
        Returns a `Finding`.
    otherwise : Standing
        What it is if it does not hold and `because` is shown.
    because : str
        What holds in its place.
    """

    place: str
    says: str
    compute: Callable[[], Finding]
    otherwise: Standing
    because: str

    @property
    def name(self) -> str:
        """The function that computes it."""
        return f"{self.compute.__module__.removeprefix('rocking.')}.{self.compute.__name__}"

    @property
    def source(self) -> str:
        """Its text: how the claim was judged."""
        return inspect.getsource(self.compute)

    def judged(self) -> Judged:
        """Computed now."""
        finding = self.compute()
        finding = evolve(finding, figures=typeset(finding.figures))
        if finding.holds:
            return Judged(self, Standing.REPRODUCED, finding)
        return Judged(self, self.otherwise if finding.shown else Standing.UNEXPLAINED, finding)


@frozen
class Judged:
    """A claim with its finding."""

    claim: Claim
    standing: Standing
    finding: Finding

    @property
    def because(self) -> str:
        """What holds in its place; empty where the claim does."""
        return "" if self.standing is Standing.REPRODUCED else self.claim.because


class Chapter(list[Claim]):
    """The claims of one part of the paper, in their order."""

    def __init__(self, title: str) -> None:
        super().__init__()
        self.title = title

    def claim(
        self, place: str, differs: str = "", slips: str = ""
    ) -> Callable[[Callable[[], Finding]], Callable[[], Finding]]:
        """Make the decorated function the judge of the claim that is its docstring.

        `differs` or `slips` is what holds if the claim does not.
        """

        def add(compute: Callable[[], Finding]) -> Callable[[], Finding]:
            otherwise = Standing.SLIPS if slips else Standing.DIFFERS if differs else Standing.UNEXPLAINED
            says = " ".join((inspect.getdoc(compute) or "").split()).removesuffix(".")
            self.append(Claim(place, says, compute, otherwise, slips or differs))
            return compute

        return add
