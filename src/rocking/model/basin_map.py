"""Result of `basin_map`: attractors, their basins and the uncertainty exponents of the boundaries."""

from __future__ import annotations

from typing import TYPE_CHECKING

from attrs import field, frozen

from rocking.model.binomial_share import Share
from rocking.model.classification import Kind
from rocking.model.notebook_renderers import NotebookPicture
from rocking.model.orbit import Orbit
from rocking.model.system import System
from rocking.model.verdict import Verdict

if TYPE_CHECKING:
    import xarray as xr


# With a lower end of the interval below this value, both a smooth and a fractal boundary are possible.
SMOOTH_FROM = 0.9


@frozen
class Attractor:
    """Attractor of a basin map, or another outcome such as overturning.

    Attributes
    ----------
    name : str
        Unique name within the map, such as "period 1, asymmetric (a)".
    verdict : Verdict
        Verdict, with its evidence, of one initial state of the basin. `verdict.start` is this state.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9)
    >>> found = rk.basin_map(system, angle=[0.0, 0.1], velocity=[0.0, 0.1], boundary_runs=0)
    >>> print(found.attractors[0])
    rest
    """

    name: str
    verdict: Verdict = field(repr=False)

    @property
    def kind(self) -> Kind:
        """Response type. Overturning is listed as well, although it is not an attractor."""
        return self.verdict.kind

    @property
    def orbit(self) -> Orbit | None:
        """Periodic orbit; None if the response is not periodic."""
        return self.verdict.orbit

    def __str__(self) -> str:
        return self.name


@frozen
class UncertaintyExponent:
    """Uncertainty exponent of a basin boundary: f ~ ε^value.

    f is the fraction of uncertain initial states, and ε is the uncertainty of the initial state. The exponent is 1
    for a smooth boundary in the plane. It is below 1 for a fractal boundary, of box dimension 2 − value.

    Attributes
    ----------
    value : float
        Uncertainty exponent.
    low, high : float
        Ends of its 95 % confidence interval.
    distances : tuple of float
        Uncertainties ε, in the units of Θ and Θ'.
    uncertain : tuple of Share
        Fraction of uncertain initial states for each ε. A random initial state is uncertain if one of two states, at
        distance ε on opposite sides in a random direction, leads to another attractor.
    misfit : float
        χ² per degree of freedom of the power law, about 1 if it holds. If it is larger, the interval is wider by
        its square root.

    References
    ----------
    McDonald, Grebogi, Ott & Yorke, Physica D 17, 125–153 (1985).

    Examples
    --------
    >>> exponent = UncertaintyExponent(0.85, 0.72, 0.98, distances=(), uncertain=(), misfit=1.0)
    >>> print(exponent)
    0.850 (0.720–0.980)
    >>> exponent.fractal, exponent.meaning
    (True, 'below 1: fractal')
    """

    value: float
    low: float
    high: float
    distances: tuple[float, ...] = field(repr=False)
    uncertain: tuple[Share, ...] = field(repr=False)
    misfit: float = field(repr=False)

    @property
    def fractal(self) -> bool:
        """True if the whole interval lies below 1, the exponent of a smooth boundary."""
        return self.high < 1.0

    @property
    def smooth(self) -> bool:
        """True if the interval contains 1 and begins at 0.9 or above: this excludes box dimensions above 1.1."""
        return SMOOTH_FROM <= self.low <= 1.0 <= self.high

    @property
    def meaning(self) -> str:
        """Conclusion from the interval: fractal, smooth or undecided."""
        if self.fractal:
            return "below 1: fractal"
        if self.smooth:
            return f"contains 1, not below {SMOOTH_FROM:g}: smooth"
        where = "contains 1" if self.low <= 1.0 else "lies above 1"
        return f"undecided: {self.low:.2f}–{self.high:.2f} {where}"

    def __str__(self) -> str:
        return f"{self.value:.3f} ({self.low:.3f}–{self.high:.3f})"


@frozen(eq=False)
class BasinMap(NotebookPicture):
    """Basins of attraction of a system over a grid or a random sample of initial states; returned by `basin_map`.

    Attributes
    ----------
    system : System
        System of the map.
    dataset : xarray.Dataset
        Variables over the initial states: `attractor` (index into `attractors`), `kind`, `evidence`,
        `response_period`, `impacts_per_period`, `brace_hits_per_period`, `symmetric`, `orbit_angle` and
        `orbit_velocity` (the state that represents the orbit), `mean_angle` and `mean_angle_error` (mean over the
        section, for chaotic responses), `transient`, `cycles`.
    attractors : tuple of Attractor
        Attractors, that of the largest basin first.
    fractions : tuple of Share
        Fraction of the initial states in each basin, in the same order.
    uncertainty_exponent : UncertaintyExponent or None
        Exponent of the boundary between initial states that overturn and those that do not. None if there is no
        such boundary, or if it was not estimated.
    attractor_exponent : UncertaintyExponent or None
        Exponent of the boundaries between all basins. None likewise.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9)
    >>> print(rk.basin_map(system, angle=[0.0, 0.1], velocity=[0.0, 0.1], boundary_runs=0))
    4 initial states: rest 50.0 % (15.0–85.0 %), period 1, symmetric 50.0 % (15.0–85.0 %)
    """

    system: System
    dataset: xr.Dataset = field(repr=False)
    attractors: tuple[Attractor, ...]
    fractions: tuple[Share, ...]
    uncertainty_exponent: UncertaintyExponent | None
    attractor_exponent: UncertaintyExponent | None

    @property
    def safe(self) -> Share:
        """Safe fraction: the fraction of initial states that do not overturn."""
        pairs = list(zip(self.attractors, self.fractions, strict=True))
        fallen = sum(share.count for each, share in pairs if each.kind is Kind.OVERTURNED)
        of = self.fractions[0].of
        return Share(of - fallen, of)

    def __str__(self) -> str:
        parts = (f"{each.name} {share}" for each, share in zip(self.attractors, self.fractions, strict=True))
        text = f"{self.fractions[0].of:,} initial states: {', '.join(parts)}"
        exponent = self.uncertainty_exponent
        return (
            text
            if exponent is None
            else f"{text}; uncertainty exponent of the overturning boundary {exponent}"
        )
