"""Proof of a chaotic invariant set."""

from __future__ import annotations

from rocking.model.orbit import Stability
from rocking.model.proof import Horseshoe
from rocking.model.system import System
from rocking.model.validation import Statement, instance, refuse_if, whole
from rocking.orbits.find_orbits import MAX_PERIOD, find_orbits
from rocking.proof.prove import check_provable, module


def horseshoe(system: System, search: bool = False, max_period: int = 4) -> Horseshoe:
    """Prove a chaotic invariant set, a Smale horseshoe.

    Without `search`, it follows from the manifolds of the two saddle orbits. Above the amplitude of the exact tangency they cross
    transversally. Both arcs must keep their side of Θ = 0, which always holds up to the amplitude √(1 + Ω²). The closed form of
    the crossing is evaluated in ball arithmetic.

    With `search`, two unstable orbits are sought that come near each other. Then Krawczyk's operator shows that a motion may follow
    two patterns of events in any order. This gives a lower bound of the topological entropy, and allows braces.

    Parameters
    ----------
    system : System
        Slender block under a harmonic base motion; without braces, unless `search` is True.
    search : bool
        Whether to search for two patterns of events. Takes seconds to minutes. Default: False.
    max_period : int
        Longest period of the orbits of the search, in forcing cycles, in [1, 64]. Default: 4.

    Returns
    -------
    Horseshoe
        Proof; `print` shows it in words. If there is none, `proved` is False, and `claim` says why.

    Raises
    ------
    ImportError
        If python-flint is not installed.
    TypeError
        If an argument is of the wrong type, or the base motion is not periodic.
    ValueError
        If the block is not slender, or has braces and `search` is False.

    See Also
    --------
    tangency_amplitude : Amplitude of the exact tangency.
    prove : Prove a periodic orbit.

    Notes
    -----
    The set contains infinitely many unstable orbits. The manifolds also show that basin boundaries are fractal. None of this
    shows that an attractor is chaotic: a (1, 1) mode may attract beside the set.

    References
    ----------
    Smale, Bulletin of the American Mathematical Society 73, 747–817 (1967).

    Examples
    --------
    >>> import rocking as rk
    >>> for amplitude in (3.6878131, 3.687813):
    ...     print(rk.horseshoe(rk.System(rk.Harmonic(amplitude=amplitude, period=1.0), restitution=0.8)).proved)
    True
    False
    """
    instance("system", system, System).periodic  # noqa: B018 (it refuses)
    check_provable(system)
    if system.left is not None:
        raise Statement(
            "horseshoes", "are proved for the symmetric block only", remedy="omit {left} and {offset}"
        )
    if not instance("search", search, bool):
        refuse_if(system.braces is not None, "system", "have no braces without search=True", system)
        crossing: Horseshoe = module("horseshoe").tangle_of(system)
        return crossing
    max_period = whole("max_period", max_period, 1, MAX_PERIOD)
    for period in range(1, max_period + 1):  # short orbits are found sooner, and few of them suffice
        result = find_orbits(system, period)
        unstable = [orbit for orbit in result if orbit.stability is Stability.UNSTABLE]
        shift: Horseshoe = module("horseshoe").word_shift_of(system, unstable)
        if shift.proved:
            break
    return shift
