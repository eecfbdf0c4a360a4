"""Verdict on a periodic response with its proof."""

from __future__ import annotations

from typing import Literal

from attrs import evolve

from rocking.model import System, Verdict, refuse_if
from rocking.proof import check_provable, prove

Wanted = bool | Literal["orbit"]


def check_wanted(wanted: Wanted, system: System) -> None:
    """Raise an error unless a proof is not wanted, or can be tried.

    Raises
    ------
    ImportError
        If python-flint is not installed.
    ValueError
        If the block is not slender, or `wanted` is neither a boolean nor "orbit".
    """
    known = isinstance(wanted, bool) or (isinstance(wanted, str) and wanted == "orbit")
    refuse_if(not known, "prove", 'be False, True or "orbit"', wanted)
    if wanted:
        check_provable(system)


def with_proof(verdict: Verdict, wanted: Wanted) -> Verdict:
    """Return a verdict with the proof of its orbit, which never changes the type of response.

    Only the proof that the initial state leads to the orbit raises the level of the evidence to "proved".
    """
    if not wanted:
        return verdict
    if verdict.orbit is None:
        shown = f"{verdict.evidence.shown} Only a periodic response is proved in ball arithmetic."
        return evolve(verdict, evidence=evolve(verdict.evidence, shown=shown))
    proof = prove(verdict.orbit if wanted == "orbit" else verdict)
    shown, level = verdict.evidence.shown, verdict.evidence.level
    if proof.starts:
        shown, level = shown.replace(f"Evidence: {level}", "Evidence: proved"), "proved"
    evidence = evolve(verdict.evidence, level=level, shown=f"{shown} In ball arithmetic, {proof}.")
    return evolve(verdict, evidence=evidence, orbit=evolve(verdict.orbit, proof=proof))
