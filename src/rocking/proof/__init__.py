"""Proofs of periodic orbits and of chaos, in ball arithmetic."""
