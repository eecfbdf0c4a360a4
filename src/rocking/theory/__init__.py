"""Closed-form results: symmetric modes, Melnikov's function, exact tangency, free rocking and pulses, for numbers or arrays."""

from rocking.theory.dimensional import (
    physical_acceleration,
    physical_critical_energy,
    physical_damping,
    physical_energy,
    physical_heteroclinic_orbit,
)
from rocking.theory.free_rocking import free_impact_speed, free_peaks, free_quarter_period, free_time_to_rest
from rocking.theory.heteroclinic import (
    heteroclinic_amplitude,
    manifold_gap,
    saddle_orbit,
    stable_manifold_velocity,
    unstable_manifold_velocity,
)
from rocking.theory.melnikov import (
    damping,
    impact_loss,
    melnikov_amplitude,
    melnikov_function,
    melnikov_integral,
)
from rocking.theory.pulse_thresholds import (
    half_sine_pulse_amplitude,
    one_cosine_pulse_amplitude,
    one_sine_impact_amplitudes,
    one_sine_pulse_amplitude,
    rectangular_pulse_amplitude,
)
from rocking.theory.symmetric_modes import (
    existence_amplitude,
    slower_mode_amplitude,
    symmetric_modes,
    symmetry_breaking_amplitude,
)
from rocking.theory.unforced_block import energy, heteroclinic_orbit

__all__ = [
    "damping",
    "energy",
    "existence_amplitude",
    "free_impact_speed",
    "free_peaks",
    "free_quarter_period",
    "free_time_to_rest",
    "half_sine_pulse_amplitude",
    "heteroclinic_amplitude",
    "heteroclinic_orbit",
    "impact_loss",
    "manifold_gap",
    "melnikov_amplitude",
    "melnikov_function",
    "melnikov_integral",
    "one_cosine_pulse_amplitude",
    "one_sine_impact_amplitudes",
    "one_sine_pulse_amplitude",
    "physical_acceleration",
    "physical_critical_energy",
    "physical_damping",
    "physical_energy",
    "physical_heteroclinic_orbit",
    "rectangular_pulse_amplitude",
    "saddle_orbit",
    "slower_mode_amplitude",
    "stable_manifold_velocity",
    "symmetric_modes",
    "symmetry_breaking_amplitude",
    "unstable_manifold_velocity",
]
