"""Parameters of a system for the kernels."""

from __future__ import annotations

import math
from collections import OrderedDict
from threading import Lock
from typing import Any

import numpy as np

from rocking.kernels.forcing import parameters as numbers
from rocking.model import NO_BRACES, Harmonic, PiecewiseLinear, Pulse, System, quantities

MAX_TABLES = 8
"""Number of tables that are kept: those of the same samples and step, for all scales and restitutions."""
_tables: OrderedDict[tuple[int, float], tuple[np.ndarray, numbers.Tables]] = OrderedDict()
_lock = Lock()


def parameters(system: System, cycle_length: float | None = None) -> numbers.SystemParameters:
    """Return the parameters of a system for the kernels.

    For a base motion of finite length, `cycle_length` is that of the clock: any; by default a number of samples.
    """
    forcing = system.forcing
    if system.critical_angle is not None:
        return _full_parameters(system, system.critical_angle, cycle_length)
    if isinstance(forcing, Harmonic):
        return numbers.harmonic_parameters(**NO_BRACES | quantities(system))
    angle, restitution = (
        (math.inf, 1.0) if system.braces is None else (system.braces.angle, system.braces.restitution)
    )
    block = numbers.BlockParameters(system.restitution, angle, restitution)
    if isinstance(forcing, Pulse):
        if forcing.cosine is not None:
            return numbers.pulse_parameters(**_cosine_of(forcing, cycle_length), block=block)
        forcing = forcing.samples
    assert isinstance(forcing, PiecewiseLinear)
    length = numbers.CYCLE * forcing.step if cycle_length is None else cycle_length
    return numbers.sampled_parameters(tables_for(forcing), forcing.scale, length, *block)


def _full_parameters(
    system: System, critical_angle: float, cycle_length: float | None
) -> numbers.FullHarmonicParameters | numbers.FullSampledParameters | numbers.FullPulseParameters:
    """Return the parameters of the full block."""
    forcing = system.forcing
    braces = (math.inf, 1.0) if system.braces is None else (system.braces.angle, system.braces.restitution)
    law = np.array(system.restitution_law).reshape(-1, 2)
    largest = max([system.restitution, *law[:, 1].tolist()])
    block = numbers.full_block(largest, critical_angle, *braces, law)
    if isinstance(forcing, Harmonic):
        return numbers.full_harmonic_parameters(
            block, forcing.amplitude, forcing.frequency, forcing.period, forcing.phase
        )
    if isinstance(forcing, Pulse):
        if forcing.cosine is not None:
            return numbers.full_pulse_parameters(**_cosine_of(forcing, cycle_length), block=block)
        forcing = forcing.samples
    assert isinstance(forcing, PiecewiseLinear)
    length = numbers.CYCLE * forcing.step if cycle_length is None else cycle_length
    return numbers.full_sampled_parameters(block, tables_for(forcing), forcing.scale, length)


def _cosine_of(pulse: Pulse, cycle_length: float | None) -> dict[str, Any]:
    """Return the numbers of a pulse that is a piece of a cosine; a negative amplitude turns the phase by π."""
    assert pulse.cosine is not None
    turns, phase = pulse.cosine
    return {
        "amplitude": abs(pulse.amplitude),
        "frequency": 2 * math.pi * turns / pulse.duration,
        "phase": phase if pulse.amplitude >= 0 else phase + math.pi,
        "duration": pulse.duration,
        "cycle_length": pulse.duration if cycle_length is None else cycle_length,
    }


def tables_for(forcing: PiecewiseLinear) -> numbers.Tables:
    """Return the tables of the samples of a forcing, made once as long as they are kept."""
    key = id(forcing.values), forcing.step
    with _lock:
        if key in _tables:
            _tables.move_to_end(key)
            return _tables[key][1]
    made = numbers.tables_of(forcing.values, forcing.step)
    with _lock:
        _tables[key] = forcing.values, made  # the samples too, so that no others get their identity
        while len(_tables) > MAX_TABLES:
            _tables.popitem(last=False)
    return made
