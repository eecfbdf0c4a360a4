"""Proofs of periodic orbits and of chaos, in ball arithmetic."""

from __future__ import annotations

from rocking.proof.horseshoe import horseshoe
from rocking.proof.prove import check_provable, prove

__all__ = ["check_provable", "horseshoe", "prove"]
