"""Functions that a forcing of finite length provides besides those of ``contract``. It is 0 after its end.

All but ``has_ended``, ``to_end``, ``with_run`` and ``with_pulse`` are for slender blocks alone. There an arc is
u = (K+ e^t + K- e^-t)/2 and bounded terms. So the block leaves for good if K+ > 0, unless it comes back before.
"""

from rocking.kernels.deferred import contract


@contract
def growth_constant(p, arc):
    """Return K+ of an arc and an estimate of its rounding error. After an impact at tau, K+ = v - 1 - sigma R(tau)."""


@contract
def rounding_error(p, arc, wait, growth):
    """Return an estimate of the rounding error of (u, u') that a time ``wait`` along an arc adds; ``growth`` is e^wait."""


@contract
def elapsed_until(p, arc, drive):
    """Return the time from the start of an arc to a place of the forcing."""


@contract
def next_event_and_extremes(p, mode, arc):
    """Find the next event as ``contract.next_event`` does, and the ``Extremes`` of the arc before it."""


@contract
def largest_before(p, arc, coming, reached):
    """Return an upper bound of the angle on an arc before its event, where ``Extremes.reached`` is known."""


@contract
def has_ended(p, drive):
    """Return whether the base motion is over."""


@contract
def to_end(p, angle, velocity, until, cut, want_peak):
    """Return the ``Ending`` of a motion.

    Follow it until nothing follows, until a time, or to the first contact without loss after the base motion. With ``cut``,
    chattering is cut short if it does not exceed a peak that is wanted.
    """


@contract
def with_run(p, run):
    """Return the parameters of a row of runs under the samples of ``p``."""


@contract
def with_pulse(p, pulse):
    """Return the parameters of a row of pulses; the cycle of the clock lasts as long as the pulse."""
