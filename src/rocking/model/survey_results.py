"""What surveys that sum up find: a dataset with a line that says it, each made by the function of like name."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from attrs import field, frozen

from rocking.model.binomial_share import Share
from rocking.model.classification import Kind
from rocking.model.notebook_renderers import NotebookPicture
from rocking.model.system import State, System

if TYPE_CHECKING:
    import xarray as xr


@frozen(eq=False)
class SafeBasin(NotebookPicture):
    """The share of starts that do not overturn, over the amplitude; made by `safe_basin`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Over `amplitude`: `safe` with `safe_low` and `safe_high`, its 95 % interval, and `undetermined`, the share of those
        of which it is not known what they are; they count as safe.
    shares : tuple of Share
        The same shares, as counts.
    heteroclinic_amplitude, melnikov_amplitude : float
        A*, above which the boundary of the starts that overturn is fractal, exactly, and A_M, its first order; NaN between
        braces, for which neither is known.
    """

    dataset: xr.Dataset = field(repr=False)
    shares: tuple[Share, ...]
    heteroclinic_amplitude: float
    melnikov_amplitude: float

    def __str__(self) -> str:
        amplitudes = self.dataset.amplitude.values
        least = min(range(len(self.shares)), key=lambda k: self.shares[k].value)
        first, last = self.shares[0], self.shares[-1]
        told = (
            f"safe: {first} of {first.of:,} starts at A = {amplitudes[0]:.6g}, {last} at A = {amplitudes[-1]:.6g}, fewest "
            f"{self.shares[least]} at A = {amplitudes[least]:.6g}"
        )
        if np.isnan(self.heteroclinic_amplitude):
            return told
        return f"{told}; A* = {self.heteroclinic_amplitude:.6g}, A_M = {self.melnikov_amplitude:.6g}"


@frozen(eq=False)
class OverturningCurve(NotebookPicture):
    """The lowest amplitude that overturns the block from rest; made by `overturning_amplitude`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Over what varies of `period` (or `frequency`) and `restitution`: `lowest`, the lowest overturning amplitude found, NaN
        where none was; `resolution`, the distance to the amplitude scanned before it; `lowest_phase`, where it is;
        `survived_up_to`, the highest amplitude scanned up to which everything scanned survived; `surviving_above`, the share
        of the scanned amplitudes and phases above it that survive; and over the scanned `amplitude` too
        `overturning_share`, the share of the phases that overturn; over `phase` `changes`, how often the outcome changes along A.
        `heteroclinic_amplitude` is A*.
    """

    dataset: xr.Dataset = field(repr=False)

    def __str__(self) -> str:
        lowest, scanned = self.dataset.lowest.values, self.dataset.amplitude.values
        what = f"{scanned.size} amplitudes from {scanned[0]:.6g} to {scanned[-1]:.6g} at {self.dataset.phase.size} phases"
        if np.isnan(lowest).all():
            return f"nothing overturns from rest at {what}"
        where = np.unravel_index(np.nanargmin(lowest), lowest.shape)
        at = ", ".join(
            f"{name} = {self.dataset[name].values[k]:.6g}"
            for name, k in zip(self.dataset.lowest.dims, where, strict=True)
        )
        above = float(self.dataset.surviving_above.values[where])
        return (
            f"lowest overturning amplitude from rest {lowest[where]:.6g}{' at ' * bool(at)}{at}, scanned at {what}; "
            f"{100.0 * above:.1f} % of what was scanned above it survive"
        )


@frozen(eq=False)
class ChaosShare(NotebookPicture):
    """The share of chaotic responses among random periods and amplitudes, over the restitution; made by `chaos_share`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Over `restitution`: `chaotic` with `chaotic_low` and `chaotic_high`, its 95 % interval; and over `response` too
        `share`, that of each kind.
    shares : tuple of Share
        Those of the chaotic ones, as counts.
    """

    dataset: xr.Dataset = field(repr=False)
    shares: tuple[Share, ...]

    def __str__(self) -> str:
        pairs = zip(self.dataset.restitution.values, self.shares, strict=True)
        told = ", ".join(f"{share} at e = {restitution:.6g}" for restitution, share in pairs)
        return f"chaotic: {told}, of {self.shares[0].of:,} responses each"


@frozen
class Repeatability(NotebookPicture):
    """What comes of one experiment when its inputs are off by a little; made by `repeatability`.

    Attributes
    ----------
    system, start : System, State
        What was meant.
    relative : float
        By how much of itself each input was off at most.
    kinds : dict of Kind to Share
        The share of the runs that ended in each kind of response, the largest first; undetermined, which is no outcome but
        widens the intervals of all others, last.
    responses : dict of str to Share
        The same with period, symmetry and impacts of periodic responses told apart.
    """

    system: System
    start: State
    relative: float
    kinds: dict[Kind, Share] = field(hash=False)
    responses: dict[str, Share] = field(repr=False, hash=False)

    @property
    def certain(self) -> bool:
        """Whether all runs ended in one kind of response; not where one is undetermined."""
        return len(self.kinds) == 1 and Kind.UNDETERMINED not in self.kinds

    @property
    def repeats(self) -> Share:
        """The share of the most frequent kind; of none, where all are undetermined."""
        first, share = next(iter(self.kinds.items()))
        return Share(0, share.of, share.of) if first is Kind.UNDETERMINED else share

    def __str__(self) -> str:
        told = ", ".join(f"{name} {share}" for name, share in self.responses.items())
        return f"{self.repeats.of:,} runs off by up to {100.0 * self.relative:.3g} %: {told}"


@frozen(eq=False)
class RepeatabilityMap(NotebookPicture):
    """Where outcomes are certain and where not; made by `repeatability_map`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Over both axes `kind`, the most frequent one of the runs at a point (undetermined only where all are); `agreeing`,
        its share of them; `overturned` and `undetermined`, the shares that overturn and of which nothing is known.
    uncertain : Share
        The points at which not all runs ended in one kind of response; unknown where all that are known did.
    overturning_uncertain : Share
        The points at which some runs overturn and some do not; unknown likewise.
    """

    dataset: xr.Dataset = field(repr=False)
    uncertain: Share
    overturning_uncertain: Share

    def __str__(self) -> str:
        off = 100.0 * self.dataset.attrs["relative"]
        return (
            f"not certain when inputs are off by up to {off:.3g} %: the kind of response at {self.uncertain}, "
            f"whether it overturns at {self.overturning_uncertain}, of {self.uncertain.of:,} points"
        )
