"""The motions that the paper shows, and how many of their cycles we show."""

from __future__ import annotations

from attrs import frozen

import rocking as rk

REST = rk.State()


@frozen
class Case:
    """One of the paper's motions: the system, its start, and the forcing cycles shown, counted from the start."""

    name: str
    system: rk.System
    shown: tuple[int, int]
    start: rk.State = REST

    def motion(self) -> rk.Motion:
        """The motion up to the last cycle shown."""
        return rk.simulate(self.system, self.start, cycles=self.shown[1])

    @property
    def parameters(self) -> str:
        """Amplitude, period and restitution; the start where it is not rest at phase 0."""
        forcing, velocity = self.system.forcing, self.start.velocity
        text = f"$A = {forcing.amplitude:g}$, $T = {forcing.period:g}$, $e = {self.system.restitution:g}$"
        start = rf"$\Theta'(0) = {velocity:g}$, $\varphi = {forcing.phase:g}$"
        return text if self.start == REST else f"{text}\n{start}"

    @property
    def title(self) -> str:
        """Name and cycles shown, and below them the parameters."""
        return f"{self.name}, {cycles(self.shown)}\n{self.parameters}"


def cycles(shown: tuple[int, int]) -> str:
    """The cycles shown, in words."""
    first, last = shown
    return f"cycles {first}–{last}"


def _system(amplitude: float, period: float, restitution: float, phase: float = 0.0) -> rk.System:
    return rk.System(rk.Harmonic(amplitude, period=period, phase=phase), restitution)


PERIODIC = (
    Case("mode (1, 1)", _system(2.0, 1.0, 0.925), shown=(200, 210)),
    Case("mode (1, 3)", _system(6.5, 0.4, 0.925), shown=(600, 624)),
    Case("mode (2, 10)", _system(5.5, 0.5, 0.925, phase=1.8), (600, 630), rk.State(velocity=0.15)),
)
OVERTURNING = Case("overturning", _system(1.75, 2.0, 0.95), shown=(0, 20))
QUASI_PERIODIC = Case("quasi-periodic", _system(4.0, 0.4, 1.0), shown=(0, 120))
CHAOTIC = Case("chaotic", _system(2.0, 0.4, 1.0), shown=(0, 120))
BRACED = rk.System(
    rk.Harmonic(15.0, period=2.0), restitution=0.925, braces=rk.Braces(angle=1.0, restitution=1.0)
)
