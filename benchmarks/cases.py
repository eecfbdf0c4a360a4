"""Three motions that every engine computes: two periodic ones and a chaotic one, all from rest at phase 0."""

from math import cos, cosh, pi, sin, sinh
from typing import NamedTuple


class Case(NamedTuple):
    """Harmonic case in normalised values (frequency and period in units of τ)."""

    name: str
    amplitude: float
    period: float
    restitution: float
    tangent_cycles: (
        int  # in these a tangent vector grows or shrinks by at most e^650, within the range of floats
    )

    @property
    def frequency(self):
        return 2 * pi / self.period


class Point(NamedTuple):
    """State of the block at a time, from which a general integrator can start."""

    time: float
    angle: float
    velocity: float


CASES = (
    Case("(1,1)  A=2 T=1 e=.925", 2.0, 1.0, 0.925, 4_000),
    Case("(1,3)  A=6.5 T=.4 e=.925", 6.5, 0.4, 0.925, 12_000),
    Case("chaos  A=10.103 T=1.721 e=.8", 10.103037, 1.721328, 0.8, 5_000),
)


def lift_off(case, time):
    """State at `time` of the arc that leaves rest at time 0 (to the side −1).

    A general integrator cannot find the first crossing of an arc that starts on Θ = 0 with Θ' = 0. So the peers
    start later, from the closed form (Yim & Lin 1991, eq. 5).
    """
    beta, x = case.amplitude / (1 + case.frequency**2), case.frequency * time
    height = 1 - cosh(time) - beta * (cos(x) - cosh(time))
    speed = -sinh(time) + beta * (case.frequency * sin(x) + sinh(time))
    return Point(time, -height, -speed)
