"""Periodic orbit: its events, states and stability; symmetric modes in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from enum import StrEnum
from operator import itemgetter
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import evolve, field, frozen

from rocking.model.forcing import Harmonic
from rocking.model.proof import Proof
from rocking.model.quantity import PHASE
from rocking.model.result import Result, described
from rocking.model.system import NO_BRACES, State, System, quantities
from rocking.model.text import counted

if TYPE_CHECKING:
    import xarray as xr


@frozen
class OrbitEvent:
    """State of an orbit at an instant where its velocity may jump, accurate to rounding even on an unstable orbit."""

    turned: float
    """Forcing phase, rad, from the orbit's `state` to the event."""
    angle: float
    before: float
    """Θ' just before the event."""
    after: float


class Stability(StrEnum):
    """Linear stability of a periodic orbit: a string, one of three.

    An orbit is "stable" if nearby motions converge to it, and "unstable" if some of them diverge exponentially. It is
    "neutral" if neither holds: the orbit dissipates no energy, and both multipliers lie on the unit circle.

    Examples
    --------
    >>> import rocking as rk
    >>> [str(rk.theory.symmetric_modes(2.0, 1.0, e, 1)[0].stability) for e in (0.925, 1.0)]
    ['stable', 'neutral']
    """

    STABLE = "stable"
    NEUTRAL = "neutral"
    UNSTABLE = "unstable"


def stability_of(trace: float, determinant: float) -> Stability:
    """Return the stability of a fixed point of a plane map from the trace and the determinant of its Jacobian.

    Both eigenvalues lie inside the unit circle if |trace| < 1 + determinant and determinant < 1. A determinant of
    exactly 1 means that no event dissipates energy. Then |trace| < 2 puts both eigenvalues on the unit circle, although
    their computed moduli may differ from 1 by rounding.
    """
    if not abs(trace) < 1.0 + determinant:
        return Stability.UNSTABLE
    return Stability.NEUTRAL if determinant == 1.0 else Stability.STABLE


@frozen
class Mode:
    """Symmetric (1, n) mode: one rocking cycle, with two impacts, in n forcing cycles; returned by `theory.symmetric_modes`.

    The block leaves the base to the positive side with `velocity` when the forcing phase is `phase`. The next impact is
    n half periods later, and the motion on the other side is its mirror image: Yim & Lin (1991), Eqs. (8)–(10).

    Attributes
    ----------
    amplitude, period, restitution : float
        A, T and e of the system.
    n : int
        Number of forcing cycles per response period; odd.
    velocity : float
        V = Θ' just after the impact from which the block moves to the positive side.
    phase : float
        Forcing phase φ at that impact, rad, in (−π, π].
    trace : float
        Trace of the half-cycle map, whose determinant is e²; infinite on overflow.
    half_multipliers : tuple of two complex
        Half-cycle multipliers, the larger first: eigenvalues of the map from an impact to the next, mirrored.
    multipliers : tuple of two complex
        Floquet multipliers over the response period of n forcing cycles: the squares of the half-cycle multipliers.
    admissible : bool
        True if the block does not pass through Θ = 0 between the impacts. An inadmissible mode is not a motion.
    peak : float or None
        Largest Θ; None if inadmissible.

    References
    ----------
    Spanos & Koh, J. Eng. Mech. 110, 1627–1642 (1984).

    Examples
    --------
    >>> import rocking as rk
    >>> mode = rk.theory.symmetric_modes(2.0, 1.0, 0.925, 1)[0]
    >>> print(mode)
    (1, 1) mode: V = 0.532017, φ = -1.67791, stable, admissible
    >>> rk.classify(mode.system, mode.start).impacts_per_period
    2
    """

    amplitude: float
    period: float
    restitution: float
    n: int
    velocity: float
    phase: float
    trace: float
    half_multipliers: tuple[complex, complex]
    multipliers: tuple[complex, complex]
    admissible: bool
    peak: float | None

    @property
    def system(self) -> System:
        """System whose forcing starts at the phase of the impact, so that a motion from `start` is this mode."""
        return System(Harmonic(self.amplitude, period=self.period, phase=self.phase), self.restitution)

    @property
    def start(self) -> State:
        """State just after the impact from which the block moves to the positive side."""
        return State(velocity=self.velocity)

    @property
    def stability(self) -> Stability:
        """Stability: stable if |trace| < 1 + e² (neutral if e = 1), else unstable."""
        return stability_of(self.trace, self.restitution**2)

    @property
    def stable(self) -> bool:
        """True if both multipliers lie inside the unit circle; always False for e = 1."""
        return self.stability is Stability.STABLE

    def __str__(self) -> str:
        admissible = "admissible" if self.admissible else "inadmissible"
        return f"(1, {self.n}) mode: V = {self.velocity:.6g}, φ = {self.phase:.6g}, {self.stability}, {admissible}"


# An event within this time after an instant, in forcing periods, counts as at that instant, to be safe from rounding.
SAME_INSTANT = 1e-12


