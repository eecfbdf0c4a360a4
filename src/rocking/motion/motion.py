"""A motion: what `simulate` returns, a trajectory that can be tabulated, judged and shown."""

from __future__ import annotations

from typing import TYPE_CHECKING

from attrs import frozen

from rocking.model import Block, NotebookPicture, counted
from rocking.motion.dataset import to_dataset
from rocking.motion.trajectory import Trajectory
from rocking.motion.validity import Validity, validity

if TYPE_CHECKING:
    import xarray as xr


@frozen(eq=False, slots=False)
class Motion(Trajectory, NotebookPicture):
    """What one simulated block did; made by `simulate`.

    Attributes
    ----------
    system, start : System, State
        What was simulated.
    record : str
        "all", "section" or "none": what was kept.
    cycles : int
        Forcing cycles run: those asked for, fewer only if the block overturned; the cycle of that proof is the last.
    outcome : Outcome
        OVERTURNED or AT_REST where that is proved, else BOUNDED, which says no more than that neither was.
    overturning : Overturning or None
        When it was proved never to return.
    impacts, brace_hits : int
        Impacts at Θ = 0 and hits on the braces.
    peak : float
        Largest |Θ| of the run, [0, `duration`].
    final : State
        Θ, Θ' at its end, just after any event there.

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
        """Sample the motion as a dataset with units; in SI with a block. See `rocking.motion.dataset.to_dataset`.

        Examples
        --------
        >>> import rocking as rk
        >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
        >>> rk.simulate(system, cycles=2).to_xarray(step=0.5).sizes["time"]
        5
        """
        return to_dataset(self, step, block)

    def validity(self, block: Block) -> Validity:
        """Say where the model applies to a block: friction, base reaction, slender range. See `rocking.motion.validity`.

        Examples
        --------
        >>> import rocking as rk
        >>> block = rk.Block(height=2.0, width=0.5)
        >>> motion = rk.simulate(block.system(acceleration=4.0, frequency_hz=1.2), cycles=10)
        >>> motion.validity(block).friction > 0.2
        True
        """
        return validity(self, block)

    def __str__(self) -> str:
        counts = [counted(self.impacts, "impact")]
        if self.system.braces is not None:
            counts.append(counted(self.brace_hits, "brace hit"))
        if self.overturning is None:
            how = f"{self.outcome} over {counted(self.cycles, 'cycle')}"
        else:
            how = f"overturned: proved at τ = {self.overturning.time:.6g} never to return"
        return f"{how}; {', '.join(counts)}, peak |Θ| {self.peak:.4g}"
