"""Where responses end up, so that two starts can be compared: one state an attractor, the same from whichever start."""

import math

import numpy as np
from numba import njit

from rocking.kernels.classify.classifier_state import FIRST_SECTION
from rocking.kernels.classify.verdict_record import PERIODIC, REST
from rocking.kernels.classify.workspace import no_recording
from rocking.kernels.compile_options import ALLOCATING_ENTRY, INTERNAL
from rocking.kernels.march.march import DONE, STILL, UNKNOWN, begin, march_through
from rocking.kernels.march.progress import Recording
from rocking.kernels.parameters import later, parameters_from_row

# The phase of the section on which attractors are compared, in cycles: on no event of any symmetric mode but by chance.
SECTION = FIRST_SECTION
# States of an orbit whose angles differ by less are told apart by their velocities.
TIED = 1e-7
# Rest is certain long before its last impact.
LONGER = 10


@njit(**INTERNAL)
def rest_angle(p, angle, velocity, cycles, nothing):
    """Return where a motion that is known to end at rest does so: 0, or on a brace."""
    if p.brace_angle == math.inf:
        return 0.0
    recording = Recording(0.0, nothing.section, nothing.events, False, False)
    progress = begin(p, angle, velocity, UNKNOWN)[0]
    status, progress = march_through(p, progress, LONGER * max(cycles, 1), recording, nothing.tangent)
    return progress.arc.side * progress.arc.angle if status == STILL else math.nan


@njit(**INTERNAL)
def foremost(states, first):
    """The row of the largest angle, of those tied the one of the largest velocity."""
    best = first
    for row in range(first + 1, states.shape[0]):
        ahead = states[row, 0] - states[best, 0]
        if ahead > TIED or (ahead > -TIED and states[row, 1] > states[best, 1]):
            best = row
    return best


@njit(**ALLOCATING_ENTRY)
def anchor_each(systems, starts, kind, period, cycles, orbit, nothing, anchors):
    """Write for each of n points the state (angle, velocity) that stands for what it ends up on; NaN where nothing does.

    Of a periodic orbit its foremost state on the section at SECTION; of rest where that is. ``kind``, ``period``,
    ``cycles`` and ``orbit`` are ``Answers``.
    """
    for k in range(systems.shape[0]):
        anchors[k, 0], anchors[k, 1] = math.nan, math.nan
        if kind[k] != PERIODIC and kind[k] != REST:
            continue
        p = parameters_from_row(systems[k])
        if kind[k] == REST:
            anchors[k, 0], anchors[k, 1] = rest_angle(p, starts[k, 0], starts[k, 1], cycles[k], nothing), 0.0
            continue
        # The second time round: an orbit that rests is known at a release, whose instant is rounded.
        states = np.empty((2 * period[k], 2))
        at = (SECTION * p.period - orbit[k, 0]) % p.period
        q, recording = later(p, orbit[k, 0]), Recording(at, states, nothing.events, False, False)
        progress = begin(q, orbit[k, 1], orbit[k, 2], UNKNOWN)[0]
        status, _ = march_through(q, progress, 2 * period[k], recording, nothing.tangent)
        if status == DONE:
            best = foremost(states, period[k])
            anchors[k, 0], anchors[k, 1] = states[best, 0], states[best, 1]


def anchors_of(systems, starts, answers):
    """``anchor_each`` for the answers of ``judge_many``: an array (n, 2)."""
    anchors = np.empty((len(systems), 2))
    anchor_each(
        systems,
        starts,
        answers.kind,
        answers.period,
        answers.cycles,
        answers.orbit,
        no_recording(),
        anchors,
    )
    return anchors
