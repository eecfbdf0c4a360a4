"""Results of surveys: a dataset with a one-line summary, each returned by the survey function of the same name."""

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
    """Safe fraction of initial states as a function of the amplitude; returned by `safe_basin`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `amplitude`: `safe` with the ends `safe_low` and `safe_high` of its 95 % interval, and
        `undetermined`, the fraction of undetermined initial states. These count as safe.
    shares : tuple of Share
        Safe fractions, as counts.
    heteroclinic_amplitude : float
        Amplitude A*, above which the boundary of the overturning initial states is fractal (exact). NaN with braces.
    melnikov_amplitude : float
        Amplitude A_M, the first-order approximation of A* by Melnikov's method. NaN with braces.

    Examples
    --------
    >>> import rocking as rk
    >>> found = rk.safe_basin(amplitude=[0.2, 0.5], period=1.0, restitution=0.925, samples=100)
    >>> found.shares[0].of, found.melnikov_amplitude < found.heteroclinic_amplitude
    (100, True)
    """

    dataset: xr.Dataset = field(repr=False)
    shares: tuple[Share, ...]
    heteroclinic_amplitude: float
    melnikov_amplitude: float

    def __str__(self) -> str:
        amplitudes = self.dataset.amplitude.values
        least = min(range(len(self.shares)), key=lambda k: self.shares[k].value)
        first, last = self.shares[0], self.shares[-1]
        summary = (
            f"safe fraction: {first} of {first.of:,} initial states at A = {amplitudes[0]:.6g}, {last} at A = {amplitudes[-1]:.6g}, "
            f"lowest {self.shares[least]} at A = {amplitudes[least]:.6g}"
        )
        if np.isnan(self.heteroclinic_amplitude):
            return summary
        return f"{summary}; A* = {self.heteroclinic_amplitude:.6g}, A_M = {self.melnikov_amplitude:.6g}"


@frozen(eq=False)
class OverturningCurve(NotebookPicture):
    """Lowest amplitude that overturns a block initially at rest; returned by `overturning_amplitude`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `period` (or `frequency`) and `restitution`, as far as they vary:

        - `lowest`: lowest overturning amplitude found, NaN if none was;
        - `lowest_phase`: forcing phase at which it was found, rad;
        - `resolution`: distance to the next lower amplitude of the scan;
        - `survived_up_to`: highest amplitude of the scan up to which no run overturns;
        - `surviving_above`: fraction of the scanned amplitudes and phases above `lowest` that do not overturn;
        - `overturning_share`, also over `amplitude`: fraction of the phases that overturn;
        - `changes`, also over `phase`: number of changes of the outcome along A;
        - `heteroclinic_amplitude`: A*.

    Examples
    --------
    >>> import rocking as rk
    >>> print(rk.overturning_amplitude(period=2.0, restitution=0.925, amplitude=[0.5, 1.0], phases=2))
    no overturning from rest at 2 amplitudes from 0.5 to 1 and 2 phases
    """

    dataset: xr.Dataset = field(repr=False)

    def __str__(self) -> str:
        lowest, scanned = self.dataset.lowest.values, self.dataset.amplitude.values
        what = f"{scanned.size} amplitudes from {scanned[0]:.6g} to {scanned[-1]:.6g} and {self.dataset.phase.size} phases"
        if np.isnan(lowest).all():
            return f"no overturning from rest at {what}"
        where = np.unravel_index(np.nanargmin(lowest), lowest.shape)
        at = ", ".join(
            f"{name} = {self.dataset[name].values[k]:.6g}"
            for name, k in zip(self.dataset.lowest.dims, where, strict=True)
        )
        above = float(self.dataset.surviving_above.values[where])
        return (
            f"lowest overturning amplitude from rest {lowest[where]:.6g}{' at ' * bool(at)}{at}, from a scan of {what}; "
            f"{100.0 * above:.1f} % of the scanned points above it do not overturn"
        )


