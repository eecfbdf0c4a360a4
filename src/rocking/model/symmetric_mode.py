"""A symmetric mode: a periodic response that is known in closed form."""

from __future__ import annotations

from attrs import frozen

from rocking.model.forcing import Harmonic
from rocking.model.orbit_stability import Stability, stability_of
from rocking.model.system import State, System


@frozen
class Mode:
    """A symmetric (1, n) mode: one rocking cycle, two impacts, in n forcing cycles (eqs 8-10 of Yim & Lin 1991).

    Made by `theory.symmetric_modes`. It leaves the base to the positive side with `velocity` when the forcing's phase is
    `phase`, strikes again n half periods later, and does the same on the other side.

    Attributes
    ----------
    amplitude, period, restitution : float
        A, T and e of the system.
    n : int
        Forcing cycles in a response; odd.
    velocity : float
        V, Θ' just after the impact onto the positive side.
    phase : float
        φ, forcing phase at that impact, rad in (−π, π].
    trace : float
        Of the half-cycle map, whose determinant is e²; infinite where it is beyond all numbers.
    half_multipliers : tuple of two complex
        Eigenvalues of the half-cycle map (from an impact to the next, mirrored), the larger first.
    multipliers : tuple of two complex
        Floquet multipliers over the whole response, n forcing cycles: the squares of the others.
    admissible : bool
        Whether the block keeps its side between the impacts; if not, there is no such motion.
    peak : float or None
        Largest Θ; None of an inadmissible mode.

    Examples
    --------
    >>> import rocking as rk
    >>> mode = rk.theory.symmetric_modes(2.0, 1.0, 0.925, 1)[0]
    >>> print(mode)
    (1,1) mode: V = 0.532017, φ = -1.67791, stable, admissible
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
        """The system, its forcing at the phase of the impact, so that a motion from `start` is this mode."""
        return System(Harmonic(self.amplitude, period=self.period, phase=self.phase), self.restitution)

    @property
    def start(self) -> State:
        """The state just after the impact onto the positive side."""
        return State(velocity=self.velocity)

    @property
    def stability(self) -> Stability:
        """Stable where |trace| < 1 + e², at e = 1 neutral there; unstable elsewhere."""
        return stability_of(self.trace, self.restitution**2)

    @property
    def stable(self) -> bool:
        """Whether both multipliers lie inside the unit circle; at e = 1 none does."""
        return self.stability is Stability.STABLE

    def __str__(self) -> str:
        admissible = "admissible" if self.admissible else "inadmissible"
        return f"(1,{self.n}) mode: V = {self.velocity:.6g}, φ = {self.phase:.6g}, {self.stability}, {admissible}"
