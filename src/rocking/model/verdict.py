"""What a response is, and how that is known."""

from __future__ import annotations

import math
from collections.abc import Callable
from operator import itemgetter
from typing import Any

from attrs import evolve, field, frozen

from rocking.model.classification import Kind
from rocking.model.forcing import MAX_PHASE
from rocking.model.formatting import counted
from rocking.model.notebook_renderers import NotebookPicture
from rocking.model.orbit_event import OrbitEvent
from rocking.model.orbit_stability import Stability, stability_of
from rocking.model.system import NO_BRACES, State, System, quantities
from rocking.model.validation import within

# An event this near after an instant, in forcing periods, is at that instant: rounding must not put it on the other side.
SAME_INSTANT = 1e-12


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
    tolerances: dict[str, float] = field(hash=False)
    cycles: int

    def __str__(self) -> str:
        return self.shown


@frozen
class Orbit:
    """A periodic orbit; found by `find_orbit`, `find_orbits`, `classify` and along a `Branch`.

    `simulate(orbit.system, orbit.start)` runs along it, and `orbit.motion()` is that run.

    Attributes
    ----------
    system : System
        The system it belongs to, as it was passed in.
    state : State
        Its state on the section at the forcing phase `phase`, which is usually not the forcing's own: `start` is the state there.
    phase : float
        Forcing phase ψ of the section that `state` lies on, rad in [0, 2π). It is chosen away from all events.
    period : int
        Forcing cycles after which it repeats itself.
    symmetric : bool
        Whether half a period later it is its own mirror image.
    impacts, brace_hits : int or None
        Impacts at Θ = 0 and hits on the braces in a period; None where infinitely many come before rest or leaning.
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
    _simulate: Callable[..., Any] = field(repr=False, eq=False)
    _events: tuple[OrbitEvent, ...] = field(default=(), repr=False, eq=False)
    _grazes: bool = field(default=False, repr=False, eq=False)

    @property
    def start(self) -> State:
        """The state at the system's own forcing phase, at τ = 0: a motion from it is this orbit."""
        return self.at(self.system.forcing.phase)

    def at(self, phase: float) -> State:
        """Give the state of the orbit at a forcing phase.

        It is marched from the nearest event of the orbit, forward or backward in time. So it lies on the orbit
        even where a run leaves the orbit within one period.

        Parameters
        ----------
        phase : float
            Forcing phase ψ, rad. It counts on from `start`, so that 2π more is one forcing cycle later.

        Returns
        -------
        State
            Just after any event at that instant.

        Raises
        ------
        TypeError, ValueError
            For a phase that is no number in [-1000, 1000].

        Examples
        --------
        >>> import math
        >>> import rocking as rk
        >>> orbit = rk.classify(rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)).orbit
        >>> here, later = orbit.at(0.5), orbit.at(0.5 + math.pi)  # a symmetric orbit
        >>> abs(here.angle + later.angle) < 1e-12
        True
        """
        forcing = self.system.forcing
        phase = within("phase", phase, -MAX_PHASE, MAX_PHASE)
        whole, hair = math.tau * self.period, math.tau * SAME_INSTANT
        turned = ((forcing.phase - self.phase) % math.tau + (phase - forcing.phase) % whole) % whole
        if not self._events:
            return self._marched(self.phase, self.state, turned)
        since, last = min(
            (((turned + hair - one.turned) % whole, one) for one in self._events), key=itemgetter(0)
        )
        until, following = min(
            (((one.turned - turned - hair) % whole, one) for one in self._events), key=itemgetter(0)
        )
        if since <= until:
            return self._marched(
                self.phase + last.turned, State(last.angle, last.after), max(since - hair, 0.0)
            )
        # backward in time the base has the opposite phase, and velocities change their sign
        there = State(following.angle, -following.before)
        state = self._marched(-self.phase - following.turned, there, until + hair)
        return State(state.angle, -state.velocity)

    def _marched(self, phase: float, state: State, turned: float) -> State:
        """Return what a state at one forcing phase becomes, that much of the phase later."""
        forcing = self.system.forcing
        time = turned / forcing.frequency
        begun = evolve(self.system, forcing=evolve(forcing, phase=phase % math.tau))
        motion = self._simulate(begun, state, cycles=int(turned // math.tau) + 1)
        events = motion.events["time"]
        there = events[(events > time) & (events <= time + SAME_INSTANT * forcing.period)]
        angle, velocity = motion.at(min(there[-1] if len(there) else time, motion.duration))
        return State(float(angle), float(velocity))

    def motion(self, cycles: int | None = None, record: str = "all") -> Any:
        """Simulate the orbit from `start`.

        A motion near an unstable orbit leaves it: rounding grows by |multiplier| in each period. `at` gives the
        states of the orbit itself.

        Parameters
        ----------
        cycles : int, optional
            Forcing cycles to run; one period by default.
        record : {"all", "section", "none"}
            As in `simulate`.

        Returns
        -------
        Motion

        Raises
        ------
        TypeError, ValueError
            As `simulate`.

        Examples
        --------
        >>> import rocking as rk
        >>> orbit = rk.classify(rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)).orbit
        >>> orbit.motion().impacts == orbit.impacts
        True
        """
        return self._simulate(self.system, self.start, self.period if cycles is None else cycles, record)

    @property
    def stability(self) -> Stability:
        """Whether neighbouring motions approach the orbit, leave it or, where it loses nothing, do neither."""
        trace, determinant = sum(self.multipliers).real, self._determinant
        if self.symmetric:
            # That of half the orbit, squared, less twice its determinant: only the upper bound can be reached.
            trace = max(trace, 0.0)
        return stability_of(trace, determinant)

    @property
    def superstable(self) -> bool:
        """Whether both multipliers are zero, because the block rests or leans in every period."""
        return self.multipliers == (0j, 0j)

    @property
    def stable(self) -> bool:
        """Whether both multipliers lie inside the unit circle, so that neighbouring motions approach the orbit."""
        return self.stability is Stability.STABLE

    @property
    def _determinant(self) -> float:
        """The product of the multipliers, from the events alone: exactly 1 where nothing is lost."""
        if self.impacts is None or self.brace_hits is None or self.multipliers == (0j, 0j):
            return 0.0
        system = NO_BRACES | quantities(self.system)
        return float(
            system["restitution"] ** (2 * self.impacts) * system["brace_restitution"] ** (2 * self.brace_hits)
        )

    def __str__(self) -> str:
        symmetry = "symmetric" if self.symmetric else "unsymmetric"
        impacts = "infinitely many impacts" if self.impacts is None else counted(self.impacts, "impact")
        return f"{symmetry} orbit of period {self.period} with {impacts}"


@frozen
class Verdict(NotebookPicture):
    """What a response is, with its evidence; made by `classify`.

    What does not apply is None. What describes an orbit (`period` to `multipliers`, `orbit`) is known of periodic responses
    alone.

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
        Impacts at Θ = 0 and hits on the braces in that period; None where infinitely many come before the block rests or
        leans.
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
