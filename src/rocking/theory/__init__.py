"""Closed-form results for numbers or arrays: modes, Melnikov's function, tangency, free rocking, pulses, sliding, design rules."""

from rocking.model.validation import explain
from rocking.theory.design_rules import (
    contact_restitution,
    design_angle,
    equal_displacement_angle,
    equivalent_damping,
    ishiyama_levels,
    pulse_overturning_rule,
    rocking_frame,
)
from rocking.theory.dimensional import (
    physical_acceleration,
    physical_critical_energy,
    physical_damping,
    physical_energy,
    physical_heteroclinic_orbit,
)
from rocking.theory.free_rocking import (
    energy,
    free_impact_speed,
    free_peaks,
    free_quarter_period,
    free_time_to_rest,
    heteroclinic_orbit,
)
from rocking.theory.melnikov import (
    damping,
    heteroclinic_amplitude,
    impact_loss,
    manifold_gap,
    melnikov_amplitude,
    melnikov_function,
    melnikov_integral,
    saddle_orbit,
    stable_manifold_velocity,
    unstable_manifold_velocity,
)
from rocking.theory.pulse_thresholds import (
    falling_triangle_pulse_amplitude,
    half_sine_pulse_amplitude,
    one_cosine_pulse_amplitude,
    one_sine_impact_amplitudes,
    one_sine_pulse_amplitude,
    rectangular_pulse_amplitude,
    triangle_pulse_amplitude,
)
from rocking.theory.rough_base import first_motion, slide_rock_acceleration
from rocking.theory.symmetric_modes import (
    existence_amplitude,
    slower_mode_amplitude,
    symmetric_modes,
    symmetry_breaking_amplitude,
)

__all__ = [
    "contact_restitution",
    "damping",
    "design_angle",
    "energy",
    "equal_displacement_angle",
    "equivalent_damping",
    "existence_amplitude",
    "falling_triangle_pulse_amplitude",
    "first_motion",
    "free_impact_speed",
    "free_peaks",
    "free_quarter_period",
    "free_time_to_rest",
    "half_sine_pulse_amplitude",
    "heteroclinic_amplitude",
    "heteroclinic_orbit",
    "impact_loss",
    "ishiyama_levels",
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
    "pulse_overturning_rule",
    "rectangular_pulse_amplitude",
    "rocking_frame",
    "saddle_orbit",
    "slide_rock_acceleration",
    "slower_mode_amplitude",
    "stable_manifold_velocity",
    "symmetric_modes",
    "symmetry_breaking_amplitude",
    "triangle_pulse_amplitude",
    "unstable_manifold_velocity",
]

explain(globals(), __all__)
