"""Periodic orbits: the return map, symmetric modes, chains of events, continuation and manifolds."""