ORBIT_TEXTS: dict[str, tuple[str, str, Any]] = {
    "orbit_period": ("forcing cycles per response period", "1", int),
    "symmetric": ("whether the orbit is its own mirror image", "", bool),
    "impacts_per_period": ("impacts per period; -1 if infinitely many", "1", int),
    "brace_hits_per_period": ("brace impacts per period; -1 if infinitely many", "1", int),
    "stability": ("stability", "", "U8"),
    "multiplier_1_real": ("Floquet multiplier 1, real part", "1", float),
    "multiplier_1_imag": ("Floquet multiplier 1, imaginary part", "1", float),
    "multiplier_2_real": ("Floquet multiplier 2, real part", "1", float),
    "multiplier_2_imag": ("Floquet multiplier 2, imaginary part", "1", float),
    "start_angle": ("angle at time 0", "1", float),
    "start_velocity": ("angular velocity at time 0", "1", float),
    "section_phase": ("forcing phase of the section", "rad", float),
    "section_angle": ("angle at the section", "1", float),
    "section_velocity": ("angular velocity at the section", "1", float),
    "residual": ("distance between the states at the section and one period later", "1", float),
}
"""Description, unit and type of each fact on an orbit in datasets."""


def facts_of(orbit: Orbit) -> dict[str, Any]:
    """Return the facts on an orbit by name; None stands for infinitely many impacts."""
    larger, smaller = orbit.multipliers
    return {
        "orbit_period": orbit.period,
        "symmetric": orbit.symmetric,
        "impacts_per_period": orbit.impacts,
        "brace_hits_per_period": orbit.brace_hits,
        "stability": str(orbit.stability),
        "multiplier_1_real": larger.real,
        "multiplier_1_imag": larger.imag,
        "multiplier_2_real": smaller.real,
        "multiplier_2_imag": smaller.imag,
        "section_phase": orbit.phase,
        "section_angle": orbit.state.angle,
        "section_velocity": orbit.state.velocity,
        "residual": orbit.residual,
    }


def start_of(orbit: Orbit) -> dict[str, float]:
    """Return the state of an orbit at τ = 0 by name."""
    start = orbit.start
    return {"start_angle": start.angle, "start_velocity": start.velocity}


def orbit_columns(
    orbits: Sequence[Orbit], prefix: str = "", *, start: bool = False
) -> dict[str, tuple[Any, ...]]:
    """Return columns of facts on orbits, at τ = 0 only with `start`; -1 stands for infinitely many impacts."""
    rows = [facts_of(each) | (start_of(each) if start else {}) for each in orbits]
    return {
        f"{prefix}{name}": (
            np.array([-1 if row[name] is None else row[name] for row in rows], kind),
            text,
            unit,
        )
        for name, (text, unit, kind) in ORBIT_TEXTS.items()
        if start or not name.startswith("start_")
    }


