"""Closed-form results: symmetric modes, Melnikov's function, exact tangency, free rocking, frames and design rules."""

from rocking.theory.contact_restitution import contact_restitution
from rocking.theory.design_rules import design_angle, equivalent_damping, pulse_overturning_rule
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
from rocking.theory.rocking_frame import rocking_frame
from rocking.theory.symmetric_modes import (
    existence_amplitude,
    slower_mode_amplitude,
    symmetric_modes,
    symmetry_breaking_amplitude,
)
from rocking.theory.unforced_block import energy, heteroclinic_orbit

__all__ = [
    "contact_restitution",
    "damping",
    "design_angle",
    "energy",
    "equivalent_damping",
    "existence_amplitude",
    "free_impact_speed",
    "free_peaks",
    "free_quarter_period",
    "free_time_to_rest",
    "heteroclinic_amplitude",
    "heteroclinic_orbit",
    "impact_loss",
    "manifold_gap",
    "melnikov_amplitude",
    "melnikov_function",
    "melnikov_integral",
    "physical_acceleration",
    "physical_critical_energy",
    "physical_damping",
    "physical_energy",
    "physical_heteroclinic_orbit",
    "pulse_overturning_rule",
    "rocking_frame",
    "saddle_orbit",
    "slower_mode_amplitude",
    "stable_manifold_velocity",
    "symmetric_modes",
    "symmetry_breaking_amplitude",
    "unstable_manifold_velocity",
]
