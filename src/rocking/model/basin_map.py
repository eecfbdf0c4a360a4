"""Which start leads where: what basin maps find."""

from __future__ import annotations

from typing import TYPE_CHECKING

from attrs import field, frozen

from rocking.model.binomial_share import Share
from rocking.model.classification import Kind
from rocking.model.notebook_renderers import NotebookPicture
from rocking.model.system import System
from rocking.model.verdict import Orbit, Verdict

if TYPE_CHECKING:
    import xarray as xr


# An interval that begins lower leaves both a smooth and a fractal boundary possible.
SMOOTH_FROM = 0.9


@frozen
class Attractor:
    """What some of the starts lead to.

    Attributes
    ----------
    name : str
        Its own among those of the map, such as "period 1, unsymmetric (a)".
    verdict : Verdict
        Of one of those starts, with its evidence; `verdict.start` is that start.
    """

    name: str
    verdict: Verdict = field(repr=False)

    @property
    def kind(self) -> Kind:
        """What it is; overturning is no attractor, but where those starts lead."""
        return self.verdict.kind

    @property
    def orbit(self) -> Orbit | None:
        """The orbit, of a periodic one."""
        return self.verdict.orbit

    def __str__(self) -> str:
        return self.name


@frozen
class UncertaintyExponent:
    """How fast the share f of uncertain starts falls with the uncertainty ε of the start: f ~ ε^value.

    1 for a smooth boundary of a plane region; below 1 for a fractal one, whose box dimension is 2 − value.

    Attributes
    ----------
    value, low, high : float
        The exponent and its 95 % interval.
    distances : tuple of float
        ε.
    uncertain : tuple of Share
        Of so many random starts, those of which one of the two at distance ε on either side, in a random direction, leads
        elsewhere.
    misfit : float
        χ² of the power law over its degrees of freedom: about 1 where it holds; where it is larger the interval is
        wider by its square root.
    """

    value: float
    low: float
    high: float
    distances: tuple[float, ...] = field(repr=False)
    uncertain: tuple[Share, ...] = field(repr=False)
    misfit: float = field(repr=False)

    @property
    def fractal(self) -> bool:
        """Whether the whole interval lies below 1, the exponent of a smooth boundary."""
        return self.high < 1.0

    @property
    def smooth(self) -> bool:
        """Whether the interval holds 1 and begins at 0.9 or above: no fractal boundary of a dimension above 1.1 is left."""
        return SMOOTH_FROM <= self.low <= 1.0 <= self.high

    @property
    def meaning(self) -> str:
        """What the interval says of the boundary; a wide one that contains 1, or one above 1, decides nothing."""
        if self.fractal:
            return "below 1: fractal"
        if self.smooth:
            return f"1, and not below {SMOOTH_FROM:g}: smooth"
        where = "contains 1" if self.low <= 1.0 else "lies above 1"
        return f"undecided: {self.low:.2f}–{self.high:.2f} {where}"

    def __str__(self) -> str:
        return f"{self.value:.3f} ({self.low:.3f}–{self.high:.3f})"


@frozen(eq=False)
class BasinMap(NotebookPicture):
    """Which start leads where; made by `basin_map`.

    Attributes
    ----------
    system : System
        What was started.
    dataset : xarray.Dataset
        Over the starts: `attractor` (a place in `attractors`), `kind`, `evidence`, `response_period`,
        `impacts_per_period`, `brace_hits_per_period`, `symmetric`, `orbit_angle`, `orbit_velocity` (the state that stands
        for the orbit), `mean_angle`, `mean_angle_error` (on the section, of what is chaotic), `transient`, `cycles`.
    attractors : tuple of Attractor
        What the starts lead to, the largest share first.
    fractions : tuple of Share
        The shares of the starts that lead there, in the same order.
    uncertainty_exponent : UncertaintyExponent or None
        Of the boundary between starts that overturn and those that do not; None where there is none to be seen.
    attractor_exponent : UncertaintyExponent or None
        Of the boundaries between all that the starts lead to.
    """

    system: System
    dataset: xr.Dataset = field(repr=False)
    attractors: tuple[Attractor, ...]
    fractions: tuple[Share, ...]
    uncertainty_exponent: UncertaintyExponent | None
    attractor_exponent: UncertaintyExponent | None

    @property
    def safe(self) -> Share:
        """The share of starts that do not overturn."""
        pairs = list(zip(self.attractors, self.fractions, strict=True))
        fallen = sum(share.count for each, share in pairs if each.kind is Kind.OVERTURNED)
        of = self.fractions[0].of
        return Share(of - fallen, of)

    def __str__(self) -> str:
        parts = (f"{each.name} {share}" for each, share in zip(self.attractors, self.fractions, strict=True))
        text = f"{self.fractions[0].of:,} starts: {', '.join(parts)}"
        exponent = self.uncertainty_exponent
        return text if exponent is None else f"{text}; boundary of overturning: exponent {exponent}"
