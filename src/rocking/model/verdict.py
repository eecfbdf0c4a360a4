"""Verdict on a response: type, criterion and evidence; outcome of a simulated motion."""

from __future__ import annotations

import math
from enum import IntEnum, StrEnum
from typing import TYPE_CHECKING, Any

from attrs import field, frozen

from rocking.model.orbit import ORBIT_TEXTS, Orbit, facts_of
from rocking.model.result import Result, described
from rocking.model.system import State, System, quantities

if TYPE_CHECKING:
    import xarray as xr


class Kind(StrEnum):
    """Type of a response: a string, one of six. No type is a default.

    Attributes
    ----------
    code : int
        Number of the type in maps, 0 to 5.

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

    @property
    def code(self) -> int:
        """Number of the response type in maps.

        Examples
        --------
        >>> import rocking as rk
        >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
        >>> result = rk.parametric_map(system, amplitude=[0.5, 2.0], period=[1.0, 2.0])
        >>> int((result.dataset.kind == rk.Kind.REST.code).sum())
        2
        """
        return list(type(self)).index(self)


class Criterion(IntEnum):
    """Criterion of a verdict: its code in maps, the level of its evidence and its description.

    Attributes
    ----------
    level : str
        Level of the evidence, as in `Evidence.level`.
    brief : str
        Description in a few words.
    why : str
        Reason why a response is undetermined, as a clause; "" for a criterion that decides.

    Examples
    --------
    >>> Criterion(5).level, Criterion.TORUS.brief, str(Criterion.NO_RETURN)
    ('statistical', 'averages agree as on a torus', 'no-return')
    """

    level: str
    brief: str
    why: str

    NO_RETURN = 0, "exact", "overturning proved"
    STILL_FOR_EVER = 1, "exact", "permanent rest proved"
    RESET = 2, "verified", "restarts from the same state"
    ORBIT = 3, "verified", "stable orbit reached"
    NEUTRAL_ORBIT = 4, "verified", "neutrally stable orbit"
    TORUS = 5, "statistical", "averages agree as on a torus"
    EXPONENT = 6, "statistical", "exponent significantly positive"
    UNRESOLVED_RESET = (
        7,
        "none",
        "restarts, period unresolved",
        "repeatedly rests or sticks to a brace, and its period is too sensitive to be resolved",
    )
    UNWATCHED = (
        8,
        "none",
        "too few cycles",
        "no orbit reached, and too few cycles to call it chaotic",
    )
    INDISTINCT = (
        9,
        "none",
        "exponent not significant",
        "no orbit reached, and the exponent is not significantly positive",
    )
    BETWEEN = (
        10,
        "none",
        "between torus and chaos",
        "averages agree too well for chaos and not well enough for a torus",
    )
    CROWDED = (
        11,
        "none",
        "too many impacts",
        "chatters with little energy loss, with more impacts per cycle than the limit",
    )
    STANDING = 12, "none", "on an unstable orbit", "remains on an unstable orbit"
    LITTLE_GROWTH = (
        13,
        "none",
        "perturbations grew little",
        "positive exponent, but perturbations grew no more than while a motion leaves an unstable orbit",
    )
    CORRELATED = (
        14,
        "none",
        "batches are correlated",
        "positive exponent, but from correlated batches",
    )
    LINGERING = (
        15,
        "none",
        "close to an unstable orbit",
        "positive exponent, but close to an unstable orbit in the last cycles",
    )

    def __new__(cls, code: int, level: str = "", brief: str = "", why: str = "") -> Criterion:
        """Create a member whose value is its code."""
        member = int.__new__(cls, code)
        member._value_ = code
        member.level, member.brief, member.why = level, brief, why
        return member

    def __str__(self) -> str:
        return self.name.lower().replace("_", "-")


class Outcome(StrEnum):
    """State of knowledge about a motion after the simulated cycles: a string, one of three.

    `BOUNDED` means only that neither of the other outcomes was proved in these cycles. `AT_REST` includes permanent
    contact with a brace.

    Examples
    --------
    >>> import rocking as rk
    >>> motion = rk.simulate(rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9))
    >>> motion.outcome is rk.Outcome.AT_REST, motion.outcome == "at-rest", str(motion.outcome)
    (True, True, 'at-rest')
    """

    BOUNDED = "bounded"
    AT_REST = "at-rest"
    OVERTURNED = "overturned"


@frozen
class Overturning:
    """Instant from which overturning is certain.

    Attributes
    ----------
    time : float
        Normalised time τ of the proof.
    cycle : int
        Forcing cycle of the proof, counted from 0.
    impacts : int
        Number of impacts before it.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=1.75, period=2.0), restitution=0.95)
    >>> rk.simulate(system).overturning
    Overturning(time=10.309, cycle=5, impacts=4)
    """

    time: float
    cycle: int
    impacts: int


@frozen
class Evidence:
    """Evidence for a verdict; as text, its sentence.

    Attributes
    ----------
    level : str
        "exact": it follows from the closed form. "proved": in ball arithmetic, by `prove`. "verified": a number meets a stated
        tolerance. "statistical": it holds over the simulated cycles only. "none": nothing was shown.
    statement : str
        Finding, level and number of cycles in words; the remedy if the response is undetermined.
    tolerances : dict
        Tolerances that were met, by name.
    cycles : int
        Number of forcing cycles simulated.

    Examples
    --------
    >>> import rocking as rk
    >>> result = rk.classify(rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9))
    >>> print(result.evidence)
    the block remains at rest, because A = 0.5 ≤ 1 cannot lift it off. Evidence: exact, from the initial state on.
    """

    level: str
    statement: str
    tolerances: dict[str, float] = field(hash=False)
    cycles: int

    def __str__(self) -> str:
        return self.statement


@frozen
class Verdict(Result):
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

    PLOT = "verdict"

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

    def _data(self) -> xr.Dataset:
        import xarray as xr

        orbit = {} if self.orbit is None else facts_of(self.orbit)
        proof = None if self.orbit is None else self.orbit.proof
        attributes = described("Verdict on the motion") | {
            **quantities(self.system),
            "start_angle": self.start.angle,
            "start_velocity": self.start.velocity,
            "kind": str(self.kind),
            "evidence": str(self.evidence),
            "level": self.evidence.level,
            "response_period": self.period,
            **{
                name: orbit.get(name)
                for name in ORBIT_TEXTS
                if name != "orbit_period" and not name.startswith("start_")
            },
            "exponent": self.exponent,
            "exponent_error": self.exponent_error,
            "superstable": self.superstable,
            "peak": self.peak,
            "steady_peak": self.steady_peak,
            "transient": self.transient,
            "cycles": self.cycles,
            "events_computed": self.impacts,
            **{
                f"tolerance_{name.replace(' ', '_')}": value
                for name, value in self.evidence.tolerances.items()
            },
            **{f"proof_{name}": each for name, each in (proof.facts if proof else {}).items()},
        }
        return xr.Dataset(attrs=attributes)

    @property
    def superstable(self) -> bool:
        """True if perturbations vanish at rest or in sustained contact with a brace, so that the exponent is −∞."""
        return self.exponent == -math.inf

    def _figure(self) -> Any:
        """Return the figure without the sentence, which a notebook shows below it."""
        return self.plot(title=False)

    def __str__(self) -> str:
        return f"{self.kind}: {self.evidence}"
