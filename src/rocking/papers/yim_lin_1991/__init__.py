"""Yim and Lin (1991), Nonlinear impact and chaotic response of slender rocking objects, J. Eng. Mech. ASCE 117."""
