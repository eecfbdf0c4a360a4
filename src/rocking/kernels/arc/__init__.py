"""Arcs, the motion between two events: their closed forms or steps, the searches for their ends, and their extrema."""
