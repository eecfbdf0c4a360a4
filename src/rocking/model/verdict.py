"""What a response is, and how that is known."""

from __future__ import annotations

import math
from enum import StrEnum

from attrs import field, frozen

from rocking.model import pictures
from rocking.model.system import State, System
from rocking.model.words import counted


class Kind(StrEnum):
    """What a response is: a plain string, and one of six; no kind is ever a default.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9)
    >>> rk.classify(system).kind is rk.Kind.REST, rk.Kind.REST == "rest"
    (True, True)
    """

    REST = "rest"
    PERIODIC = "periodic"
    QUASI_PERIODIC = "quasi-periodic"
    CHAOTIC = "chaotic"
    OVERTURNED = "overturned"
    UNDETERMINED = "undetermined"


@frozen
class Evidence:
    """Why a response is called what it is called; reads as one sentence.

    Attributes
    ----------
    level : str
        "exact" (follows from the closed form), "verified" (a number meets a stated tolerance), "statistical"
        (holds over the cycles watched, no further) or "none".
    shown : str
        What was shown, in one sentence.
    tolerances : dict
        The tolerances that were met, by name.
    cycles : int
        Forcing cycles spent.
    """

    level: str
    shown: str
    tolerances: dict[str, float]
    cycles: int

    def __str__(self) -> str:
        return self.shown


@frozen
class Orbit:
    """A periodic orbit.

    Attributes
    ----------
    system : System
        The system it belongs to.
    state : State
        Its state at the phase `phase` of the forcing.
    phase : float
        Forcing phase ψ of the section that `state` lies on, rad in [0, 2π).
    period : int
        Forcing cycles after which it repeats itself.
    symmetric : bool
        Whether half a period later it is its own mirror image.
    impacts, brace_hits : int or None
        Impacts at Θ = 0 and hits on the braces in a period; None where it rests or leans, for then they accumulate.
    multipliers : tuple of two complex
        Floquet multipliers over a period, the larger first.
    residual : float
        Distance between `state` and the state a period later.
    """

    system: System
    state: State
    phase: float
    period: int
    symmetric: bool
    impacts: int | None
    brace_hits: int | None
    multipliers: tuple[complex, complex]
    residual: float

    @property
    def stable(self) -> bool:
        """Whether both multipliers lie inside the unit circle."""
        return abs(self.multipliers[0]) < 1.0

    def __str__(self) -> str:
        symmetry = "symmetric" if self.symmetric else "unsymmetric"
        impacts = "rest or leaning" if self.impacts is None else counted(self.impacts, "impact")
        return f"{symmetry} orbit of period {self.period} with {impacts}"


@frozen
class Verdict:
    """What a response is, with its evidence; made by `classify`.

    What does not apply is None. What describes an orbit (`period` to `multipliers`, `orbit`) is known of periodic responses
    alone; of those that come to rest or lean between releases the impacts are None, for they accumulate.

    Attributes
    ----------
    system, start : System, State
        What was judged.
    kind : Kind
        The label.
    evidence : Evidence
        Why; `print` shows it as one sentence.
    period : int or None
        Forcing cycles after which a periodic response repeats itself.
    impacts_per_period, brace_hits_per_period : int or None
        Impacts at Θ = 0 and hits on the braces in that period.
    symmetric : bool or None
        Whether a periodic response is its own mirror image half a period later; never with an even period.
    multipliers : tuple of two complex, or None
        Floquet multipliers over a period, the larger first; zeros where the response rests or leans in between.
    exponent, exponent_error : float or None
        Largest Lyapunov exponent per τ and its standard error, measured where the response is chaotic or undetermined, else
        what follows from the verdict: from the multipliers; 0 on a torus or a neutral orbit, then without an error; −∞ at rest, leaning and
        where the response does so in between (superstable). None of a block that overturns, and where it was not weighed.
    peak : float
        Largest |Θ| of the motion from its start, as far as it was followed, and of the orbit that it approaches; until
        the proof if it overturns.
    steady_peak : float or None
        Largest |Θ| of a periodic response itself; |Θ| at rest or leaning.
    transient : int or None
        Forcing cycles after which the response was seen to be reached, at most; 0 on a torus; of an overturning block the
        cycles before the one of the proof; None of chaotic and undetermined responses.
    cycles : int
        Forcing cycles followed.
    impacts : int
        Impacts and brace hits computed, all work included.
    orbit : Orbit or None
        The periodic orbit; of a response that rests or leans in between, a release.

    Examples
    --------
    >>> import rocking as rk
    >>> print(rk.classify(rk.System(rk.Harmonic(amplitude=1.75, period=2.0), restitution=0.95)))
    overturned: proved after 4 impacts, at τ = 10.3092, never to return: the growing part of the motion can no longer be undone (exact)
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
        """Whether the response forgets every small difference, at rest or leaning."""
        return self.exponent == -math.inf

    def __str__(self) -> str:
        return f"{self.kind}: {self.evidence}"

    def _repr_html_(self) -> str | None:
        return pictures.html(self)
