"""Motion: the result of `simulate`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from attrs import frozen

from rocking.model import Block, NotebookPicture, Outcome, counted, instance
from rocking.motion.dataset import to_dataset
from rocking.motion.trajectory import Trajectory
from rocking.motion.validity import Validity, validity

if TYPE_CHECKING:
    import xarray as xr


@frozen(eq=False, slots=False)
class Motion(Trajectory, NotebookPicture):
    """Simulated motion of one block; returned by `simulate`.

    Attributes
    ----------
    system, start : System, State
        System and initial state.
    record : str
        Recorded data: "all", "section" or "none".
    cycles : int
        Number of forcing cycles simulated; 0 for a base motion of finite length. It is smaller than requested only if the
        block overturns; the last cycle is then that of the proof.
    outcome : Outcome
        OVERTURNED or AT_REST if that is proved, else BOUNDED.
    overturning : Overturning or None
        Instant from which overturning is certain.
    impacts, brace_hits : int
        Number of impacts at Θ = 0 and on the braces.
    peak : float
        Largest |Θ| of the run, [0, `duration`]. If the block overturns, the run ends before the angle reaches 90°, and `peak`
        says nothing about the fall.
    margin : float
        What the block lacked to overturn (negative), or had beyond that, in units of αθcr. It is the K₊ of least size over all
        lift-offs and impacts.

        K₊ = v − 1 − σR(τ), with the speed v and the side σ afterwards. R(τ) is the integral of e^(τ−x) a(x) over all later x.

        The block leaves for good if K₊ > 0, unless it returns before. NaN if the block never moves, for a harmonic base motion,
        between braces, and for a block with a critical angle.
    margin_time : float
        Time τ of that lift-off or impact.
    certified : bool
        False if the outcome is undecided in double precision: the accumulated rounding error exceeds |K₊| somewhere, or the
        clearance of a minimum of |Θ| between two impacts, or a lower bound of it. The error is an estimate from the rounding of
        each arc and its growth. True for a harmonic base motion, and between braces, which prevent overturning. False for a block
        with a critical angle under a base motion of finite length: its rounding errors are not assessed.
    final : State
        Θ and Θ' at the end, just after an event if there is one.
    duration : float
        Length of the run, in τ.
    events, peaks : structured ndarray
        Events and local extremes of Θ; only with record="all".

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> motion = rk.simulate(system, cycles=50)
    >>> print(motion)
    bounded over 50 cycles; 99 impacts, peak |Θ| 0.1875
    >>> motion.events["kind"][:2].tolist(), motion.section().shape
    (['impact', 'impact'], (51, 2))
    """

    def to_xarray(self, step: float | None = None, block: Block | None = None) -> xr.Dataset:
        """Return the motion sampled in time, as a dataset with units.

        Parameters
        ----------
        step : float, optional
            Time step in τ, or in seconds with a block. Default: a hundredth of the forcing period, or the step of a
            base acceleration that is given by samples.
        block : Block, optional
            Block for output in SI units. Default: normalised output.

        Returns
        -------
        xarray.Dataset
            Samples and events, or the section; see `rocking.motion.dataset.to_dataset`.

        Raises
        ------
        TypeError
            If `step` is not a number.
        ValueError
            If `step` is not positive or is longer than the motion, or if the motion recorded neither events nor section.

        Examples
        --------
        >>> import rocking as rk
        >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
        >>> rk.simulate(system, cycles=2).to_xarray(step=0.5).sizes["time"]
        5
        """
        return to_dataset(self, step, block)

    def validity(self, block: Block, *, full: bool = False) -> Validity:
        """Assess whether the model applies to this motion of a real block: friction, base reaction and slenderness.

        Parameters
        ----------
        block : Block
            Block in SI units that performs the motion.
        full : bool
            Also follow the full equation of motion under the same base motion, and compare the largest angle and the outcome.
            Default: False.

        Returns
        -------
        Validity
            Required friction, base reaction, errors of the slender-block model, and warnings; `print` shows them.

        Raises
        ------
        TypeError
            If `block` is not a Block.
        ValueError
            If the motion was not recorded with record="all".

        Examples
        --------
        >>> import rocking as rk
        >>> block = rk.Block(height=2.0, width=0.5)
        >>> motion = rk.simulate(block.system(acceleration=4.0, frequency_hz=1.2), cycles=10)
        >>> motion.validity(block).friction > 0.2
        True
        """
        return validity(self, block, full=instance("full", full, bool))

    @property
    def doubt(self) -> str:
        """Reason why the outcome is not certified; empty if it is."""
        if self.certified:
            return ""
        if self.system.critical_angle is None:
            return "undecided in double precision"
        if self.outcome is Outcome.BOUNDED:
            return "rounding errors are not assessed"
        return "proved for the computed motion; its rounding errors are not assessed"

    def __str__(self) -> str:
        counts = [counted(self.impacts, "impact")]
        if self.system.braces is not None:
            counts.append(counted(self.brace_hits, "brace impact"))
        if self.overturning is None:
            counts.append(f"peak |Θ| {self.peak:.4g}")
            over = counted(self.cycles, "cycle") if self.cycles else f"τ = {self.duration:.6g}"
            how = f"{self.outcome} over {over}"
        else:
            since = ": overturning is certain" if self.certified else ""
            how = f"overturned{since} from τ = {self.overturning.time:.6g}"
        margin = "" if math.isnan(self.margin) else f", margin {self.margin:.4g}"
        doubt = f" ({self.doubt})" if self.doubt else ""
        return f"{how}{doubt}; {', '.join(counts)}{margin}"
