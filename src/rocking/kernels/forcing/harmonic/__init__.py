"""Arc, the motion between two events: its closed form, its first zero and its extrema."""
