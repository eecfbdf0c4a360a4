"""Motions shown in the paper, and the cycles shown here."""

from __future__ import annotations

from attrs import frozen

import rocking as rk
from rocking.motion.motion import Motion

REST = rk.State()


@frozen
class Case:
    """Motion of the paper: the system, its initial state, and the forcing cycles shown, counted from the start."""

    name: str
    system: rk.System
    shown: tuple[int, int]
    start: rk.State = REST

    def motion(self) -> Motion:
        """Simulate the motion up to the last cycle shown."""
        return rk.simulate(self.system, self.start, cycles=self.shown[1])


def _system(amplitude: float, period: float, restitution: float, phase: float = 0.0) -> rk.System:
    return rk.System(rk.Harmonic(amplitude, period=period, phase=phase), restitution)


PERIODIC = (
    Case("harmonic (1, 1) mode", _system(2.0, 1.0, 0.925), shown=(200, 210)),
    Case("subharmonic (1, 3) mode", _system(6.5, 0.4, 0.925), shown=(600, 624)),
    Case("asymmetric (2, 10) mode", _system(5.5, 0.5, 0.925, phase=1.8), (600, 630), rk.State(velocity=0.15)),
)
OVERTURNING = Case("overturning", _system(1.75, 2.0, 0.95), shown=(0, 20))
QUASI_PERIODIC = Case("quasi-periodic", _system(4.0, 0.4, 1.0), shown=(0, 120))
CHAOTIC = Case("chaotic", _system(2.0, 0.4, 1.0), shown=(0, 120))
BRACED = rk.System(
    rk.Harmonic(15.0, period=2.0), restitution=0.925, braces=rk.Braces(angle=1.0, restitution=1.0)
)
