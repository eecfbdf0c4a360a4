"""Periodic orbits: return map, symmetric modes, event chains, continuation and manifolds."""
