"""Surveys: responses at the points of a grid or sample, on all cores or a cluster, in memory or in a store."""
