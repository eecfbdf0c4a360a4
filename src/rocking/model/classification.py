"""Kinds of responses, and the criteria by which a response is classified or stays undetermined."""

from __future__ import annotations

from enum import IntEnum, StrEnum


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

    @property
    def code(self) -> int:
        """Number of the kind in maps.

        Examples
        --------
        >>> import rocking as rk
        >>> found = rk.parametric_map(amplitude=[0.5, 2.0], period=[1.0, 2.0], restitution=0.925)
        >>> int((found.kind == rk.Kind.REST.code).sum())
        2
        """
        return list(type(self)).index(self)


class Criterion(IntEnum):
    """Criterion of a verdict: its code in maps, the level of its evidence, and what it says in a few words.

    Attributes
    ----------
    level : str
        As `Evidence.level`.
    brief : str
        The criterion in a few words.
    why : str
        Why a response is undetermined, in a clause; "" for a criterion that decides.

    Examples
    --------
    >>> Criterion(5).level, Criterion.TORUS.brief, str(Criterion.NO_RETURN)
    ('statistical', 'averages agree as on a torus', 'no-return')
    """

    level: str
    brief: str
    why: str

    NO_RETURN = 0, "exact", "proved never to return"
    STILL_FOR_EVER = 1, "exact", "proved to rest for ever"
    RESET = 2, "verified", "released as before"
    ORBIT = 3, "verified", "a stable orbit is reached"
    NEUTRAL_ORBIT = 4, "verified", "a neutral orbit"
    TORUS = 5, "statistical", "averages agree as on a torus"
    EXPONENT = 6, "statistical", "exponent clearly positive"
    UNRESOLVED_RESET = (
        7,
        "none",
        "released, period unresolved",
        "rests or leans and is released again, too sensitive to tell its period",
    )
    UNWATCHED = (
        8,
        "none",
        "too few cycles to tell",
        "no orbit reached, in too few cycles to call it chaotic",
    )
    INDISTINCT = 9, "none", "exponent not clear", "no orbit reached, and an exponent not clearly above zero"
    BETWEEN = (
        10,
        "none",
        "between torus and chaos",
        "averages agree too well for chaos, not well enough for a torus",
    )
    CROWDED = (11, "none", "too many events", "chatters almost without loss, more impacts than are followed")
    STANDING = 12, "none", "stands on an unstable orbit", "stands on an unstable orbit"
    LITTLE_GROWTH = (
        13,
        "none",
        "differences grew little",
        "an exponent above zero, but differences grew as little as while a motion leaves an unstable orbit",
    )
    CORRELATED = (
        14,
        "none",
        "batches are correlated",
        "an exponent above zero, but from batches that depend on each other",
    )
    LINGERING = (
        15,
        "none",
        "close to an unstable orbit",
        "an exponent above zero, but close to an unstable orbit in the last cycles",
    )

    def __new__(cls, code: int, level: str = "", brief: str = "", why: str = "") -> Criterion:
        """Make a member that is its code, with what goes with it."""
        member = int.__new__(cls, code)
        member._value_ = code
        member.level, member.brief, member.why = level, brief, why
        return member

    def __str__(self) -> str:
        return self.name.lower().replace("_", "-")