@frozen(eq=False)
class ChaosShare(NotebookPicture):
    """Fraction of chaotic responses over random periods and amplitudes; returned by `chaos_share`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over `restitution`: `chaotic` with the ends `chaotic_low` and `chaotic_high` of its 95 % interval.
        Variable over `restitution` and `response`: `share`, the fraction of each response type.
    shares : tuple of Share
        Fractions of chaotic responses, as counts.

    Examples
    --------
    >>> import rocking as rk
    >>> print(rk.chaos_share(restitution=0.9, period=(0.5, 1.0), amplitude=(0.1, 0.9), samples=10))
    chaotic fraction: 0 % (0–27.8 %) at e = 0.9, of 10 responses each
    """

    dataset: xr.Dataset = field(repr=False)
    shares: tuple[Share, ...]

    def __str__(self) -> str:
        pairs = zip(self.dataset.restitution.values, self.shares, strict=True)
        fractions = ", ".join(f"{share} at e = {restitution:.6g}" for restitution, share in pairs)
        return f"chaotic fraction: {fractions}, of {self.shares[0].of:,} responses each"


@frozen
class Repeatability(NotebookPicture):
    """Outcomes of one experiment whose inputs are slightly uncertain; returned by `repeatability`.

    Attributes
    ----------
    system, start : System, State
        Nominal system and initial state.
    relative : float
        Largest relative error of each input.
    kinds : dict of Kind to Share
        Fraction of the runs with each response type, the largest first. Undetermined runs come last; they are no outcome
        of their own but widen the intervals of all others.
    responses : dict of str to Share
        Fractions with periodic responses distinguished by period, symmetry and number of impacts.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), restitution=0.9)
    >>> found = rk.repeatability(system, samples=100)
    >>> print(found)
    100 runs with inputs off by up to 1 %: rest 100 % (96.3–100 %)
    >>> found.certain
    True
    """

    system: System
    start: State
    relative: float
    kinds: dict[Kind, Share] = field(hash=False)
    responses: dict[str, Share] = field(repr=False, hash=False)

    @property
    def certain(self) -> bool:
        """True if all runs have one response type and none is undetermined."""
        return len(self.kinds) == 1 and Kind.UNDETERMINED not in self.kinds

    @property
    def repeats(self) -> Share:
        """Fraction of the most frequent response type; 0 with all runs unknown if all are undetermined."""
        first, share = next(iter(self.kinds.items()))
        return Share(0, share.of, share.of) if first is Kind.UNDETERMINED else share

    def __str__(self) -> str:
        responses = ", ".join(f"{name} {share}" for name, share in self.responses.items())
        return f"{self.repeats.of:,} runs with inputs off by up to {100.0 * self.relative:.3g} %: {responses}"


@frozen(eq=False)
class RepeatabilityMap(NotebookPicture):
    """Map of the repeatability of outcomes over two quantities; returned by `repeatability_map`.

    Attributes
    ----------
    dataset : xarray.Dataset
        Variables over both axes:

        - `kind`: most frequent response type of the runs at a point, undetermined only if all runs are;
        - `agreeing`: fraction of the runs with this type;
        - `overturned`, `undetermined`: fractions of the runs with these types.
    uncertain : Share
        Fraction of points at which the runs have different response types. Points with undetermined runs and otherwise
        equal types count as unknown.
    overturning_uncertain : Share
        Fraction of points at which some runs overturn and others do not. Unknown points are counted likewise.

    Examples
    --------
    >>> import rocking as rk
    >>> print(rk.repeatability_map(amplitude=[0.2, 0.5], period=[1.0, 2.0], restitution=0.9, samples=10))
    inputs off by up to 1 %: response type uncertain at 0 % (0–49.0 %), overturning uncertain at 0 % (0–49.0 %), of 4 points
    """

    dataset: xr.Dataset = field(repr=False)
    uncertain: Share
    overturning_uncertain: Share

    def __str__(self) -> str:
        off = 100.0 * self.dataset.attrs["relative"]
        return (
            f"inputs off by up to {off:.3g} %: response type uncertain at {self.uncertain}, "
            f"overturning uncertain at {self.overturning_uncertain}, of {self.uncertain.of:,} points"
        )
