"""Verdict on a response, and its evidence."""

from __future__ import annotations

import math

from attrs import field, frozen

from rocking.model.classification import Kind
from rocking.model.notebook_renderers import NotebookPicture
from rocking.model.orbit import Orbit
from rocking.model.system import State, System


@frozen
class Evidence:
    """Evidence for a verdict; as text, its sentence.

    Attributes
    ----------
    level : str
        "exact": it follows from the closed form. "proved": in ball arithmetic, by `prove`. "verified": a number meets a stated
        tolerance. "statistical": it holds over the simulated cycles only. "none": nothing was shown.
    shown : str
        Finding, level and number of cycles in words; the remedy if the response is undetermined.
    tolerances : dict
        Tolerances that were met, by name.
    cycles : int
        Number of forcing cycles simulated.

    Examples
    --------
    >>> import rocking as rk
    >>> found = rk.classify(rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9))
    >>> print(found.evidence)
    the block remains at rest, because A = 0.5 ≤ 1 cannot lift it off. Evidence: exact, from the initial state on.
    """

    level: str
    shown: str
    tolerances: dict[str, float] = field(hash=False)
    cycles: int

    def __str__(self) -> str:
        return self.shown


@frozen
class Verdict(NotebookPicture):
    """Response type of a motion, with its evidence; returned by `classify`.

    An attribute that does not apply is None. The attributes of an orbit (`period` to `multipliers`, and `orbit`) are given
    for periodic responses only.

    Attributes
    ----------
    system, start : System, State
        Classified system and initial state.
    kind : Kind
        Response type.
    evidence : Evidence
        Evidence; `print` shows it in words.
    period : int or None
        Number of forcing cycles per response period.
    impacts_per_period, brace_hits_per_period : int or None
        Number of impacts at Θ = 0 and on the braces per response period. None if infinitely many precede rest or
        sustained contact with a brace.
    symmetric : bool or None
        True if the periodic response is its own mirror image half a period later. Only an odd period can be symmetric.
    multipliers : tuple of two complex, or None
        Floquet multipliers over one response period, the larger first. Both are zero for a superstable response.
    exponent, exponent_error : float or None
        Largest Lyapunov exponent per τ and its standard error. It is measured for chaotic and undetermined responses, and
        otherwise follows from the verdict:

        - periodic: from the multipliers, −∞ if superstable;
        - at rest or in permanent contact with a brace: −∞;
        - quasi-periodic or neutrally stable: 0, without an error.

        None if the block overturns, or if it was not measured.
    peak : float
        Largest |Θ| over the simulated motion and over the orbit that it approaches. If the block overturns, up to the
        instant from which overturning is certain.
    steady_peak : float or None
        Largest |Θ| of the periodic response itself; |Θ| at rest or in contact with a brace.
    transient : int or None
        Number of forcing cycles after which the response was reached at the latest; 0 on a torus. If the block
        overturns, the cycles before that of the proof. None for chaotic and undetermined responses.
    cycles : int
        Number of forcing cycles simulated.
    impacts : int
        Number of impacts computed, on the base and on the braces, including auxiliary computations.
    orbit : Orbit or None
        Periodic orbit; for a superstable response, it begins at a lift-off or at a release from a brace.

    Examples
    --------
    >>> import rocking as rk
    >>> print(rk.classify(rk.System(rk.Harmonic(amplitude=1.75, period=2.0), restitution=0.95)))
    overturned: overturning is certain from τ = 10.3092, after 4 impacts, because the growing ... Evidence: exact, within 6 cycles.
    """

    system: System
    start: State
    kind: Kind
    evidence: Evidence
    period: int | None
    impacts_per_period: int | None
    brace_hits_per_period: int | None
    symmetric: bool | None
    multipliers: tuple[complex, complex] | None
    exponent: float | None
    exponent_error: float | None
    peak: float
    steady_peak: float | None
    transient: int | None
    cycles: int
    impacts: int = field(repr=False)
    orbit: Orbit | None = field(repr=False)

    @property
    def superstable(self) -> bool:
        """True if perturbations vanish at rest or in sustained contact with a brace, so that the exponent is −∞."""
        return self.exponent == -math.inf

    def __str__(self) -> str:
        return f"{self.kind}: {self.evidence}"
