"""Response types, and the criteria by which a response is classified or remains undetermined."""

from __future__ import annotations

from enum import IntEnum, StrEnum


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
        >>> found = rk.parametric_map(amplitude=[0.5, 2.0], period=[1.0, 2.0], restitution=0.925)
        >>> int((found.kind == rk.Kind.REST.code).sum())
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
