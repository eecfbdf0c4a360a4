"""Motion of a full block under a base acceleration of finite length, from its start to its end.

There is no margin, and rounding errors are not assessed: u is no sum of exponentials.
"""

import math

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit, provide
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, REST
from rocking.kernels.forcing import finite
from rocking.kernels.forcing.arc import shift_clock
from rocking.kernels.forcing.finite import has_ended
from rocking.kernels.forcing.full.parameters import FullPulseParameters, FullSampledParameters
from rocking.kernels.forcing.full.solution import event_and_peak
from rocking.kernels.march.accumulated_error import EXACT
from rocking.kernels.march.ending import Ending
from rocking.kernels.march.finite_motion import is_lossless, resolved
from rocking.kernels.march.initial_state import UNKNOWN, begin
from rocking.kernels.march.march import CROWDED, DONE, MAX_EVENTS, OVERTURNED, STILL


@njit(**INTERNAL)
def overturns_freely(p, speed):
    """Return whether a block that leaves the base at a speed overturns without base motion.

    It does if u'^2/2 exceeds the barrier (1 - cos(alpha))/alpha^2 = 2 (sin(alpha/2)/alpha)^2.
    """
    alpha = p.block.critical_angle
    return p.block.brace_angle == math.inf and speed > 2.0 * math.sin(0.5 * alpha) / alpha


@njit(**INTERNAL)
def to_end(p, angle, velocity, until, cut, want_peak):
    """Provide ``finite.to_end``."""
    progress, hit = begin(p, angle, velocity, UNKNOWN)
    mode, arc, peak = progress.mode, progress.arc, progress.peak
    impacts, since_rest, brace_hits, cycle, status = 0, 0, int(hit), 0, CROWDED
    for _ in range(MAX_EVENTS):
        coming, highest = event_and_peak(p, mode, arc, peak if want_peak else math.inf)
        if coming.wait == math.inf or cycle * p.clock.cycle_length + arc.start + coming.wait > until:
            status = DONE if coming.wait < math.inf else OVERTURNED if mode == FLIGHT else STILL
            break
        peak = highest if want_peak else peak
        impacts += coming.event == IMPACT
        brace_hits += coming.event == BRACE
        mode, arc = resolved(p, arc, coming, cut, peak if want_peak else math.inf, EXACT)
        since_rest = 0 if mode == REST else since_rest + int(coming.event == IMPACT)
        while arc.start > p.clock.cycle_length:
            cycle, arc = cycle + 1, shift_clock(arc, p.clock.cycle_length)
        if is_lossless(p, coming) and has_ended(p, arc.drive):
            status = OVERTURNED if overturns_freely(p, abs(arc.velocity)) else DONE
            if want_peak and mode == FLIGHT and status == DONE:
                _, peak = event_and_peak(p, mode, arc, peak)  # all later arcs reach what the next one reaches
            break
    return Ending(status, impacts, since_rest, brace_hits, peak, math.nan, math.nan, False)


for kind in (FullSampledParameters, FullPulseParameters):
    provide(kind, {finite.to_end: to_end})
