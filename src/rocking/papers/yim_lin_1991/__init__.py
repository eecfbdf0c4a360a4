"""Yim and Lin (1991), Nonlinear impact and chaotic response of slender rocking objects, J. Eng. Mech. ASCE 117.

One file a figure; `reproduce` writes them all.
"""

from rocking.papers.report.page import PAGE
from rocking.papers.yim_lin_1991.reproduce import PAPER, reproduce

__all__ = ["PAGE", "PAPER", "reproduce"]
