"""Symmetric mode: a periodic response in closed form."""

from __future__ import annotations

from attrs import frozen

from rocking.model.forcing import Harmonic
from rocking.model.orbit_stability import Stability, stability_of
from rocking.model.system import State, System


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
