"""Results of proofs in ball arithmetic: of a periodic orbit, and of a chaotic invariant set."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, fields, frozen

from rocking.model.result import Result, along, described
from rocking.model.share import Share, share_variables
from rocking.model.system import System, quantities

if TYPE_CHECKING:
    import xarray as xr

Disc = tuple[complex, float]


@frozen
class Proof(Result):
    """Proof of a periodic orbit in ball arithmetic, or the reason why there is none; returned by `prove`.

    The proof holds for the exact system whose parameters are the numbers given. If the system was given by its period T, the
    angular frequency is 2π/T, not its nearest double. With `uncertain` the proof holds for each system in the ranges.

    Attributes
    ----------
    system : System
        System of the orbit.
    proved : bool
        True if exactly one periodic orbit with this order of events and this symmetry exists near the one given. It meets the
        base and the braces at these events only.
    claim : str
        What is proved, in words; what is not, with the reason.
    phases : tuple of (float, float)
        Middle and radius of the forcing phase of each event, in rad; of a symmetric orbit, over half a period.
    existence : float
        Largest radius of the phases, in rad.
    uniqueness : float
        Radius around the phases, in rad, within which no other orbit has the same order of events. For a symmetric orbit: no
        other symmetric one.
    multipliers : tuple of two (complex, float), or None
        Middle and radius of each Floquet multiplier over one period.
    stable : bool or None
        True if both multipliers lie inside the unit circle, False if one lies outside. None if neither is proved.
    symmetric : bool
        True if the orbit is its own mirror image half a period later.
    period : int
        Least period, in forcing cycles.
    impacts, brace_hits : int or None
        Number of impacts per period, at the base and on the braces. None if infinitely many precede rest.
    attracts : float or None
        Radius around the state of the orbit on its section. All motions from this circle converge to the orbit. None if it was
        not computed or is not proved.
    starts : bool or None
        True if the initial state of the verdict is proved to lead to the orbit. None if only an orbit was given.
    bits : int
        Precision of the numbers, in bits.

    Examples
    --------
    >>> import rocking as rk
    >>> verdict = rk.classify(rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925))
    >>> print(rk.prove(verdict.orbit))
    proved: exactly one symmetric orbit of period 1 with 2 impacts has event phases within 0.15 rad of these; it is stable
    """

    system: System
    proved: bool
    claim: str
    phases: tuple[tuple[float, float], ...] = ()
    existence: float = math.nan
    uniqueness: float = math.nan
    multipliers: tuple[Disc, Disc] | None = None
    stable: bool | None = None
    symmetric: bool = False
    period: int = 0
    impacts: int | None = None
    brace_hits: int | None = None
    attracts: float | None = None
    starts: bool | None = None
    bits: int = 0

    @property
    def facts(self) -> dict[str, Any]:
        """Facts that are numbers, words or flags, by name; of a multiplier the middle and the radius."""
        left_out = ("system", "phases", "multipliers")
        rows = {each.name: getattr(self, each.name) for each in fields(Proof) if each.name not in left_out}
        for number, (middle, radius) in enumerate(self.multipliers or (), 1):
            rows[f"multiplier_{number}_real"] = middle.real
            rows[f"multiplier_{number}_imag"] = middle.imag
            rows[f"multiplier_{number}_radius"] = radius
        return rows

    def _data(self) -> xr.Dataset:
        import xarray as xr

        attributes = described("Proof of a periodic orbit") | quantities(self.system) | self.facts
        middles, radii = np.array(self.phases, float).reshape(-1, 2).T
        columns = {
            "phase": (middles, "middle of the forcing phase of the event", "rad"),
            "phase_radius": (radii, "radius of the forcing phase", "rad"),
        }
        return xr.Dataset(along("event", columns), attrs=attributes)

    def __str__(self) -> str:
        return f"{'proved' if self.proved else 'not proved'}: {self.claim}"


@frozen
class Horseshoe(Result):
    """Proof of a chaotic invariant set, or the reason why there is none; returned by `horseshoe`.

    The set is a Smale horseshoe: infinitely many unstable orbits, and motions that follow any sequence of two patterns. It does not
    show that an attractor is chaotic. If it follows from crossing manifolds, basin boundaries are fractal.

    Attributes
    ----------
    system : System
        System.
    proved : bool
        True if the set exists.
    claim : str
        What is proved, in words, or the reason why it is not.
    phase : float
        Forcing phase, in rad, at which the manifolds of the two saddle orbits cross at Θ = 0; NaN if this was not proved.
    cycles : tuple of int
        Numbers of forcing cycles of the two patterns of events; empty if none were proved.
    entropy : float
        Lower bound of the topological entropy per forcing cycle, from the two patterns; NaN if this was not proved.

    Examples
    --------
    >>> import rocking as rk
    >>> print(rk.horseshoe(rk.System(rk.Harmonic(amplitude=3.7, period=1.0), restitution=0.8)))
    proved: the manifolds of the saddle orbits cross transversally at Θ = 0, at the forcing phase 2.45 rad
    """

    system: System = field(repr=False)
    proved: bool
    claim: str
    phase: float = math.nan
    cycles: tuple[int, ...] = ()
    entropy: float = math.nan

    def _data(self) -> xr.Dataset:
        import xarray as xr

        attributes = described("Horseshoe") | quantities(self.system)
        for each in fields(Horseshoe):
            if each.name not in ("system", "cycles"):
                attributes[each.name] = getattr(self, each.name)
        for number, cycles in enumerate(self.cycles, 1):
            attributes[f"pattern_{number}_cycles"] = cycles
        return xr.Dataset(attrs=attributes)

    def __str__(self) -> str:
        return f"{'proved' if self.proved else 'not proved'}: {self.claim}"


@frozen
class ProvedShare(Result):
    """Fractions of the periodic responses of a map that were proved; returned by `proved_share`.

    Attributes
    ----------
    orbits : Share
        Fraction of responses whose orbit was proved.
    starts : Share
        Fraction of responses whose initial state was proved to lead to the orbit, too.
    reasons : dict of str to int
        Number of the other responses by the reason, the most frequent first.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.parametric_map(system, amplitude=[2.0, 3.0], period=[0.5, 1.0])
    >>> print(rk.proved_share(result))
    4 periodic responses; orbits proved: 100 % (51.0–100 %); initial states proved: 100 % (51.0–100 %)
    """

    orbits: Share
    starts: Share
    reasons: dict[str, int] = field(hash=False)

    def _data(self) -> xr.Dataset:
        import xarray as xr

        names = along("proved", {"proved": (["orbits", "starts"], "what is proved")})
        reasons = {
            "reason": (np.array(list(self.reasons), str), "reason why there is no proof"),
            "reason_count": (np.array(list(self.reasons.values()), int), "number of responses"),
        }
        shares = share_variables("proved", (self.orbits, self.starts))
        return xr.Dataset(shares | along("reason", reasons), names, described("Proved periodic responses"))

    def __str__(self) -> str:
        text = f"{self.orbits.of} periodic responses; orbits proved: {self.orbits}; initial states proved: {self.starts}"
        return text + "".join(f"; {count} not proved: {reason}" for reason, count in self.reasons.items())