def multiplier_columns(values: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
    """Return Floquet multipliers, shape (n, 2), as columns of real and imaginary parts: netCDF has no complex numbers."""
    return {
        f"multiplier_{number}_{part}": (getattr(column, part), f"Floquet multiplier {number}, {text}")
        for number, column in enumerate(values.T, 1)
        for part, text in (("real", "real part"), ("imag", "imaginary part"))
    }


@frozen
class Orbit(Result):
    """Periodic orbit; found by `find_orbit`, `find_orbits`, `classify` and along a `Branch`.

    `orbit.motion()` simulates it, as does `simulate(orbit.system, orbit.start)`.

    Attributes
    ----------
    system : System
        System of the orbit, as it was passed.
    state : State
        State on the section at the forcing phase `phase`. This is usually not the phase of the forcing at τ = 0; `start`
        is the state there.
    phase : float
        Forcing phase ψ of the section of `state`, rad, in [0, 2π). It is chosen away from all events.
    period : int
        Number of forcing cycles per response period.
    symmetric : bool
        True if the orbit is its own mirror image half a period later.
    impacts, brace_hits : int or None
        Number of impacts at Θ = 0 and on the braces per period. None if infinitely many precede rest or sustained
        contact with a brace (complete chattering).
    multipliers : tuple of two complex
        Floquet multipliers over one response period, the larger first.
    residual : float
        Distance between `state` and the state one period later.
    proof : Proof or None
        Proof of the orbit by `prove`; None without one.

    Examples
    --------
    >>> import rocking as rk
    >>> orbit = rk.classify(rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)).orbit
    >>> print(orbit)
    symmetric orbit of period 1 with 2 impacts
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
    proof: Proof | None = field(default=None, repr=False, eq=False)

    def _data(self) -> xr.Dataset:
        import xarray as xr

        proof = (
            {} if self.proof is None else {f"proof_{name}": each for name, each in self.proof.facts.items()}
        )
        facts = quantities(self.system) | facts_of(self) | start_of(self) | proof
        return xr.Dataset(attrs=described("Periodic orbit") | facts)

    @property
    def start(self) -> State:
        """State at τ = 0, at the forcing phase of the system itself: a motion from this state is the orbit."""
        return self.at(self.system.periodic.phase)

    def at(self, phase: float) -> State:
        """Return the state of the orbit at a forcing phase.

        The state is computed from the nearest event of the orbit, forward or backward in time. It therefore lies on the
        orbit even if the orbit is so unstable that a simulation leaves it within one period.

        Parameters
        ----------
        phase : float
            Forcing phase ψ in radians, in [-1000, 1000]. It continues from `start`: an increase by 2π is one forcing
            cycle.

        Returns
        -------
        State
            State at this phase, just after an event if there is one.

        Raises
        ------
        TypeError, ValueError
            If `phase` is not a real number in its range.

        Examples
        --------
        >>> import math
        >>> import rocking as rk
        >>> orbit = rk.classify(rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)).orbit
        >>> here, later = orbit.at(0.5), orbit.at(0.5 + math.pi)  # a symmetric orbit
        >>> abs(here.angle + later.angle) < 1e-12
        True
        """
        forcing = self.system.periodic
        phase = PHASE.checked(phase)
        whole = math.tau * self.period
        return self._after(
            ((forcing.phase - self.phase) % math.tau + (phase - forcing.phase) % whole) % whole
        )

    def _after(self, turned: float) -> State:
        """Return the state of the orbit after the forcing phase has advanced by `turned`, less than a period, from `state`."""
        whole, hair = math.tau * self.period, math.tau * SAME_INSTANT
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
        # Time reversal negates the forcing phase and the velocities.
        there = State(following.angle, -following.before)
        state = self._marched(-self.phase - following.turned, there, until + hair)
        return State(state.angle, -state.velocity)

    def _marched(self, phase: float, state: State, turned: float) -> State:
        """Return the state after the forcing phase has advanced by `turned` from `phase`."""
        forcing = self.system.periodic
        time = turned / forcing.frequency
        begun = evolve(self.system, forcing=evolve(forcing, phase=phase % math.tau))
        motion = self._simulate(begun, state, cycles=int(turned // math.tau) + 1)
        events = motion.events["time"]
        there = events[(events > time) & (events <= time + SAME_INSTANT * forcing.period)]
        angle, velocity = motion.at(min(there[-1] if len(there) else time, motion.duration))
        return State(float(angle), float(velocity))

    def motion(self, cycles: int | None = None, record: str = "all") -> Any:
        """Simulate the orbit from `start`.

        A simulated motion near an unstable orbit leaves it, because rounding errors grow by |multiplier| in each period.
        `at` returns states of the orbit itself.

        Parameters
        ----------
        cycles : int, optional
            Number of forcing cycles. Default: one response period.
        record : {"all", "section", "none"}
            Recorded data, as in `simulate`. Default: "all".

        Returns
        -------
        Motion
            Simulated motion.

        Raises
        ------
        TypeError, ValueError
            As in `simulate`.

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
        """Linear stability: stable, unstable or, without dissipation, neutral."""
        trace, determinant = sum(self.multipliers).real, self._determinant
        if self.symmetric:
            # With t and d of the half period, trace = t² − 2d ≥ −2d, so only the upper bound can be reached.
            trace = max(trace, 0.0)
        return stability_of(trace, determinant)

    @property
    def superstable(self) -> bool:
        """True if both multipliers are zero, because each period contains rest or sustained contact with a brace."""
        return self.multipliers == (0j, 0j)

    @property
    def stable(self) -> bool:
        """True if both multipliers lie inside the unit circle, so that nearby motions converge to the orbit."""
        return self.stability is Stability.STABLE

    @property
    def _determinant(self) -> float:
        """Product of the multipliers, computed from the number of impacts: exactly 1 without dissipation."""
        if self.impacts is None or self.brace_hits is None or self.multipliers == (0j, 0j):
            return 0.0
        system = NO_BRACES | quantities(self.system)
        return float(
            system["restitution"] ** (2 * self.impacts) * system["brace_restitution"] ** (2 * self.brace_hits)
        )

    def __str__(self) -> str:
        return orbit_in_words(self.symmetric, self.period, self.impacts, self.brace_hits)


def orbit_in_words(symmetric: bool, period: int, impacts: int | None, brace_hits: int | None) -> str:
    """Return symmetry, period and numbers of events of an orbit as text.

    Examples
    --------
    >>> orbit_in_words(False, 1, 2, 3), orbit_in_words(True, 3, None, None)
    ('asymmetric orbit of period 1 with 2 impacts and 3 brace impacts', 'symmetric orbit of period 3 with infinitely many impacts')
    """
    events = "infinitely many impacts" if impacts is None else counted(impacts, "impact")
    if brace_hits:
        events += f" and {counted(brace_hits, 'brace impact')}"
    return f"{'symmetric' if symmetric else 'asymmetric'} orbit of period {period} with {events}"
