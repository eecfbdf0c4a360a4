"""Periodic orbits, their continuation and bifurcations, orbit diagrams, and manifolds of the saddle orbits."""
