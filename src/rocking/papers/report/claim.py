"""Claims of the paper, each with the computation that tests it and the resulting verdict."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from enum import StrEnum

from attrs import evolve, frozen

from rocking.model.package import missing_extra

PROVABLE = not missing_extra("proof")
"""True if the extra `proof` is installed. Then the report proves its periodic responses, too."""
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def small(value: float) -> str:
    """Return a difference in scientific notation, to one digit.

    Examples
    --------
    >>> small(6.1e-14), small(-1e-3), small(0.0)
    ('6·10⁻¹⁴', '−10⁻³', '0')
    """
    return typeset(f"{value:.0e}") if value else "0"


def agreement(value: float) -> str:
    """Return the maximum difference of two computed quantities as text.

    Examples
    --------
    >>> agreement(6.1e-14), agreement(0.0)
    ('equal to within 6·10⁻¹⁴', 'equal bit for bit')
    """
    return f"equal to within {small(value)}" if value else "equal bit for bit"


def typeset(text: str) -> str:
    """Return text with typeset numbers: a minus sign for a hyphen, and powers of ten for exponents.

    Examples
    --------
    >>> typeset("-0.052, within 1e-07, 2.5e+05, cycles 1-3, x-2")
    '−0.052, within 10⁻⁷, 2.5·10⁵, cycles 1-3, x-2'
    """

    def power(match: re.Match[str]) -> str:
        digits, exponent = match.groups()
        ten = f"10{str(int(exponent)).translate(SUPERSCRIPT)}"
        return ten if digits == "1" else f"{digits}·{ten}"

    text = re.sub(r"(?<![\w.])(\d+(?:\.\d+)?)e([+-]\d+)\b", power, text)
    return re.sub(r"(?<![\w.])-(?=\d)", "−", text)


class Standing(StrEnum):
    """Kind of a verdict on a claim."""

    CONFIRMED = "confirmed"
    QUALIFIED = "confirmed with qualification"
    MISPRINT = "misprint"
    ERROR = "error in the paper"
    NOT_CONFIRMED = "not confirmed"
    UNTESTED = "not judged"

    @property
    def key(self) -> str:
        """Name in addresses and styles."""
        return self.name.lower().replace("_", "-")


@frozen
class Finding:
    """Result of the computation for a claim.

    Attributes
    ----------
    holds : bool
        Whether the figures support the claim as printed.
    figures : str
        Computed figures.
    explained : bool
        For a claim that does not hold: whether the same computation supports the explanation.
    """

    holds: bool
    figures: str
    explained: bool = False


@frozen
class Claim:
    """Paraphrased claim of the paper, and the computation that tests it.

    Attributes
    ----------
    place : str
        Place of the claim in the paper.
    says : str
        Text of the claim, with its numbers as printed.
    compute : callable
        Computation that returns a `Finding`.
    otherwise : Standing
        Verdict if the claim does not hold as printed and the finding supports `because`.
    because : str
        Explanation, or the correct statement.
    cost : float
        Approximate processor time, s.
    main : bool
        Whether the claim is among the main findings, which the first page of the report lists.
    """

    place: str
    says: str
    compute: Callable[[], Finding]
    otherwise: Standing
    because: str
    cost: float
    main: bool = False

    @property
    def anchor(self) -> str:
        """Name of the claim in addresses. It is the same in all runs."""
        return f"claim-{self.compute.__name__.replace('_', '-')}"

    @property
    def name(self) -> str:
        """Name of the function that tests the claim."""
        return f"{self.compute.__module__.removeprefix('rocking.')}.{self.compute.__name__}"

    @property
    def source(self) -> str:
        """Source code of the function that tests the claim."""
        return inspect.getsource(self.compute)

    def test(self) -> Verdict:
        """Run the computation and return the verdict."""
        return self.verdict(self.compute())

    def verdict(self, finding: Finding) -> Verdict:
        """Return the verdict that follows from a finding."""
        finding = evolve(finding, figures=typeset(finding.figures))
        if finding.holds:
            return Verdict(self, Standing.CONFIRMED, finding)
        return Verdict(self, self.otherwise if finding.explained else Standing.NOT_CONFIRMED, finding)


@frozen
class Verdict:
    """Verdict on a claim, with the finding from which it follows."""

    claim: Claim
    standing: Standing
    finding: Finding

    @property
    def because(self) -> str:
        """Explanation, or the correct statement; empty for a confirmed claim."""
        return "" if self.standing is Standing.CONFIRMED else self.claim.because


class Chapter(list[Claim]):
    """Claims of one part of the paper, in their order."""

    def __init__(self, title: str) -> None:
        super().__init__()
        self.title = title

    def claim(
        self,
        place: str,
        qualified: str = "",
        misprint: str = "",
        error: str = "",
        untested: str = "",
        cost: float = 0.05,
        main: bool = False,
    ) -> Callable[[Callable[[], Finding]], Callable[[], Finding]]:
        """Register the decorated function as the test of the claim in its docstring.

        `qualified`, `misprint` or `error` is the explanation for a claim that does not hold as printed; its name selects
        the verdict. The explanation counts only if the finding supports it. `untested` is the reason why a claim cannot be
        tested with this package; its finding supports that reason. `cost` is the approximate processor time, s. `main` says
        that the claim is among the main findings.
        """
        explained = {
            Standing.QUALIFIED: qualified,
            Standing.MISPRINT: misprint,
            Standing.ERROR: error,
            Standing.UNTESTED: untested,
        }
        otherwise, because = next(
            ((standing, text) for standing, text in explained.items() if text), (Standing.NOT_CONFIRMED, "")
        )

        def add(compute: Callable[[], Finding]) -> Callable[[], Finding]:
            says = " ".join((inspect.getdoc(compute) or "").split()).removesuffix(".")
            self.append(Claim(place, says, compute, otherwise, because, cost, main))
            return compute

        return add
