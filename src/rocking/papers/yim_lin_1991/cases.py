"""The motions that the paper shows, and how many of their cycles we show."""

from __future__ import annotations

from attrs import frozen

import rocking as rk


@frozen
class Case:
    """One of the paper's motions: the system, its start, and the forcing cycles shown, counted from the start."""

    name: str
    system: rk.System
    shown: tuple[int, int]
    start: rk.State = rk.State()

    def motion(self) -> rk.Motion:
        """The motion up to the last cycle shown."""
        return rk.simulate(self.system, self.start, cycles=self.shown[1])

    @property
    def parameters(self) -> str:
        """Amplitude, period and restitution; the start where it is not rest at phase 0."""
        forcing, velocity = self.system.forcing, self.start.velocity
        text = f"$A = {forcing.amplitude:g}$, $T = {forcing.period:g}$, $e = {self.system.restitution:g}$"
        return text if self.start == rk.State() else text + f",\n$\\Theta'_0 = {velocity:g}$, $\\varphi = {forcing.phase:g}$"

    @property
    def title(self) -> str:
        """Name, parameters and cycles shown."""
        return f"{self.name}\n{self.parameters}, {cycles(self.shown)}"


def cycles(shown: tuple[int, int]) -> str:
    """The cycles shown, in words."""
    return "cycles {}–{}".format(*shown)


def _system(amplitude: float, period: float, restitution: float, phase: float = 0.0) -> rk.System:
    return rk.System(rk.Harmonic(amplitude, period=period, phase=phase), restitution)


PERIODIC = (
    Case("mode (1, 1)", _system(2.0, 1.0, 0.925), shown=(200, 210)),
    Case("mode (1, 3)", _system(6.5, 0.4, 0.925), shown=(600, 624)),
    Case("mode (2, 10), unsymmetric", _system(5.5, 0.5, 0.925, phase=1.8), (600, 630), rk.State(velocity=0.15)),
)
OVERTURNING = Case("overturning", _system(1.75, 2.0, 0.95), shown=(0, 20))
QUASI_PERIODIC = Case("quasi-periodic", _system(4.0, 0.4, 1.0), shown=(0, 300))
CHAOTIC = Case("chaotic", _system(2.0, 0.4, 1.0), shown=(0, 300))
