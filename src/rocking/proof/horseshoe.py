"""Proof of a chaotic invariant set."""

from __future__ import annotations

from rocking.model import Horseshoe, System, instance, refuse_if
from rocking.proof.prove import check_provable, module


def horseshoe(system: System) -> Horseshoe:
    """Prove a chaotic invariant set, a Smale horseshoe, from the manifolds of the saddle orbits.

    Above the amplitude of the exact tangency the unstable manifold of one saddle orbit crosses the stable one of the other at
    Θ = 0, transversally. The closed form of the crossing is evaluated in ball arithmetic. Both arcs must keep their side of
    Θ = 0, which always holds up to the amplitude √(1 + Ω²), and beyond it must be shown.

    Parameters
    ----------
    system : System
        Slender block without braces, under a harmonic base motion.

    Returns
    -------
    Horseshoe
        Proof; `print` shows it in words. If there is none, `proved` is False, and `claim` says why.

    Raises
    ------
    ImportError
        If python-flint is not installed.
    TypeError
        If `system` is not a System, or its base motion is not periodic.
    ValueError
        If the block is not slender or has braces.

    See Also
    --------
    tangency_amplitude : Amplitude of the exact tangency.
    prove : Prove a periodic orbit.

    Notes
    -----
    The proof shows that basin boundaries are fractal. It does not show that an attractor is chaotic: a (1, 1) mode may attract
    beside it.

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
    refuse_if(system.braces is not None, "system", "have no braces", system)
    found: Horseshoe = module("crossing_manifolds").horseshoe_of(system)
    return found
