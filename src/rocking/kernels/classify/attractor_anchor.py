"""Canonical state of an attractor, equal for all initial states that lead to it."""

import math

import numpy as np

from rocking.kernels.classify.classifier_state import FIRST_SECTION
from rocking.kernels.classify.results import ResultArrays
from rocking.kernels.classify.verdict_record import PERIODIC, REST
from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.forcing.parameters import PeriodicParameters, parameters_of_row
from rocking.kernels.forcing.periodic import later, with_row
from rocking.kernels.march.initial_state import UNKNOWN, begin
from rocking.kernels.march.march import DONE, STILL, march_through
from rocking.kernels.march.no_recording import NoRecording, no_recording
from rocking.kernels.march.progress import Recording
from rocking.kernels.signature import Floats2

# Phase of the section on which attractors are compared, in cycles. An event of a symmetric mode lies there
# only by chance.
SECTION = FIRST_SECTION
# States of an orbit with angles closer than this are ordered by their velocities.
TIED = 1e-7
# Rest is proved long before its last impact, so the march takes this factor longer.
LONGER = 10


@njit(**INTERNAL)
def rest_angle(p, angle, velocity, cycles, nothing):
    """Return the angle at which a motion comes to rest: 0, or on a brace."""
    if p.block.brace_angle == math.inf:
        return 0.0
    recording = Recording(0.0, nothing.section, nothing.events, False, False)
    progress = begin(p, angle, velocity, UNKNOWN)[0]
    status, progress = march_through(p, progress, LONGER * max(cycles, 1), recording, nothing.tangent)
    return progress.arc.side * progress.arc.angle if status == STILL else math.nan


@njit(**INTERNAL)
def foremost(states, first):
    """Return the row of the largest angle; of rows with tied angles, that of the largest velocity."""
    best = first
    for row in range(first + 1, states.shape[0]):
        ahead = states[row, 0] - states[best, 0]
        if ahead > TIED or (ahead > -TIED and states[row, 1] > states[best, 1]):
            best = row
    return best


@entry_point(**KERNEL)
def anchor_each(
    kind: PeriodicParameters,
    systems: Floats2,
    starts: Floats2,
    results: ResultArrays,
    nothing: NoRecording,
    scratch: Floats2,
    anchors: Floats2,
) -> None:
    """Write the canonical state (angle, velocity) of the attractor of each of n points; NaN if there is none.

    For a periodic orbit it is the foremost state on the section at SECTION, for rest the state of rest.
    ``kind`` gives the type of the parameters, ``scratch`` has two rows per cycle of the longest period.
    """
    for k in range(systems.shape[0]):
        anchors[k, 0], anchors[k, 1] = math.nan, math.nan
        if results.kind[k] != PERIODIC and results.kind[k] != REST:
            continue
        p = with_row(kind, systems[k])
        if results.kind[k] == REST:
            cycles = results.cycles[k]
            anchors[k, 0], anchors[k, 1] = rest_angle(p, starts[k, 0], starts[k, 1], cycles, nothing), 0.0
            continue
        # The second repetition is used, because an orbit with rest is known at a release, whose time is
        # rounded.
        period, time = results.period[k], results.section_time[k]
        states = scratch[: 2 * period]
        at = (SECTION * p.forcing.period - time) % p.forcing.period
        q, recording = later(p, time), Recording(at, states, nothing.events, False, False)
        progress = begin(q, results.angle[k], results.velocity[k], UNKNOWN)[0]
        status, _ = march_through(q, progress, 2 * period, recording, nothing.tangent)
        if status == DONE:
            best = foremost(states, period)
            anchors[k, 0], anchors[k, 1] = states[best, 0], states[best, 1]


def anchors_of(systems, starts, answers):
    """Return ``anchor_each`` for the results of ``batch.classify_batch``: an array (n, 2)."""
    anchors, scratch = np.empty((len(systems), 2)), np.empty((2 * answers.period.max(initial=1), 2))
    if len(systems):
        kind = parameters_of_row(systems[0])
        anchor_each(kind, systems, starts, answers, no_recording(), scratch, anchors)
    return anchors
