"""Gallery of systems: cases of Yim & Lin (1991), and cases beyond the paper."""

from __future__ import annotations

from attrs import frozen

from rocking.explorer.fields import Span
from rocking.explorer.harmonic_view import HarmonicView


@frozen
class Case:
    """Case of the gallery: name, group, title, a one-line description and its view."""

    name: str
    group: str
    title: str
    line: str
    view: HarmonicView


PAPER, BEYOND = "Yim & Lin 1991", "Beyond the paper"
CASES = (
    Case(
        "figure-2a",
        PAPER,
        "2a, 3a: (1, 1) mode",
        "Symmetric, two impacts per forcing cycle.",
        HarmonicView(2.0, 1.0, 0.925, first=200, cycles=10),
    ),
    Case(
        "figure-2b",
        PAPER,
        "2b, 3b: (1, 3) mode",
        "Symmetric, repeats after three forcing cycles.",
        HarmonicView(6.5, 0.4, 0.925, first=600, cycles=24),
    ),
    Case(
        "figure-2c",
        PAPER,
        "2c, 3c: (2, 10) mode",
        "Asymmetric, four impacts in ten forcing cycles.",
        HarmonicView(5.5, 0.5, 0.925, velocity=0.15, phase=1.8, first=600, cycles=30),
    ),
    Case(
        "figure-4",
        PAPER,
        "4: overturning",
        "Overturning is certain in the sixth cycle, after four impacts.",
        HarmonicView(1.75, 2.0, 0.95, cycles=20),
    ),
    Case(
        "figure-5",
        PAPER,
        "5: quasi-periodic",
        "Undamped (e = 1): three islands around the (1, 3) mode.",
        HarmonicView(4.0, 0.4, 1.0, cycles=60),
    ),
    Case(
        "figure-6",
        PAPER,
        "6: chaotic",
        "Undamped (e = 1): a chaotic sea with long sojourns near islands, no attractor.",
        HarmonicView(2.0, 0.4, 1.0, cycles=60),
    ),
    Case(
        "figure-11",
        PAPER,
        "11: map at e = 0.925",
        "Response types, with theoretical curves.",
        HarmonicView(2.0, 1.0, 0.925, curves=("symmetry-breaking-1", "symmetry-breaking-3", "melnikov")),
    ),
    Case(
        "figure-13a",
        PAPER,
        "13a: between braces",
        "Chaotic motion between elastic braces at Θ = ±1.",
        HarmonicView(
            15.0,
            2.0,
            0.925,
            brace_angle=1.0,
            first=100,
            cycles=30,
            angles=Span(-1.0, 1.0),
            velocities=Span(-3.0, 3.0),
        ),
    ),
    Case(
        "coexisting",
        BEYOND,
        "Coexisting attractors",
        "Basins of a period-1 and a period-3 orbit; all other initial states overturn.",
        HarmonicView(3.5, 1.0, 0.8, angles=Span(-1.0, 1.0), velocities=Span(-1.0, 1.0)),
    ),
    Case(
        "fractal",
        BEYOND,
        "Fractal basin boundary",
        "Above A*, the boundary between bounded and overturning motions has detail at every scale.",
        HarmonicView(
            5.0,
            1.0,
            0.8,
            curves=("melnikov", "heteroclinic"),
            angles=Span(-1.2, 1.2),
            velocities=Span(-1.2, 1.2),
            amplitudes=Span(2.0, 10.0),
            periods=Span(0.6, 1.4),
        ),
    ),
    Case(
        "cascade",
        BEYOND,
        "Period doublings to chaos",
        "Orbit diagram over A: periods 1, 2, 4, …, and a separate period-3 branch.",
        HarmonicView(
            10.103037, 1.721328, 0.8, first=200, amplitudes=Span(9.8, 10.9), periods=Span(1.6, 1.85)
        ),
    ),
    Case(
        "chaos-more-loss",
        BEYOND,
        "Chaos at e = 0.3",
        "Chaos is more common with strong than with weak dissipation.",
        HarmonicView(7.0, 1.15, 0.3, first=200),
    ),
    Case(
        "crisis",
        BEYOND,
        "Crisis at e = 0.99",
        "At A = 4.86 chaos ends, often after 10⁴ cycles or more; at A = 4.88 no end was observed.",
        HarmonicView(4.88, 0.33, 0.99, amplitudes=Span(4.7, 5.0), periods=Span(0.3, 0.36)),
    ),
)
BY_NAME = {case.name: case for case in CASES}
GROUPS = {group: [case for case in CASES if case.group == group] for group in (PAPER, BEYOND)}
