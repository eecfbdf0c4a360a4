"""Proof of periodic orbits; the modules behind it need python-flint."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from rocking.model.orbit import Orbit
from rocking.model.package import require_extra
from rocking.model.proof import Proof
from rocking.model.quantity import LEFT_QUANTITIES
from rocking.model.system import System, check_start
from rocking.model.validation import Statement, WrongType, instance, refuse_if, within
from rocking.model.verdict import Verdict

MAX_HALF_WIDTH = 1.0


def module(name: str) -> Any:
    """Return a module of this package that computes with balls; ImportError without python-flint."""
    require_extra("proof")
    return import_module(f"rocking.proof.{name}")


def prove(subject: Orbit | Verdict, uncertain: Mapping[str, float] | None = None) -> Proof:
    """Prove in ball arithmetic that a periodic orbit exists, and whether it is stable.

    The proof has these parts:

    1. Krawczyk's operator shows that the equations of the events have exactly one solution near the orbit.
    2. Bounds on every arc show that the block meets the base and the braces at these events only.
    3. The Floquet multipliers are enclosed, hence the stability.
    4. The least period and the symmetry are shown, because the phases of other events differ.

    An orbit that rests in each period needs one flight from a release to the next rest. For a verdict, a neighbourhood of the
    orbit is shown to converge to it. Then the motion from the initial state is followed until it lies in there. The precision
    grows until the proof succeeds or is given up.

    Parameters
    ----------
    subject : Orbit or Verdict
        Orbit to prove, or verdict of a periodic response whose initial state is to be shown to lead to the orbit.
    uncertain : dict of str to float, optional
        Half-widths of parameters by name. Then the proof holds for every system in these ranges. Default: none, so that the
        numbers given are exact.

    Returns
    -------
    Proof
        Proof; `print` shows it in words. If there is none, `proved` is False, and `claim` says why.

    Raises
    ------
    ImportError
        If python-flint is not installed.
    TypeError
        If an argument is of the wrong type.
    ValueError
        If the block is not slender, the verdict is not periodic, or a half-width is not that of a parameter of the system.

    See Also
    --------
    classify : With `prove`, the verdict includes the proof.
    horseshoe : Prove a chaotic invariant set.

    Notes
    -----
    Not proved: that a search has found all orbits, or that an attractor is chaotic. Not covered: sustained contact with a brace
    and e = 0. For an unsymmetric block the orbits with finitely many impacts, at least one, are covered, and no initial states.

    Examples
    --------
    >>> import rocking as rk
    >>> verdict = rk.classify(rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925))
    >>> proof = rk.prove(verdict)
    >>> proof.proved, proof.stable, proof.starts
    (True, True, True)
    """
    if not isinstance(subject, Verdict):
        if not isinstance(subject, Orbit):
            raise WrongType("subject", "be an Orbit or a Verdict", subject)
        return _checked(subject, uncertain, None)
    refuse_if(subject.orbit is None, "subject", "be an orbit or a periodic verdict", str(subject.kind))
    assert subject.orbit is not None
    check_start(subject.system, subject.start)
    same = _without_phase(subject.system) == _without_phase(subject.orbit.system)
    refuse_if(not same, "subject", "have the system of its orbit", subject.system)
    return _checked(subject.orbit, uncertain, subject)


def _without_phase(system: System) -> tuple[object, ...]:
    """Return the quantities of a system but for the phase of its base motion, which is that of the start."""
    forcing = system.periodic
    return forcing.amplitude, forcing.given, system.restitution, system.braces, system.critical_angle


def check_provable(system: System) -> None:
    """Raise ImportError without python-flint, and ValueError for a block that is not slender."""
    if system.critical_angle is not None:
        allowed, remedy = "are available for the slender block only", "omit {critical_angle} and {model} full"
        raise Statement("proofs", allowed, remedy=remedy)
    require_extra("proof")


def _checked(orbit: Orbit, uncertain: Mapping[str, float] | None, verdict: Verdict | None) -> Proof:
    system, widths = orbit.system, dict(instance("uncertain", {} if uncertain is None else uncertain, dict))
    check_provable(system)
    present = {system.periodic.given[0], "amplitude", "restitution"}
    present |= set() if system.braces is None else {"brace_angle", "brace_restitution"}
    present |= set() if system.left is None else set(LEFT_QUANTITIES)
    for name, width in widths.items():
        refuse_if(
            name not in present, "uncertain", f"name parameters given: {', '.join(sorted(present))}", name
        )
        widths[name] = within(f"half-width of {name}", width, 0.0, MAX_HALF_WIDTH)
    return module("cases").proof_of(orbit, {name: width for name, width in widths.items() if width}, verdict)
