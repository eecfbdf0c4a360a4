"""Proofs of periodic orbits and of chaos, in ball arithmetic."""

from __future__ import annotations

from rocking.proof.prove import check_provable, module, prove

__all__ = ["check_provable", "module", "prove"]
